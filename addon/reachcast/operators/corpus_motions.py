# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from typing import Any

import bpy

from .. import native
from ..corpus_settings import corpus_path, refresh
from ..scene.motion_library import forget_motions, play_motion
from .predict_motion import problem_of, summary


def listing_of(context: bpy.types.Context) -> Any:
    return context.window_manager.reachcast_motions


def _active_row(context: bpy.types.Context) -> Any:
    listing = listing_of(context)
    return listing.rows[listing.active] if 0 <= listing.active < len(listing.rows) else None


class _ForRow:
    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        reason = native.reason()
        if reason is None and _active_row(context) is None:
            reason = "List the motions and choose one first."
        if reason is None and listing_of(context).source != corpus_path(context.scene.reachcast):
            reason = "The list is of another corpus: list the motions again."
        if reason:
            cls.poll_message_set(reason)
        return reason is None


class REACHCAST_OT_list_motions(bpy.types.Operator):
    bl_idname = "reachcast.list_motions"
    bl_label = "List Motions"
    bl_description = "List what is in the corpus, and draw its targets if they are shown"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        reason = native.reason() or (None if corpus_path(context.scene.reachcast) else "Choose a corpus first.")
        if reason:
            cls.poll_message_set(reason)
        return reason is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            count = refresh(context)
        except (ValueError, RuntimeError) as error:
            return problem_of(self, context, error)
        context.window_manager.reachcast_problem = ""
        self.report({"INFO"}, f"{count} motions")
        return {"FINISHED"}


class REACHCAST_OT_play_motion(_ForRow, bpy.types.Operator):
    bl_idname = "reachcast.play_motion"
    bl_label = "Play Motion"
    bl_description = "Write the chosen motion as a new Action on the rig, from the current frame, with no other mixed in"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        settings = context.scene.reachcast
        if settings.rig is None:
            return problem_of(self, context, ValueError("Choose the rig that the motion is put on"))
        try:
            result = play_motion(settings.rig, _active_row(context).motion, corpus=corpus_path(settings),
                                 bone_map=settings.bone_map or None, scene=context.scene)
        except (ValueError, RuntimeError) as error:
            return problem_of(self, context, error)
        context.window_manager.reachcast_problem = ""
        self.report({"INFO"}, summary(result))
        return {"FINISHED"}


class REACHCAST_OT_forget_motion(_ForRow, bpy.types.Operator):
    bl_idname = "reachcast.forget_motion"
    bl_label = "Forget Motion"
    bl_description = "Take the chosen motion out of the corpus file. This cannot be undone"

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        return context.window_manager.invoke_confirm(self, event)

    def execute(self, context: bpy.types.Context) -> set[str]:
        settings = context.scene.reachcast
        if not settings.corpus:
            return problem_of(self, context, ValueError("The corpus that ships stays as it is; choose one of your own"))
        place = listing_of(context).active
        try:
            forget_motions(settings.corpus, [_active_row(context).motion])
            refresh(context)
        except (ValueError, RuntimeError) as error:
            return problem_of(self, context, error)
        listing_of(context).active = min(place, len(listing_of(context).rows) - 1)
        return {"FINISHED"}
