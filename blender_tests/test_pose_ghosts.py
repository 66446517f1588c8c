# SPDX-License-Identifier: GPL-3.0-or-later
"""Ghosts stand where the figure and the box are at their frames, and keep standing there."""
from __future__ import annotations

import bpy
import numpy as np
from reachcast.scene.ghosts import worn_by
from reachcast.scene.pose_ghosts import MOST_GHOSTS, add_pose_ghosts
from scene_cases import Scene


def shown_points(item: bpy.types.Object) -> np.ndarray:
    shown = item.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return np.array([shown.matrix_world @ vertex.co for vertex in shown.data.vertices])


class PoseGhosts(Scene):
    def test_they_are_what_was_shown_at_the_frames(self) -> None:
        self.furnish()
        result = self.predict()
        bpy.context.scene.frame_set(3)
        frames = [result.frames["grasp"], result.frames["placed"]]
        name = add_pose_ghosts(self.rig, frames, box=self.box)
        self.assertEqual(bpy.context.scene.frame_current, 3)
        items = [*worn_by(self.rig), self.box]
        ghosts = bpy.data.collections[name].objects
        self.assertEqual(len(ghosts), len(frames) * len(items))
        for frame in frames:
            bpy.context.scene.frame_set(frame)
            wanted = {item.name: shown_points(item) for item in items}
            bpy.context.scene.frame_set(3)
            bpy.context.view_layer.update()
            for item, points in wanted.items():
                np.testing.assert_allclose(shown_points(ghosts[f"{item} at {frame}"]), points, atol=1e-5)

    def test_button_needs_a_result_and_takes_the_step(self) -> None:
        self.furnish()
        settings = bpy.context.scene.reachcast
        settings.rig, settings.box = self.rig, self.box
        self.assertFalse(bpy.ops.reachcast.pose_ghosts.poll())
        self.predict(start_frame=1)
        self.assertEqual(bpy.ops.reachcast.pose_ghosts(step=1000), {"FINISHED"})
        self.assertEqual(len([item for item in bpy.data.objects if item.name == "Box at 1"]), 1)

    def test_bad_frames_and_a_bare_rig(self) -> None:
        self.furnish()
        for frames in ((), range(MOST_GHOSTS + 1)):
            with self.assertRaisesRegex(ValueError, "ghosts are wanted at"):
                add_pose_ghosts(self.rig, frames)
        for item in worn_by(self.rig):
            bpy.data.objects.remove(item)
        with self.assertRaisesRegex(ValueError, "wears no mesh"):
            add_pose_ghosts(self.rig, [1])
