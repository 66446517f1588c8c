# SPDX-License-Identifier: GPL-3.0-or-later
"""One hand carries the object, the other hangs: measured in the evaluated scene."""
from __future__ import annotations

import math
import unittest

import bpy
import numpy as np
from lift_cases import LiftScene, cuboid, empty, lift_scene, rig_of
from mathutils import Matrix
from reachcast.operators.predict_motion import task_of
from reachcast.rigs.joints import INDEX
from reachcast.rigs.rotations import Array
from reachcast.scene.action_writer import curves_of
from reachcast.scene.measure import Samples, sample
from reachcast.scene.movers import HOLD
from reachcast.scene.path_session import begin_session, end_session
from reachcast.scene.predict_action import PredictionResult, predict_motion
from reachcast.scene.read_rig import read_rig
from reachcast.scene.variants import predict_variants

PROMISED_M = 1e-3
SEGMENT_M = 1e-5
TRUNK_RADIUS_M = 0.10   #: of a slim trunk about the line from the hips to the neck: no wrist goes through it
SIZE = (0.08, 0.08, 0.20)
SIDES = {"left": 1.0, "right": -1.0}   #: of the world's x, for a rig that faces -y
ROUND_TRIP = ("reach", "transfer", "return", "reach", "retrieve", "return")
SEGMENTS = [(f"{side}_{a}", f"{side}_{b}") for side in SIDES for a, b in (
    ("hip", "knee"), ("knee", "ankle"), ("shoulder", "elbow"), ("elbow", "wrist"), ("wrist", "grip"))]


