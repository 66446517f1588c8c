# SPDX-License-Identifier: GPL-3.0-or-later
"""The box follows the hands by a constraint between grasp and release and stands still otherwise, whatever mesh it is."""
from __future__ import annotations

import math
import os
import unittest

import bpy
import corpora
import numpy as np
from lift_cases import BOX_SIZE, LiftScene, Place, cuboid, empty, lift_scene, rig_of
from mathutils import Euler, Matrix, Vector
from reachcast.rigs.joints import INDEX
from reachcast.scene.action_writer import curves_of
from reachcast.scene.measure import sample
from reachcast.scene.movers import HOLD, is_carrier
from reachcast.scene.predict_action import PredictionResult, predict_motion
from reachcast.scene.read_rig import read_rig
from reachcast.scene.several_targets import predict_to_targets

PROMISED_M = 1e-3
STILL_M = 1e-5  #: single precision
TURNED = Matrix.Translation((2.0, -1.0, 0.0)) @ Matrix.Rotation(0.7, 4, "Z")
BOTH_WAYS = ("reach", "transfer", "return", "reach", "retrieve", "return")


class Carried(unittest.TestCase):
    def setUp(self) -> None:
        self.corpus = os.fspath(corpora.recorded_corpus())
        self.arrange(rig_of("mannequin", 1.72))

    def arrange(self, rig: bpy.types.Object) -> None:
        self.scene: LiftScene = lift_scene(rig)
        rig.matrix_world = TURNED @ rig.matrix_world
        self.scene.arrange(Place(1.1, 30, 0.5, True), "waist", TURNED)

    def predict(self, **options: object) -> PredictionResult:
        return predict_motion(self.scene.rig, self.scene.shelf, **{
            "corpus": self.corpus, "box": self.scene.box, "home": self.scene.home, "start_frame": 1, **options})

    def box_matrices(self, frames: list[float]) -> np.ndarray:
        found = []
        for frame in frames:
            bpy.context.scene.frame_set(int(frame), subframe=frame % 1.0)
            graph = bpy.context.evaluated_depsgraph_get()
            found.append(np.array(self.scene.box.evaluated_get(graph).matrix_world))
        return np.array(found)

    def check(self, result: PredictionResult, base: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> None:
        """Stands, is held and stands again without a jump. base: the middle of the base in the box's own axes."""
        skeleton = read_rig(self.scene.rig)
        samples = sample(self.scene.rig, skeleton, range(1, result.frames["end"] + 1), self.scene.box)
        hands = samples.joints[:, [INDEX["left_grip"], INDEX["right_grip"]]].mean(axis=1)
        places = samples.box_origins
        suffixes = [event.removeprefix("grasp") for event in result.frames if event.startswith("grasp")]
        before = 1
        for number, suffix in enumerate(suffixes):
            grasp, release = result.frames[f"grasp{suffix}"], result.frames[f"release{suffix}"]
            held = slice(grasp - 1, release)
            for frame in (before, grasp):
                self.assertLess(np.linalg.norm(places[frame - 1] - places[grasp - 1]), PROMISED_M)
            stands = places[before - 1:grasp - 1]
            self.assertLess(np.ptp(stands, axis=0).max(initial=0.0) if len(stands) else 0.0, STILL_M)
            axes = samples.box_axes[held]
            local = np.einsum("fji,fj->fi", axes, hands[held] - places[held])
            self.assertLess(np.linalg.norm(local - local[0], axis=1).max(), PROMISED_M, "not in one place in the hands")
            inner = self.box_matrices([grasp + 0.5, grasp - 0.01, grasp, release - 0.01, release])
            self.assertLess(np.linalg.norm(inner[1, :3, 3] - inner[2, :3, 3]), PROMISED_M, "jumps at the grasp")
            self.assertLess(np.linalg.norm(inner[3, :3, 3] - inner[4, :3, 3]), PROMISED_M, "jumps at the release")
            self.assertLess(np.abs(inner[3, :3, :3] - inner[4, :3, :3]).max(), PROMISED_M)
            goal = (self.scene.shelf, self.scene.home)[number % 2]
            put = self.box_matrices([release])[0] @ np.array([*base, 1.0])
            self.assertLess(np.linalg.norm(put[:3] - goal.matrix_world.translation), PROMISED_M)
            before = release
        self.assertLess(np.ptp(places[before - 1:], axis=0).max(), STILL_M)


class ByConstraint(Carried):
    def test_there_and_back_without_a_jump(self) -> None:
        self.check(self.predict(phases=BOTH_WAYS))

    def test_rigify_and_a_box_turned_half_round_on_a_parent(self) -> None:
        self.arrange(rig_of("metarig", 1.8))
        cart = empty("Cart", TURNED @ Matrix.Rotation(1.1, 4, "Z"))
        self.scene.box.parent = cart
        bpy.context.view_layer.update()
        self.scene.box.matrix_world = self.scene.home.matrix_world @ Matrix.Rotation(math.pi, 4, "Z")
        bpy.context.view_layer.update()
        self.check(self.predict(home=None))

    def test_influence_is_one_only_in_the_hands(self) -> None:
        result = self.predict(phases=BOTH_WAYS)
        curve = next(curve for curve in curves_of(bpy.data.actions[result.box_action]) if "influence" in curve.data_path)
        held = np.zeros(result.frames["end"] + 1, bool)
        for suffix in ("", "_2"):
            held[result.frames[f"grasp{suffix}"]:result.frames[f"release{suffix}"]] = True
        self.assertEqual([curve.evaluate(frame) for frame in range(1, len(held))], held[1:].astype(float).tolist())

    def test_box_goes_along_when_the_animator_moves_the_arms(self) -> None:
        result = self.predict()
        middle = (result.frames["lift_off"] + result.frames["placed"]) // 2
        before = self.box_matrices([middle])[0]
        self.scene.rig.location.z += 0.2
        np.testing.assert_allclose(self.box_matrices([middle])[0] - before, Matrix.Translation((0, 0, 0.2)) - Matrix(),
                                   atol=1e-5)

    def test_one_hold_and_one_constraint_serve_all_actions(self) -> None:
        first = self.predict()
        shown = self.box_matrices([5.0, 40.0])
        self.scene.shelf.location.z += 0.2
        bpy.context.scene.frame_set(1)
        second = self.predict()
        self.check(second)
        self.assertEqual(len([item for item in bpy.data.objects if HOLD in item]), 1)
        self.assertEqual(len(list(filter(is_carrier, self.scene.box.constraints))), 1)
        self.scene.shelf.location.z -= 0.2
        for item, name in ((self.scene.rig, first.action), (self.scene.box, first.box_action)):
            item.animation_data.action = bpy.data.actions[name]
        np.testing.assert_allclose(self.box_matrices([5.0, 40.0]), shown, atol=1e-6)

    def test_is_predicted_from_where_it_is_carried_now(self) -> None:
        result = self.predict()
        bpy.context.scene.frame_set((result.frames["lift_off"] + result.frames["placed"]) // 2)
        here = self.box_matrices([bpy.context.scene.frame_current])[0]
        again = self.predict(home=None)
        np.testing.assert_allclose(self.box_matrices([again.first_frame])[0], here, atol=1e-5)

    def test_another_rig_takes_over(self) -> None:
        self.predict()
        first_rig = self.scene.rig
        other = rig_of("mannequin", 1.6)
        other.matrix_world = TURNED
        self.scene = LiftScene(other, self.scene.shelf, self.scene.home, self.scene.box)
        self.check(self.predict())
        self.assertEqual(len(list(filter(is_carrier, self.scene.box.constraints))), 2)
        self.assertIn(f"Carried by {first_rig.name}", self.scene.box.constraints)

    def test_a_constraint_of_the_users_own_is_still_refused(self) -> None:
        self.scene.box.constraints.new("CHILD_OF").target = self.scene.home
        with self.assertRaisesRegex(ValueError, "constraint 'Child Of'"):
            self.predict()


class AnyMesh(Carried):
    def replace_box(self, box: bpy.types.Object) -> None:
        self.scene = LiftScene(self.scene.rig, self.scene.shelf, self.scene.home, box)
        bpy.context.view_layer.update()

    def test_bounds_are_those_that_modifiers_leave_scaled_and_lying_on_a_side(self) -> None:
        """A half of a box, lying on its back, scaled and mirrored to the whole by a modifier."""
        box = cuboid("Half", (0.5 * BOX_SIZE[0], BOX_SIZE[1], BOX_SIZE[2]))
        box.data.transform(Matrix.Translation((0.25 * BOX_SIZE[0], 0.0, 0.0)))
        box.data.transform(Matrix.Rotation(0.5 * math.pi, 4, "X").inverted())
        box.data.transform(Matrix.Scale(100.0, 4))
        box.modifiers.new("Whole", "MIRROR").use_axis = (True, False, False)
        box.scale = (0.01,) * 3
        box.rotation_euler = Euler((0.5 * math.pi, 0.0, 0.7))
        box.location = self.scene.home.matrix_world.translation
        self.replace_box(box)
        self.check(self.predict(home=None))
        self.assertLess(self.grip_error(0.5 * (BOX_SIZE[0] + 0.04), 0.5 * BOX_SIZE[2]), PROMISED_M)

    def grip_error(self, half: float, up: float) -> float:
        """Of the middle of the hands at the last frame of the lift, to where the box's bounds have their handles."""
        action = self.scene.rig.animation_data.action
        samples = sample(self.scene.rig, read_rig(self.scene.rig), [action["placed"]], self.scene.box)
        hands = samples.joints[0, [INDEX["left_grip"], INDEX["right_grip"]]]
        middle = hands.mean(axis=0) - self.scene.shelf.matrix_world.translation
        return max(float(np.linalg.norm(middle - [0.0, 0.0, up])),
                   abs(float(np.linalg.norm(hands[0] - hands[1])) - 2.0 * half))

    def test_a_tilted_mesh_keeps_its_tilt(self) -> None:
        self.scene.box.rotation_euler.x = 0.5
        bpy.context.view_layer.update()
        tilt = self.scene.box.matrix_world.to_3x3()[2][2]
        result = self.predict(home=None)
        for frame in (1, result.frames["placed"]):
            self.assertAlmostEqual(self.box_matrices([frame])[0][2, 2], tilt, places=5)

    def test_handles_are_where_two_empties_say(self) -> None:
        box = self.scene.box
        handles = []
        for name, place in (("Left", (0.23, 0.05, 0.2)), ("Right", (-0.15, 0.05, 0.2))):
            item = empty(name, Matrix())
            item.parent, item.location = box, place
            handles.append(item)
        bpy.context.view_layer.update()
        for home in (None, self.scene.home):
            bpy.context.scene.frame_set(1)
            result = self.predict(home=home, handles=handles)
            self.check(result)
            for frame in (result.frames["grasp"], result.frames["placed"] - 5, result.frames["placed"]):
                samples = sample(self.scene.rig, read_rig(self.scene.rig), [frame], box)
                hands = samples.joints[0, [INDEX["left_grip"], INDEX["right_grip"]]]
                at = self.box_matrices([frame])[0]
                wanted = np.array([(at @ [*item.location, 1.0])[:3] for item in handles])
                off = min(np.linalg.norm(hands - wanted, axis=1).max(), np.linalg.norm(hands[::-1] - wanted, axis=1).max())
                self.assertLess(off, PROMISED_M)

    def test_bad_handles_are_named(self) -> None:
        low, high = empty("Low", TURNED), empty("High", TURNED @ Matrix.Translation(Vector((0.3, 0.0, 0.3))))
        for handles, words in (((low,), "two objects"), ((low, high), "differ in height by 0.300 m"),
                               ((low, low), "are 0.000 m apart")):
            with self.assertRaisesRegex(ValueError, words):
                self.predict(handles=handles)
        self.assertFalse(bpy.data.actions)


class Targets(Carried):
    def test_every_motion_begins_where_the_box_stood(self) -> None:
        shelves = [empty(f"Shelf {height}", TURNED @ Place(height, 0, 0.5, True).matrix()) for height in (0.7, 1.2)]
        found = predict_to_targets(self.scene.rig, shelves, corpus=self.corpus, box=self.scene.box, start_frame=1)
        for result in found.results:
            for item, name in ((self.scene.rig, result.action), (self.scene.box, result.box_action)):
                item.animation_data.action = bpy.data.actions[name]
            start = self.box_matrices([1])[0]
            np.testing.assert_allclose(start, np.array(self.scene.home.matrix_world), atol=PROMISED_M)


if __name__ == "__main__":
    unittest.main()
