# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import bpy

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
        rig = context.scene.reachcast.rig
        action = rig.animation_data.action if rig and rig.animation_data else None
        if action is None or "reachcast_events" not in action:
            cls.poll_message_set("Predict a motion first.")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        settings = context.scene.reachcast
        frames = event_frames(settings.rig.animation_data.action)
        if self.step:
            first = int(settings.rig.animation_data.action["reachcast_first_frame"])
            frames = list(range(first, frames[-1] + 1, self.step))
        try:
            name = add_pose_ghosts(settings.rig, frames, box=settings.box, scene=context.scene)
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"{len(frames)} moments in collection '{name}'")
        return {"FINISHED"}