class OneHand(unittest.TestCase):
    def setUp(self) -> None:
        self.scene: LiftScene = lift_scene(rig_of("mannequin", 1.75))
        bpy.data.objects.remove(self.scene.box)
        self.rig = self.scene.rig
        self.shelf, self.home = empty("Top", Matrix()), empty("Counter", Matrix())
        self.cup = cuboid("Cup", SIZE)

    def arrange(self, hands: str, turned: float = 0.0) -> None:
        side = SIDES[hands]
        self.home.matrix_world = Matrix.Translation((0.25 * side, -0.38, 0.85))
        self.shelf.matrix_world = Matrix.Translation((0.28 * side, -0.42, 1.25)) @ Matrix.Rotation(turned, 4, "Z")
        self.cup.matrix_world = self.home.matrix_world
        bpy.context.view_layer.update()

    def predict(self, hands: str, **options: object) -> PredictionResult:
        return predict_motion(self.rig, self.shelf, box=self.cup, home=self.home, hands=hands, start_frame=1, **options)

    def sampled(self, result: PredictionResult) -> Samples:
        return sample(self.rig, read_rig(self.rig), range(1, result.frames["end"] + 1), self.cup)

    def check(self, hands: str, result: PredictionResult, held: list[tuple[str, str]]) -> None:
        samples = self.sampled(result)
        joints = samples.joints
        grips = joints[:, INDEX[f"{hands}_grip"]]
        middles = samples.box_origins + samples.box_axes @ np.array([0.0, 0.0, 0.5 * SIZE[2]])
        for grasp, release in held:
            span = slice(result.frames[grasp] - 1, result.frames[release])
            self.assertLess(np.linalg.norm(grips[span] - middles[span], axis=1).max(), PROMISED_M)
        for a, b in SEGMENTS:
            lengths = np.linalg.norm(joints[:, INDEX[a]] - joints[:, INDEX[b]], axis=1)
            self.assertLess(np.ptp(lengths), SEGMENT_M, f"{a} to {b}")
        for foot in ("left_ankle", "right_ankle", "left_ball", "right_ball"):
            self.assertLess(np.linalg.norm(joints[:, INDEX[foot]] - joints[0, INDEX[foot]], axis=1).max(), PROMISED_M)
        free = "left" if hands == "right" else "right"
        for part in ("wrist", "grip", "elbow"):
            self.assertGreater(from_trunk(joints, joints[:, INDEX[f"{free}_{part}"]]).min(), TRUNK_RADIUS_M, part)
        down = joints[:, INDEX[f"{free}_shoulder"]] - joints[:, INDEX[f"{free}_grip"]]
        self.assertGreater((down[:, 2] / np.linalg.norm(down, axis=1)).min(), 0.85, "the free arm hangs")

    def test_right_and_left_hand_there_and_back(self) -> None:
        for hands in SIDES:
            self.arrange(hands, turned=0.4)
            result = self.predict(hands, phases=ROUND_TRIP)
            self.assertLess(result.errors["grip"], PROMISED_M)
            self.assertLess(result.errors["landing"], PROMISED_M)
            self.check(hands, result, [("grasp", "release"), ("grasp_2", "release_2")])
            shown = self.sampled(result).box_origins[result.frames["placed"] - 1]
            self.assertLess(np.linalg.norm(shown - self.shelf.matrix_world.translation), PROMISED_M)

    def test_between_frames_the_object_stays_in_the_hand(self) -> None:
        self.arrange("right", turned=-0.8)
        result = self.predict("right")
        hold = next(item for item in bpy.data.objects if HOLD in item)
        for frame in range(result.frames["grasp"], result.frames["release"]):
            bpy.context.scene.frame_set(frame, subframe=0.5)
            graph = bpy.context.evaluated_depsgraph_get()
            cup, at = (item.evaluated_get(graph).matrix_world for item in (self.cup, hold))
            self.assertLess(((cup @ Matrix.Translation((0, 0, 0.5 * SIZE[2]))).translation - at.translation).length,
                            PROMISED_M)

    def test_another_hand_has_another_hold_and_takes_over(self) -> None:
        self.arrange("right")
        self.predict("right")
        bpy.context.scene.frame_set(1)
        self.arrange("left")
        result = self.predict("left")
        self.check("left", result, [("grasp", "release")])
        self.assertEqual(sorted(item[HOLD] for item in bpy.data.objects if HOLD in item), ["left", "right"])
        curves = {curve.data_path: curve for curve in curves_of(bpy.data.actions[result.box_action])
                  if "influence" in curve.data_path}
        middle = (result.frames["grasp"] + result.frames["release"]) // 2
        self.assertEqual(sorted(curve.evaluate(middle) for curve in curves.values()), [0.0, 1.0])

    def test_the_panel_says_which_hand(self) -> None:
        self.arrange("left")
        settings = bpy.context.scene.reachcast
        settings.rig, settings.shelf, settings.box = self.rig, self.shelf, self.cup
        self.assertNotIn("hands", task_of(bpy.context))
        settings.handle_left, settings.handle_right = empty("One", Matrix()), empty("Other", Matrix())
        settings.working_hands = "LEFT"
        task = task_of(bpy.context)
        self.assertEqual(task["hands"], "left")
        self.assertNotIn("handles", task)

    def test_hands_that_do_not_exist_and_handles_are_refused(self) -> None:
        self.arrange("left")
        with self.assertRaisesRegex(ValueError, "both, left or right"):
            self.predict("third")
        with self.assertRaisesRegex(ValueError, "for both hands"):
            self.predict("left", handles=(self.home, self.shelf))

    def test_without_an_object_something_small_is_thought_of_ahead_of_the_shoulder(self) -> None:
        self.arrange("right")
        result = predict_motion(self.rig, self.shelf, hands="right", start_frame=1)
        self.assertLess(result.errors["landing"], PROMISED_M)
        start = sample(self.rig, read_rig(self.rig), [1], None).joints[0, INDEX["right_grip"]]
        self.assertLess(start[0], -0.1)

    def test_hand_path_goes_through_the_working_grip_and_is_followed(self) -> None:
        self.arrange("right")
        session = begin_session(self.rig, self.shelf, box=self.cup, home=self.home, hands="right", start_frame=1)
        self.addCleanup(end_session, session)
        curve = bpy.data.objects[next(iter(session.curves.values()))]
        spline = curve.data.splines[0]
        grip = self.sampled(session.result).joints[session.result.frames["lift_off"] - 1, INDEX["right_grip"]]
        self.assertLess((curve.matrix_world @ spline.bezier_points[0].co - type(spline.bezier_points[0].co)(grip)).length,
                        PROMISED_M)
        spline.bezier_points[0].handle_right.z += 0.1
        self.assertTrue(session.update())
        self.check("right", session.result, [("grasp", "release")])

    def test_variants_keep_the_hand_on_the_object(self) -> None:
        self.arrange("right")
        made = predict_variants(self.rig, self.shelf, box=self.cup, home=self.home, hands="right", count=3, start_frame=1)
        self.assertEqual(len(made.results) + len(made.failed), 3)
        for result in made.results:
            self.assertLess(result.errors["grip"], PROMISED_M)


def from_trunk(joints: Array, points: Array) -> Array:
    """(F,) metres of points (F, 3) from the line between l5s1 and c7t1."""
    low, high = joints[:, INDEX["l5s1"]], joints[:, INDEX["c7t1"]]
    along = high - low
    share = np.clip(np.sum((points - low) * along, axis=1) / np.sum(along * along, axis=1), 0.0, 1.0)
    distance = np.linalg.norm(points - low - share[:, None] * along, axis=1)
    assert math.isfinite(float(distance.sum()))
    return distance
