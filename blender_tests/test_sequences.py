# SPDX-License-Identifier: GPL-3.0-or-later
"""Several phases and obstacles, measured in the evaluated scene. Overlaps are found by mathutils, not by the core."""
from __future__ import annotations

import unittest

import bpy
import corpora
import numpy as np
from lift_cases import LiftScene, Place, cuboid, lift_scene, rig_of, see
from mathutils import Matrix
from mathutils.bvhtree import BVHTree
from reachcast.scene.predict_action import PredictionResult
from reachcast.scene.read_obstacles import read_obstacles
from reachcast.scene.read_rig import read_rig

EXACT_M = 1e-3   #: of the issue
ERRAND = ("reach", "transfer", "return", "reach", "retrieve", "return")
PLACE = Place(1.0, 60, 0.55, facing=True)


def overlaps(one: bpy.types.Object, other: bpy.types.Object) -> bool:
    graph = bpy.context.evaluated_depsgraph_get()
    trees = []
    for item in (one, other):
        shown = item.evaluated_get(graph)
        mesh = shown.to_mesh()
        mesh.transform(shown.matrix_world)
        trees.append(BVHTree.FromPolygons([vertex.co for vertex in mesh.vertices],
                                          [polygon.vertices for polygon in mesh.polygons]))
        shown.to_mesh_clear()
    return bool(trees[0].overlap(trees[1]))


class Sequences(unittest.TestCase):
    def scene(self, rig: str, stature: float = 1.72) -> LiftScene:
        scene = lift_scene(rig_of(rig, stature))
        scene.arrange(PLACE, "floor")
        return scene

    def seen(self, scene: LiftScene, result: PredictionResult):  # type: ignore[no-untyped-def]
        return see(scene, range(result.first_frame, result.frames["end"] + 1))

    def test_there_and_back_holds_the_box_and_keeps_the_feet(self) -> None:
        for rig in ("mannequin", "metarig"):
            with self.subTest(rig=rig):
                scene = self.scene(rig)
                result = scene.predict(corpora.recorded_corpus(), start_frame=1, phases=ERRAND)
                seen = self.seen(scene, result)
                off = np.linalg.norm(seen.grips - seen.handles, axis=2).max(axis=1)
                for grasp, release in (("grasp", "release"), ("grasp_2", "release_2")):
                    held = off[result.frames[grasp] - 1:result.frames[release]]
                    self.assertLess(held.max(), EXACT_M)
                self.assertGreater(off[0], 0.3, "hands begin at the sides")
                self.assertGreater(off[-1], 0.3, "and end there")
                np.testing.assert_allclose(seen.feet, np.broadcast_to(seen.feet[0], seen.feet.shape), atol=EXACT_M)
                np.testing.assert_allclose(seen.lengths, 1.0, atol=1e-4)
                placed, back = (seen.boxes[result.frames[name] - 1][:3, 3] for name in ("placed", "placed_2"))
                self.assertLess(np.linalg.norm(placed - np.array(scene.shelf.matrix_world.translation)), EXACT_M)
                self.assertLess(np.linalg.norm(back - np.array(scene.home.matrix_world.translation)), EXACT_M)

    def test_the_box_goes_round_a_board(self) -> None:
        hit = {}
        for rig in ("mannequin", "metarig"):
            for given in (False, True):
                scene = self.scene(rig)
                board = cuboid("Board", (0.6, 0.34, 0.03))
                board.matrix_world = scene.shelf.matrix_world @ Matrix.Translation((0.0, -0.02, -0.0301))
                bpy.context.view_layer.update()
                result = scene.predict(corpora.recorded_corpus(), start_frame=1, phases=ERRAND[:3],
                                       obstacles=[board] if given else [])
                touched = 0
                for frame in range(result.first_frame, result.frames["end"] + 1):
                    bpy.context.scene.frame_set(frame)
                    touched += overlaps(scene.box, board)
                hit[rig, given] = touched
                self.assertEqual(any("obstacles" in said for said in result.corrections), given)
        self.assertEqual((hit["mannequin", True], hit["metarig", True]), (0, 0), hit)
        self.assertGreater(hit["mannequin", False] + hit["metarig", False], 0, "else the board was not in the way")

    def test_phases_that_cannot_follow_one_another_are_refused(self) -> None:
        scene = self.scene("mannequin")
        for phases, words in ((("transfer", "reach"), "at rest"), ((), "empty"), (("lift",), "'lift'")):
            with self.assertRaisesRegex(ValueError, words):
                scene.predict(corpora.recorded_corpus(), phases=phases)
        self.assertEqual(len(bpy.data.actions), 0)

    def test_a_phase_that_nobody_was_recorded_in_takes_the_published_path_and_says_so(self) -> None:
        scene = self.scene("mannequin")
        result = scene.predict(corpora.large_corpus(), start_frame=1, phases=("transfer", "return"))
        self.assertEqual(result.ways, (("transfer", "deviation"), ("return", "published")))
        self.assertIn("no return was recorded", "; ".join(result.outside_reasons))
        seen = self.seen(scene, result)
        np.testing.assert_allclose(seen.feet, np.broadcast_to(seen.feet[0], seen.feet.shape), atol=EXACT_M)
        np.testing.assert_allclose(seen.lengths, 1.0, atol=1e-4)


class Obstacles(unittest.TestCase):
    def test_triangles_are_those_of_the_evaluated_mesh_in_the_body_frame(self) -> None:
        rig = rig_of("mannequin", 1.7)
        rig.matrix_world = Matrix.Translation((3, -2, 0)) @ Matrix.Rotation(0.7, 4, "Z")
        board = cuboid("Board", (0.5, 0.3, 0.02))
        board.matrix_world = Matrix.Translation((3.4, -2.5, 1)) @ Matrix.Rotation(0.3, 4, "X") @ Matrix.Scale(2, 4)
        board.modifiers.new("Copies", "ARRAY").count = 3
        bpy.context.view_layer.update()
        skeleton = read_rig(rig)
        triangles = read_obstacles(skeleton, [board], bpy.context.view_layer)
        self.assertEqual(triangles.shape, (36, 3, 3))
        shown = board.evaluated_get(bpy.context.evaluated_depsgraph_get())
        corners = {tuple(round(part, 4) for part in skeleton.to_body(np.array(shown.matrix_world @ vertex.co)))
                   for vertex in shown.data.vertices}
        self.assertEqual({tuple(round(part, 4) for part in corner) for corner in triangles.reshape(-1, 3)}, corners)

    def test_only_meshes_can_be_obstacles(self) -> None:
        rig = rig_of("mannequin", 1.7)
        with self.assertRaisesRegex(ValueError, "must be a mesh"):
            read_obstacles(read_rig(rig), [rig], bpy.context.view_layer)
        self.assertIsNone(read_obstacles(read_rig(rig), [], bpy.context.view_layer))
