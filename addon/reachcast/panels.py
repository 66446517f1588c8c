# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar tab "Reachcast": the task as a sentence, what is missing, the button, and what came of it."""
from __future__ import annotations

import textwrap

import bpy

from . import left_out, path_editing
from .corpora import default_corpus
from .operators.corpus_choice import REACHCAST_OT_choose_corpus
from .operators.edit_hand_path import (REACHCAST_OT_edit_hand_path, REACHCAST_OT_finish_hand_path,
                                       REACHCAST_OT_follow_targets)
from .operators.pose_ghosts import REACHCAST_OT_pose_ghosts
from .operators.predict_family import REACHCAST_OT_choose_percentile, REACHCAST_OT_predict_family
from .operators.predict_motion import REACHCAST_OT_predict_motion
from .operators.predict_targets import REACHCAST_OT_predict_targets
from .operators.predict_variants import REACHCAST_OT_predict_variants
from .preferences import error_text, expected_text, offered_corpora
from .properties import needs
from .scene.nla_strips import predicted_action
from .scene.predict_action import TRANSFERS, WEIGHTS

_LABELS = 0.3  #: part of the panel's width that the words take


class Tab:
    """Where all panels of the add-on are."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Reachcast"


class REACHCAST_MT_corpora(bpy.types.Menu):
    bl_label = "Corpora"
    bl_description = "Corpora in the folders that the preferences name"

    def draw(self, _context: bpy.types.Context) -> None:
        if default_corpus():
            self.layout.operator(REACHCAST_OT_choose_corpus.bl_idname, text="Simulated, ships with it").path = ""
        found = offered_corpora()
        for path in found:
            self.layout.operator(REACHCAST_OT_choose_corpus.bl_idname, text=path.stem).path = str(path)
        if not found:
            self.layout.label(text="Name folders in the add-on's preferences", icon="INFO")


class REACHCAST_PT_lift(Tab, bpy.types.Panel):
    bl_label = "Lift to Shelf"
    bl_description = "The task as a sentence: who does what with which box, from where to where, and the button"

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.reachcast
        column = self.layout.column(align=True)
        for words, name in (("Rig", "rig"), ("does", "errand"), ("with", "working_hands"), ("the box", "box"),
                            ("from", "home"), ("to", "shelf"), ("coming", "approach"), ("past", "obstacles"),
                            ("as in", "corpus")):
            row = _sentence_part(column, settings, words, name)
            if name == "corpus":
                row.menu(REACHCAST_MT_corpora.__name__, text="", icon="DOWNARROW_HLT")
            if name == "box" and settings.box:
                _sentence_part(column, settings.box, "of", "reachcast_box_mass")
            if name == "box" and settings.box and settings.working_hands == "BOTH":
                split = column.split(factor=_LABELS)
                split.label(text="held at")
                row = split.row(align=True)
                row.prop(settings, "handle_left", text="")
                row.prop(settings, "handle_right", text="")
        if not settings.corpus and default_corpus():
            _words(column, "", "the simulated one")
        blocking = [need for need in needs(settings) if need.reason]
        for need in blocking:
            lines(self.layout, context, need.reason, "ERROR")
        row = self.layout.row()
        row.scale_y = 1.4
        row.operator(REACHCAST_OT_predict_motion.bl_idname, icon="ACTION")
        session = path_editing.active()
        if session is None:
            row.operator(REACHCAST_OT_follow_targets.bl_idname, text="", icon="PLAY")
        elif not session.curves:
            row.operator(REACHCAST_OT_finish_hand_path.bl_idname, text="", icon="PAUSE")
        problem = context.window_manager.reachcast_problem
        if problem:
            lines(self.layout, context, f"{problem[0].upper()}{problem[1:]}.", "CANCEL")
        elif not blocking:
            lines(self.layout, context, f"Ready: starts at frame {context.scene.frame_current}.", "CHECKMARK")


class REACHCAST_PT_subject(Tab, bpy.types.Panel):
    bl_label = "Person"
    bl_description = "Whose way of moving is predicted: size, sex, age and body mass"
    bl_parent_id = "REACHCAST_PT_lift"

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.reachcast
        column = self.layout.column(align=True)
        _sentence_part(column, settings, "Stature", "stature")
        if settings.stature == 0.0:
            _words(column, "", "the rig's own")
        _sentence_part(column, settings, "Sex", "sex")
        _sentence_part(column, settings, "Age", "age")
        _sentence_part(column, settings, "Mass", "mass")
        split = column.split(factor=_LABELS)
        split.label(text="Size")
        row = split.row(align=True)
        for percentile in (5, 50, 95):
            row.operator(REACHCAST_OT_choose_percentile.bl_idname, text=f"{percentile}th").percentile = percentile
        _sentence_part(column, settings, "Bones", "bone_map")


class REACHCAST_PT_output(Tab, bpy.types.Panel):
    bl_label = "Output"
    bl_description = "What a prediction leaves besides its Actions: markers, assets, NLA strips"
    bl_parent_id = "REACHCAST_PT_lift"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.reachcast
        column = self.layout.column(align=True)
        column.prop(settings, "markers", text="Markers on the timeline")
        column.prop(settings, "assets", text="Actions as assets")
        column.prop(settings, "strips", text="Actions on NLA strips")


class REACHCAST_PT_hand_path(Tab, bpy.types.Panel):
    bl_label = "Hand Path"
    bl_description = "Shape the way of the hands by hand; the whole body follows"
    bl_parent_id = "REACHCAST_PT_lift"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        session = path_editing.active()
        if session is None or not session.curves:
            column = self.layout.column(align=True)
            column.operator(REACHCAST_OT_edit_hand_path.bl_idname, icon="CURVE_BEZCURVE")
            column.operator(REACHCAST_OT_edit_hand_path.bl_idname, text="Edit Empty Hands Too").all_phases = True
            return
        lines(self.layout, context, f"Move the handles of {', '.join(session.curves.values())} in Edit Mode, or the "
                                    f"ends: '{session.result.action}' follows.", "CURVE_BEZCURVE")
        self.layout.operator(REACHCAST_OT_finish_hand_path.bl_idname, icon="CHECKMARK")


class REACHCAST_PT_variants(Tab, bpy.types.Panel):
    bl_label = "Variants"
    bl_description = "Several motions of the same task, as different people would do it"
    bl_parent_id = "REACHCAST_PT_lift"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.reachcast
        column = self.layout.column(align=True)
        for words, name in (("Number", "variants"), ("Seed", "seed"), ("Variation", "variation"),
                            ("as", "variants_as")):
            _sentence_part(column, settings, words, name)
        if settings.variants_as == "GHOSTS":
            _sentence_part(column, settings, "Spacing", "spacing")
        column.prop(settings, "spread", text="Draw their spread as a tube")
        self.layout.operator(REACHCAST_OT_predict_variants.bl_idname, icon="MOD_ARRAY")


class REACHCAST_PT_others(Tab, bpy.types.Panel):
    bl_label = "Several at Once"
    bl_description = "The same task for people of other sizes, or to several places"
    bl_parent_id = "REACHCAST_PT_lift"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        column = self.layout.column(align=True)
        column.operator(REACHCAST_OT_predict_family.bl_idname, icon="COMMUNITY")
        column.operator(REACHCAST_OT_predict_targets.bl_idname, icon="EMPTY_AXIS")


class REACHCAST_PT_result(Tab, bpy.types.Panel):
    bl_label = "Last Result"
    bl_description = "What the motion on the rig rests on, and how exact it is"
    bl_parent_id = "REACHCAST_PT_lift"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return predicted_action(context.scene.reachcast.rig) is not None

    def draw(self, context: bpy.types.Context) -> None:
        action = predicted_action(context.scene.reachcast.rig)
        if action is None:
            return
        column = self.layout.column(align=True)
        _words(column, "Action", action.name)
        for event in action["reachcast_events"].split(", "):
            _words(column, event.replace("_", " ").capitalize(), f"frame {action[event]}")
        for words, name in (("Landing", "landing"), ("Grip", "grip")):
            if (error := action.get(f"reachcast_{name}_error_m")) is not None:
                _words(column, words, f"{error_text(error)} off")
        lines(self.layout, context, f"Hand paths: {action['reachcast_ways'].replace(', ', '; ')}", "CURVE_BEZCURVE")
        kind = action["reachcast_corpus_kind"]
        if action["reachcast_outside_data"]:
            why = action["reachcast_outside_reasons"] or "the target"
            lines(self.layout, context, f"Outside the {kind} data, take it with care: {why}", "ERROR")
        else:
            lines(self.layout, context, f"Within the {kind} data.", "CHECKMARK")
        self.draw_expected_error(context, action)
        lines(self.layout, context, f"From motions {action['reachcast_neighbours']}", "COMMUNITY")
        self.layout.operator(REACHCAST_OT_pose_ghosts.bl_idname, icon="GHOST_ENABLED")
        if action["reachcast_corrections"]:
            lines(self.layout, context, f"Corrected: {action['reachcast_corrections']}", "INFO")

    def draw_expected_error(self, context: bpy.types.Context, action: bpy.types.Action) -> None:
        found = left_out.known(action.get("reachcast_corpus", ""))
        neighbours = dict(zip(action.get(TRANSFERS, ()), action.get(WEIGHTS, ())))
        error = left_out.expected_error(neighbours, found) if found else None
        if error is not None:
            kind = action["reachcast_corpus_kind"]
            of_whom = found.what if kind == "recorded" else f"{kind} {found.what}"
            lines(self.layout, context, f"Expected error here: {expected_text(error)} (left out {of_whom})",
                  "DRIVER_DISTANCE")


def _sentence_part(column: bpy.types.UILayout, settings: bpy.types.bpy_struct, words: str,
                   name: str) -> bpy.types.UILayout:
    """Words and what is chosen for them; returns the row of the latter."""
    split = column.split(factor=_LABELS)
    split.label(text=words)
    row = split.row(align=True)
    row.prop(settings, name, text="")
    return row


def _words(column: bpy.types.UILayout, left: str, right: str) -> None:
    split = column.split(factor=_LABELS)
    split.label(text=left)
    split.label(text=right)


def lines(layout: bpy.types.UILayout, context: bpy.types.Context, text: str, icon: str) -> None:
    """A sentence over as many lines as the panel's width needs, so that no word is cut off."""
    scale = context.preferences.system.ui_scale
    letters = max(16, int((context.region.width / scale - 60.0) / 6.3))
    column = layout.column(align=True)
    column.scale_y = 0.8
    for number, line in enumerate(textwrap.wrap(text, letters) or [""]):
        column.label(text=line, icon=icon if number == 0 else "BLANK1")
