# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import bpy

from ..properties import missing
from ..scene.movers import HOLD
from ..scene.several_targets import TargetsResult, target_steps
from ..scene.steps import Steps
from .predict_motion import publish, task_of
from .stepwise import Stepwise


def _shelves(context: bpy.types.Context) -> list[bpy.types.Object]:
    settings = context.scene.reachcast
    others = {settings.home, settings.handle_left, settings.handle_right}
    return sorted((item for item in context.selected_objects
                   if item.type == "EMPTY" and HOLD not in item and item not in others), key=lambda item: item.name)


class REACHCAST_OT_predict_targets(Stepwise, bpy.types.Operator):
    bl_idname = "reachcast.predict_targets"
    bl_label = "Targets from Selection"
    bl_description = "Write one Action for each selected Empty, taken as the shelf"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        reason = missing(context.scene.reachcast, without=("Shelf",))
        if reason is None and not _shelves(context):
            reason = "Select the Empties on the shelves."
        if reason:
            cls.poll_message_set(reason)
        return reason is None

    def steps(self, context: bpy.types.Context) -> Steps[TargetsResult]:
        return target_steps(shelves=_shelves(context), **{name: value for name, value in task_of(context).items()
                                                          if name != "shelf"})

    def finish(self, context: bpy.types.Context, found: TargetsResult) -> str:
        publish(self, context, found.results)
        if found.failed:
            shelf, reason = found.failed[0]
            return f"{len(found.results)} Actions; not to {len(found.failed)}, '{shelf}': {reason}"
        return f"{len(found.results)} Actions, one for each target"
