# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of motions that the panel shows. On the WindowManager: it is neither saved nor undone."""
from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy

from . import native
from .corpora import default_corpus, opened_corpus
from .preferences import length_text, place_text
from .reachcast_corpus.listing import person_text
from .scene import target_cloud
from .scene.motion_library import target_points

MOST_LISTED = 2000
PHASES = (("ALL", "All", "Motions of every phase"), ("reach", "Reach", "Empty hands to the box"),
          ("transfer", "Transfer", "With the box, from home to the shelf"),
          ("return", "Return", "Empty hands back to the sides"),
          ("retrieve", "Retrieve", "With the box, from the shelf home"))


class ListedMotion(bpy.types.PropertyGroup):
    """A row. Its name is what the list is searched by."""

    motion: bpy.props.IntProperty(options={"HIDDEN"})
    phase: bpy.props.StringProperty(options={"HIDDEN"})
    place: bpy.props.StringProperty(options={"HIDDEN"})
    duration: bpy.props.StringProperty(options={"HIDDEN"})
    words: bpy.props.StringProperty(options={"HIDDEN"})


def _show_or_hide(listing: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    follow_choice(listing, context)
    target_cloud.show(listing.show_targets, context)


def _list_again(listing: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    if listing.source:
        in_panel(context, refresh)
    else:
        follow_choice(listing, context)


def follow_choice(_changed: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Another rig, phase or corpus has been chosen: the drawn targets are those, around that rig."""
    if context.window_manager.reachcast_motions.show_targets:
        in_panel(context, draw_targets)


def in_panel(context: bpy.types.Context, action: Callable[[bpy.types.Context], object]) -> None:
    """Does what a changed property asks for; what goes wrong is said in the panel."""
    try:
        action(context)
    except (ValueError, RuntimeError) as error:
        context.window_manager.reachcast_problem = str(error)
    else:
        context.window_manager.reachcast_problem = ""


class MotionListing(bpy.types.PropertyGroup):
    rows: bpy.props.CollectionProperty(type=ListedMotion)
    active: bpy.props.IntProperty(name="Motion", description="The motion that Play and Forget mean")
    total: bpy.props.IntProperty(options={"HIDDEN"})
    source: bpy.props.StringProperty(options={"HIDDEN"})
    phase: bpy.props.EnumProperty(name="Phase", items=PHASES, update=_list_again,
                                  description="Which motions are listed and drawn")
    show_targets: bpy.props.BoolProperty(
        name="Show Targets", update=_show_or_hide,
        description="Draw where the hands of the corpus' motions were on the box, around the rig: what lies far from "
                    "all points is outside the data")


def corpus_path(settings: bpy.types.PropertyGroup) -> str:
    """The file that the panel names, or the one that ships."""
    return bpy.path.abspath(settings.corpus) if settings.corpus else str(default_corpus() or "")


def refresh(context: bpy.types.Context) -> int:
    """Lists the motions of the panel's corpus and moves the drawn points. Returns how many motions there are."""
    listing = context.window_manager.reachcast_motions
    fill(listing, opened_corpus(native.core(), corpus_path(context.scene.reachcast)))
    draw_targets(context)
    target_cloud.show(listing.show_targets, context)
    return listing.total


def draw_targets(context: bpy.types.Context) -> None:
    """Gives the targets of the chosen corpus and phase, around the chosen rig, to the 3D view."""
    settings, listing = context.scene.reachcast, context.window_manager.reachcast_motions
    corpus = opened_corpus(native.core(), corpus_path(settings))
    phase = None if listing.phase == "ALL" else listing.phase
    target_cloud.set_points(target_points(corpus, settings.rig, phase), settings.rig)


def fill(listing: MotionListing, corpus: Any) -> None:
    """Lists the motions of the chosen phase, the first MOST_LISTED of them."""
    motions = [motion for motion in corpus.motions() if listing.phase in ("ALL", motion.phase)]
    listing.rows.clear()
    listing.total, listing.source, listing.active = len(motions), str(corpus.path), 0
    for motion in motions[:MOST_LISTED]:
        row = listing.rows.add()
        row.motion = motion.id
        origin = Path(motion.origin).name + (" (mirror image)" if motion.mirrored else "")
        row.name = f"{motion.id} {motion.phase} {origin}"
        row.phase, row.place = motion.phase, length_text(motion.target[2])
        row.duration = f"{motion.duration:.1f} s"
        row.words = (f"Motion {motion.id}: {person_text(motion.subject)}, hands to {place_text(motion.target)}, from "
                     f"{origin}")
