# SPDX-License-Identifier: GPL-3.0-or-later
"""A generated Rigify rig: the motion is written on its controls, and its deform bones do it in the evaluated scene."""
from __future__ import annotations

import unittest

import bpy
import numpy as np
from lift_cases import Place, lift_scene
from mathutils import Matrix
from reachcast.panels_rig import REACHCAST_PT_control_rig
from reachcast.rigs.joints import INDEX, SIDES
from reachcast.rigs.rigify_controls import plan
from reachcast.scene.action_writer import curves_of
from reachcast.scene.measure import foot_slip, measure_lift, sample
from reachcast.scene.read_rig import read_rig
from reachcast.scene.read_task import read_box
from rig_cases import metarig

PROMISED_M = 1e-3
STRETCH = 1e-3          #: Rigify's deform bones stretch to where Blender's IK solver, which iterates, ended
PLACES = {"as made": Matrix(), "scaled, turned, moved": Matrix.LocRotScale(
    (1.0, -2.0, 0.3), Matrix.Rotation(0.9, 3, "Z").to_quaternion(), (0.93,) * 3)}


def generated() -> bpy.types.Object:
    """The human metarig through Rigify's own generator; it takes four seconds."""
    metarig()
    bpy.ops.pose.rigify_generate()
    return bpy.context.object


class ControlRig(unittest.TestCase):
    def test_hands_feet_elbows_and_knees_by_fk_and_by_ik(self) -> None:
        rig = generated()
        bpy.context.scene.reachcast.rig = rig
        self.assertTrue(REACHCAST_PT_control_rig.poll(bpy.context))
        scene = lift_scene(rig)
        for number, (hands, feet) in enumerate((("FK", "FK"), ("IK", "IK"), ("FK", "IK"), ("IK", "FK"))):
            for place, around in PLACES.items():
                with self.subTest(hands=hands, feet=feet, place=place):
                    rig.matrix_world = around
                    rig.reachcast_hands, rig.reachcast_feet = hands, feet
                    scene.arrange(Place(1.1, 20 - 10 * number, 0.45, True), ("floor", "waist")[number % 2], around)
                    rig.pose.bones["tweak_spine.003"].location.x = 0.1  # a pose that the motion must not inherit
                    result = scene.predict(None, start_frame=1)
                    self.check(scene, result)
                    self.check_keys(bpy.data.actions[result.action], hands, feet)
        self.check_refusals(scene)

    def check(self, scene: object, result: object) -> None:
        skeleton = read_rig(scene.rig)
        samples = sample(scene.rig, skeleton, range(1, result.frames["end"] + 1), scene.box)
        measures = measure_lift(samples, skeleton, dict(result.frames), 24.0, read_box(scene.box),
                                np.array(scene.shelf.matrix_world.translation))
        for name in ("landing_m", "grasp_m", "held_m", "left_foot_m"):
            self.assertLess(getattr(measures, name), PROMISED_M, name)
        self.assertLess(foot_slip(samples, "right"), PROMISED_M)
        self.assertLess(measures.stretch, STRETCH)
        self.assertGreater(min(measures.least_elbow_deg, measures.least_knee_deg), 0.0)
        self.check_against_fk(scene, samples.joints)

    def check_against_fk(self, scene: object, joints: np.ndarray) -> None:
        """Elbows and knees are where turning the limbs outwards puts them: the same motion, by the other way."""
        rig = scene.rig
        chosen = rig.reachcast_hands, rig.reachcast_feet
        if chosen == ("FK", "FK"):
            return
        rig.reachcast_hands = rig.reachcast_feet = "FK"
        action, box_action = rig.animation_data.action, scene.box.animation_data.action
        scene.box.animation_data.action = None
        scene.box.matrix_world = scene.home.matrix_world
        again = scene.predict(None, start_frame=1)
        other = sample(rig, read_rig(rig), range(1, again.frames["end"] + 1)).joints
        for _, word in SIDES:
            for joint in ("elbow", "wrist", "grip", "knee", "ankle", "ball"):
                off = np.linalg.norm(joints - other, axis=2)[:, INDEX[f"{word}_{joint}"]].max()
                self.assertLess(off, PROMISED_M, f"{word} {joint}")
        rig.animation_data.action, scene.box.animation_data.action = action, box_action
        rig.reachcast_hands, rig.reachcast_feet = chosen

    def check_keys(self, action: bpy.types.Action, hands: str, feet: str) -> None:
        curves = {(curve.data_path, curve.array_index): curve for curve in curves_of(action)}
        self.assertFalse([path for path, _ in curves if "DEF-" in path or "ORG-" in path])
        for limb, kind in (("upper_arm", hands), ("thigh", feet)):
            switch = curves[f'pose.bones["{limb}_parent.L"]["IK_FK"]', 0]
            self.assertEqual(switch.evaluate(1), float(kind == "FK"))
        end = 'pose.bones["hand_ik.L"].location' if hands == "IK" else 'pose.bones["hand_fk.L"].rotation_quaternion'
        self.assertGreater(len(curves[end, 1].keyframe_points), 10)

    def check_refusals(self, scene: object) -> None:
        rig = scene.rig
        for bone in ("torso", "hand_ik.L"):
            rig.reachcast_hands = "IK"
            constraint = rig.pose.bones[bone].constraints.new("CHILD_OF")
            constraint.name = "Held"
            with self.assertRaisesRegex(ValueError, f"'{bone}' .*constraint 'Held'.*mute or remove"):
                scene.predict(None)
            rig.pose.bones[bone].constraints.remove(constraint)
        rig.data.bones["hand_ik.L"].name = "paw"
        with self.assertRaisesRegex(ValueError, "lacks the controls hand_ik.L"):
            scene.predict(None)

    def test_other_words_than_fk_and_ik_are_refused(self) -> None:
        with self.assertRaisesRegex(ValueError, "hands .* 'both'"):
            plan("both", "FK")


if __name__ == "__main__":
    unittest.main()
