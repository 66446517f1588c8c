# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel asks for, kept on the Scene, and what of it is still missing."""
from __future__ import annotations

import os
from dataclasses import dataclass

import bpy

from . import native
from .corpora import default_corpus
from .corpus_settings import follow_choice
from .scene.control_rig import CHOICES
from .scene.movers import HOLD
from .scene.read_rig import recognise
from .scene.read_task import BOX_MASS, DEFAULT_MASS
from .subject_settings import SubjectSettings

#: The sentence of the last prediction that failed. On the WindowManager: neither saved nor undone.
PROBLEM = bpy.props.StringProperty(name="Problem", options={"HIDDEN", "SKIP_SAVE"})

#: On an armature with controls of its own, a generated Rigify rig.
HANDS = bpy.props.EnumProperty(name="Hands", items=CHOICES, description="How a motion is written on this rig's arms")
FEET = bpy.props.EnumProperty(name="Feet", items=CHOICES, description="How a motion is written on this rig's legs")


def _box_mass(box: bpy.types.Object) -> float:
    value = box.get(BOX_MASS, DEFAULT_MASS)
    return float(value) if isinstance(value, (int, float)) else 0.0  # a prediction refuses it by name


def _set_box_mass(box: bpy.types.Object, value: float) -> None:
    box[BOX_MASS] = value


#: Of a box, kept in its custom property.
MASS = bpy.props.FloatProperty(
    name="Box Mass", min=0.0, max=200.0, precision=1, unit="MASS", get=_box_mass, set=_set_box_mass,
    description="What the box weighs; the predicted person leans against it to keep the balance")


def _is_armature(_settings: bpy.types.PropertyGroup, item: bpy.types.Object) -> bool:
    return item.type == "ARMATURE"


def _is_place(_settings: bpy.types.PropertyGroup, item: bpy.types.Object) -> bool:
    return item.type == "EMPTY" and HOLD not in item


def _is_mesh(_settings: bpy.types.PropertyGroup, item: bpy.types.Object) -> bool:
    return item.type == "MESH"


#: What can be chosen in the panel -> the phases it means. Scripts may give any other order.
ERRANDS = {
    "LIFT": ("transfer",),
    "REACH_LIFT_RETURN": ("reach", "transfer", "return"),
    "FETCH": ("reach", "retrieve", "return"),
    "THERE_AND_BACK": ("reach", "transfer", "return", "reach", "retrieve", "return"),
}


