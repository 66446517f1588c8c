# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import bpy

from ..scene.nla_strips import predicted_action
from ..scene.pose_ghosts import add_pose_ghosts, event_frames


class REACHCAST_OT_pose_ghosts(bpy.types.Operator):
    bl_idname = "reachcast.pose_ghosts"
    bl_label = "Ghosts of the Result"
    bl_description = "Put still copies of the figure and the box at the moments of the motion, into a new collection"
    bl_options = {"REGISTER", "UNDO"}

    step: bpy.props.IntProperty(
        name="Every", default=0, min=0, max=1000,
        description="A ghost every so many frames; 0 puts one at grasp, lift-off, placed, release and end")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if predicted_action(context.scene.reachcast.rig) is None:
            cls.poll_message_set("Predict a motion first.")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        settings = context.scene.reachcast
        action = predicted_action(settings.rig)
        frames = event_frames(action)
        if self.step:
            first = int(action["reachcast_first_frame"])
            frames = list(range(first, frames[-1] + 1, self.step))
        try:
            name = add_pose_ghosts(settings.rig, frames, box=settings.box, scene=context.scene)
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"{len(frames)} moments in collection '{name}'")
        return {"FINISHED"}