class ReachcastSettings(SubjectSettings, bpy.types.PropertyGroup):
    rig: bpy.props.PointerProperty(
        name="Rig", type=bpy.types.Object, poll=_is_armature, update=follow_choice,
        description="The armature that carries the box")
    errand: bpy.props.EnumProperty(
        name="Errand", default="LIFT", description="What the person does, from the first frame to the last",
        items=(("LIFT", "Lift", "Hands on the box at its home; carries it to the shelf and lets go"),
               ("REACH_LIFT_RETURN", "Reach, lift, return", "Empty hands reach for the box, carry it to the shelf and "
                                                            "go back to the sides"),
               ("FETCH", "Fetch", "Empty hands reach for the box on the shelf, carry it home and go back to the sides"),
               ("THERE_AND_BACK", "There and back", "Reach, lift and return, then fetch it again")))
    working_hands: bpy.props.EnumProperty(
        name="Hands", default="BOTH", description="Which hands reach for the box and carry it",
        items=(("BOTH", "Both Hands", "One on each side of the box, or at its two handles"),
               ("RIGHT", "Right Hand", "It holds the box in its middle; the left arm hangs and swings"),
               ("LEFT", "Left Hand", "It holds the box in its middle; the right arm hangs and swings")))
    box: bpy.props.PointerProperty(
        name="Box", type=bpy.types.Object, poll=_is_mesh,
        description="The mesh that is carried; it follows the hands while they hold it, left and right along its own x. "
                    "Without one the rig moves an average box that is not shown")
    handle_left: bpy.props.PointerProperty(
        name="Handle", type=bpy.types.Object, poll=_is_place,
        description="An Empty where one hand holds the box, best parented to it. Without two of them the hands hold the "
                    "middles of its sides")
    handle_right: bpy.props.PointerProperty(
        name="Other Handle", type=bpy.types.Object, poll=_is_place,
        description="An Empty where the other hand holds the box, as high as the first")
    home: bpy.props.PointerProperty(
        name="Home", type=bpy.types.Object, poll=_is_place,
        description="The Empty where the middle of the box's base starts. "
                    "Without one it starts where the box stands, or in front of the body at waist height")
    shelf: bpy.props.PointerProperty(
        name="Shelf", type=bpy.types.Object, poll=_is_place,
        description="The Empty where the middle of the box's base ends")
    obstacles: bpy.props.PointerProperty(
        name="Obstacles", type=bpy.types.Collection,
        description="The collection whose meshes the box and the hands keep clear of, such as the shelf's boards. "
                    "Arms and body are not looked at")
    approach: bpy.props.EnumProperty(
        name="Approach", default="FREE", description="From where the hands, or the box in them, come to the shelf",
        items=(("FREE", "as people do", "As the recorded people did"), ("ABOVE", "from above", "Down onto the shelf"),
               ("FRONT", "from the front", "From the side where the person stands"),
               ("SIDE", "from the side", "From the side where the hands come from")))
    variants: bpy.props.IntProperty(
        name="Variants", default=5, min=1, max=1000, soft_max=50, description="How many motions are drawn")
    seed: bpy.props.IntProperty(
        name="Seed", default=1, min=0, description="Of the first variant; the others have the numbers after it. The same "
                                                   "seed gives the same motion on every machine")
    variation: bpy.props.FloatProperty(
        name="Variation", default=1.0, min=0.0, max=2.0, subtype="FACTOR",
        description="How far from the mean: 1 is as far as the recorded people")
    variants_as: bpy.props.EnumProperty(
        name="Shown as", default="ACTIONS", description="Where the variants go",
        items=(("ACTIONS", "Actions", "One Action each on the rig, the first of which is active"),
               ("GHOSTS", "Ghosts", "Copies of the rig and the box, side by side, that all move at once")))
    spacing: bpy.props.FloatProperty(
        name="Spacing", default=1.0, min=0.0, max=100.0, subtype="DISTANCE", unit="LENGTH",
        description="Between one ghost and the next, to the subject's right; 0 puts them on top of each other")
    spread: bpy.props.BoolProperty(
        name="Spread", default=True,
        description="Draw how far the hands' paths spread, as a tube two standard deviations wide about their mean")
    markers: bpy.props.BoolProperty(
        name="Markers", default=True,
        description="Mark grasp, lift-off, placed and release on the timeline, in place of the rig's earlier markers")
    assets: bpy.props.BoolProperty(
        name="Assets", default=False, description="Mark the new Actions as assets, for the asset browser")
    strips: bpy.props.BoolProperty(
        name="Strips", default=False,
        description="Put the new Actions on new NLA tracks above the others, as Push Down does, and leave no Action active. "
                    "Of several the first plays and the others' tracks are muted")
    corpus: bpy.props.StringProperty(
        name="Corpus", subtype="FILE_PATH", update=follow_choice,
        description="The file of motions to learn from; empty takes the one that ships with the add-on, which is "
                    "simulated: nobody was recorded for it")
    bone_map: bpy.props.StringProperty(
        name="Bone Map", subtype="FILE_PATH",
        description="A JSON file that says which bone is which; empty recognises the rigs of many tools by their names")



@dataclass(frozen=True)
class Need:
    """One thing a prediction needs. `reason` is None when it is there."""

    name: str
    reason: str | None


def needs(settings: ReachcastSettings) -> list[Need]:
    """What a prediction needs, in the order of the panel. Cheap enough for every redraw."""
    return [
        Need("Native module", native.reason()),
        Need("Rig", _rig_reason(settings)),
        Need("Shelf", None if settings.shelf else "Choose the Empty on the shelf."),
        Need("Corpus", _corpus_reason(settings.corpus)),
    ]


def missing(settings: ReachcastSettings, without: tuple[str, ...] = ()) -> str | None:
    """The first reason why Predict Motion cannot run, or None; needs named in `without` are not looked at."""
    return next((need.reason for need in needs(settings) if need.reason and need.name not in without), None)


def _rig_reason(settings: ReachcastSettings) -> str | None:
    rig = settings.rig
    if rig is None:
        return "Choose the armature that carries the box."
    if rig.mode == "EDIT":
        return f"Leave Edit Mode on '{rig.name}' first."
    if settings.bone_map:
        path = bpy.path.abspath(settings.bone_map)
        return None if os.path.isfile(path) else f"The bone map {path} does not exist."
    try:
        recognise(rig)
    except ValueError as error:
        return f"{error}."
    return None


def _corpus_reason(path: str) -> str | None:
    if not path:
        return None if default_corpus() else "Choose a corpus: none ships with this build."
    full = bpy.path.abspath(path)
    return None if os.path.isfile(full) else f"The corpus {full} does not exist."
