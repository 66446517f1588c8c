# SPDX-License-Identifier: GPL-3.0-or-later
"""From joint centres to a rig's bones: whatever Blender can pose, retargeting and writing give back."""
from __future__ import annotations

import json
import math
import os
import tempfile
import unittest

import bpy
import numpy as np
from mathutils import Euler, Matrix
from reachcast.rigs.joints import INDEX, SIDES
from reachcast.rigs.retarget import EXACT_JOINTS, retarget
from reachcast.rigs.rotations import turn
from reachcast.scene.measure import (Samples, forearm_twists, elbow_flexion, fastest_joint, knee_flexion, sample)
from reachcast.scene.read_rig import read_rig
from reachcast.scene.write_motion import write_rig_action
from rig_cases import EULER_ORDERS, RIGS, mannequin, random_motion, set_rest_arms, set_rolls, turn_about

#: Metres. Keys and Blender's own pose are single precision; errors add up over nine bones.
JOINT_TOLERANCE = 1e-5
#: Relative. A length in single precision after nine products.
STRETCH_TOLERANCE = 5e-6
#: Radians. A limb a little bent at rest takes part of its roll from that bend, part from the straight limb's hinge.
REST_TOLERANCE = 0.01
FRAMES = 24
FIRST = 11

PLACES = {
    "as made": Matrix(),
    "moved": Matrix.Translation((3.0, -2.0, 0.7)),
    "turned": Euler((0.0, 0.0, 2.1)).to_matrix().to_4x4(),
    "scaled 0.01": Matrix.Scale(0.01, 4),
    "scaled 2.5": Matrix.Scale(2.5, 4),
    "all three": Matrix.LocRotScale((-1.0, 4.0, 0.2), Euler((0.02, -0.03, -1.2)), (1.3, 1.3, 1.3)),
}


class RoundTrip(unittest.TestCase):
    def round_trip(self, rig: bpy.types.Object, seed: int, frames: int = FRAMES,
                   bone_map: str | None = None) -> Samples:
        """Poses the rig at random, retargets what its joints did, and asserts that the Action does the same."""
        skeleton = read_rig(rig, bone_map)
        joints = random_motion(rig, skeleton, seed, frames)
        write_rig_action(rig, skeleton, retarget(skeleton, joints), "round trip", FIRST)
        samples = sample(rig, skeleton, range(FIRST, FIRST + frames))
        # the tolerance is for a person's size; a rig of another size rounds in its own
        size = max(1.0, skeleton.height / 1.8)
        off = np.linalg.norm(samples.joints - joints, axis=2)[:, EXACT_JOINTS]
        self.assertLess(off.max(), JOINT_TOLERANCE * size, f"joint {np.unravel_index(off.argmax(), off.shape)}")
        self.assertLess(np.abs(samples.stretch).max(), STRETCH_TOLERANCE)
        return samples

    def test_every_world_transform(self) -> None:
        for rig_name, make in RIGS.items():
            for place, matrix in PLACES.items():
                with self.subTest(rig=rig_name, place=place):
                    rig = make()
                    rig.matrix_world = matrix
                    bpy.context.view_layer.update()
                    self.round_trip(rig, seed=1)

    def test_parented_rig(self) -> None:
        for rig_name, make in RIGS.items():
            with self.subTest(rig=rig_name):
                rig = make()
                parent = bpy.data.objects.new("Parent", None)
                bpy.context.collection.objects.link(parent)
                parent.matrix_world = Matrix.LocRotScale((1.0, 2.0, 0.0), Euler((0.0, 0.0, 0.8)), (0.5, 0.5, 0.5))
                rig.parent = parent
                rig.location.x = 1.5
                bpy.context.view_layer.update()
                self.round_trip(rig, seed=2)

    def test_rest_poses(self) -> None:
        for rig_name, make in RIGS.items():
            for degrees in (3.0, 45.0, 90.0):
                with self.subTest(rig=rig_name, degrees=degrees):
                    rig = make()
                    set_rest_arms(rig, degrees)
                    self.round_trip(rig, seed=3)

    def test_bone_rolls(self) -> None:
        for rig_name, make in RIGS.items():
            with self.subTest(rig=rig_name):
                rig = make()
                set_rolls(rig, np.random.default_rng(4).uniform(-math.pi, math.pi, 17))
                self.round_trip(rig, seed=4)

    def test_rotation_modes(self) -> None:
        for mode in (*EULER_ORDERS, "AXIS_ANGLE"):
            with self.subTest(mode=mode):
                rig = mannequin()
                for bone in rig.pose.bones:
                    bone.rotation_mode = mode
                self.round_trip(rig, seed=5)

    def test_many_motions(self) -> None:
        for rig_name, make in RIGS.items():
            rig = make()
            for seed in range(10, 16):
                with self.subTest(rig=rig_name, seed=seed):
                    rig.animation_data_clear()
                    self.round_trip(rig, seed)

    def test_pelvis_without_local_location_and_below_a_turned_root(self) -> None:
        for local in (True, False):
            with self.subTest(use_local_location=local):
                rig = mannequin()
                _add_root(rig)
                rig.data.bones["hips"].use_local_location = local
                self.round_trip(rig, seed=6)

    def test_any_names_through_a_bone_map_file(self) -> None:
        """Other names, no toes, one bone for spine and chest (the real chest is then an unmapped bone between)."""
        rig = mannequin()
        preset = read_rig(rig).bone_map
        for number, bone in enumerate(rig.data.bones):
            bone.name = f'Knochen "{number}"'
        segments = dict(zip(preset.segments, (rig.data.bones[_mannequin_order().index(bone)].name
                                              for bone in preset.segments.values())))
        segments["chest"] = segments["spine"]
        del segments["toe.L"], segments["toe.R"]
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "mine.json")
            with open(path, "w", encoding="utf-8") as file:
                json.dump({"segments": segments}, file)
            self.round_trip(rig, seed=9, bone_map=path)

    def test_bones_do_not_jump(self) -> None:
        for rig_name, make in RIGS.items():
            with self.subTest(rig=rig_name):
                rig = make()
                samples = self.round_trip(rig, seed=7, frames=4 * FRAMES)  # the swings take four seconds
                self.assertLess(fastest_joint(samples, read_rig(rig), 24.0), 15.0)

    def test_forearm_shares_its_twist_with_the_hand(self) -> None:
        for rig_name, make in RIGS.items():
            for degrees in (10.0, 90.0):
                with self.subTest(rig=rig_name, degrees=degrees):
                    rig = make()
                    set_rest_arms(rig, degrees)
                    samples, skeleton = self.round_trip(rig, seed=8), read_rig(rig)
                    for side, _ in SIDES:
                        for twist in forearm_twists(samples, skeleton, side):
                            self.assertLess(np.degrees(np.abs(twist)).max(), 90.0)


class NativeRigs(unittest.TestCase):
    def test_keyed_bones_turns_and_heads_are_those_of_the_skeleton(self) -> None:
        for rig_name, make in RIGS.items():
            with self.subTest(rig=rig_name):
                rig = make()
                skeleton = read_rig(rig)
                joints = random_motion(rig, skeleton, seed=3, frames=5)
                pose = retarget(skeleton, joints)
                self.assertEqual(pose.keyed, skeleton.keyed)
                self.assertEqual(pose.turns.shape, (len(skeleton.keyed), 5, 3, 3))
                self.assertEqual(pose.heads.shape, (len(skeleton.keyed), 5, 3))
                np.testing.assert_allclose(pose.joints()[:, EXACT_JOINTS], joints[:, EXACT_JOINTS], atol=1e-6)
                again = retarget(skeleton, pose.joints())
                np.testing.assert_allclose(again.joints()[:, EXACT_JOINTS], pose.joints()[:, EXACT_JOINTS], atol=1e-9)

    def test_joints_and_bones_that_do_not_fit_are_refused(self) -> None:
        skeleton = read_rig(mannequin())
        joints = np.repeat(skeleton.joints[None], 3, axis=0)
        pose = retarget(skeleton, joints)
        for wrong, words in ((joints[:, :26], r"joints has shape \(3, 26, 3\)"), (joints[:0], "joints has 0 frames"),
                             (np.where(np.arange(3)[:, None, None] == 1, np.nan, joints), r"joints\[1, 0, 0\] is nan")):
            with self.assertRaisesRegex(ValueError, words):
                retarget(skeleton, wrong)
        with self.assertRaisesRegex(ValueError, "bone -1 is not one of the keyed"):
            pose.rotation_values(-1, "XYZ")
        with self.assertRaisesRegex(ValueError, "mode is 'XYX'"):
            pose.rotation_values(pose.keyed[0], "XYX")


class StraightLimbs(unittest.TestCase):
    def test_limbs_that_straighten_and_bend_again_keep_their_hinge(self) -> None:
        """A squat that passes through straight knees and arms: flexion never changes sign, nothing spins."""
        for rig_name, make in RIGS.items():
            with self.subTest(rig=rig_name):
                rig = make()
                skeleton = read_rig(rig)
                joints = _squat(rig, 40)
                write_rig_action(rig, skeleton, retarget(skeleton, joints), "squat", 1)
                samples = sample(rig, skeleton, range(1, 41))
                off = np.abs(samples.joints - joints)[:, EXACT_JOINTS]
                self.assertLess(off.max(), JOINT_TOLERANCE)
                self.assertLess(fastest_joint(samples, skeleton, 24.0), 15.0)
                for side, _ in SIDES:
                    self.assertGreaterEqual(knee_flexion(samples, skeleton, side).min(), 0.0)
                    self.assertGreaterEqual(elbow_flexion(samples, side).min(), 0.0)

    def test_a_planted_foot_does_not_follow_the_knee(self) -> None:
        """The knee is carried round the leg, to behind it and back; foot and toe stay as they stood."""
        for rig_name, make in RIGS.items():
            with self.subTest(rig=rig_name):
                skeleton = read_rig(make())
                joints = np.repeat(skeleton.joints[None], 48, axis=0)
                hip, knee, ankle = (INDEX[f"left_{name}"] for name in ("hip", "knee", "ankle"))
                axis = joints[0, ankle] - joints[0, hip]
                round_it = np.stack([turn_about(axis, 3.0 * math.sin(t)) for t in np.linspace(0.0, math.pi, 48)])
                joints[:, knee] = joints[:, hip] + turn(round_it, joints[:, knee] - joints[:, hip])
                pose = retarget(skeleton, joints)
                for segment in ("foot.L", "toe.L"):
                    turns = pose.turns[pose.keyed.index(skeleton.segments[segment])]
                    self.assertLess(np.abs(turns - np.eye(3)).max(), 1e-9, segment)

    def test_rest_joints_give_the_rest_pose(self) -> None:
        for rig_name, make in RIGS.items():
            with self.subTest(rig=rig_name):
                skeleton = read_rig(make())
                pose = retarget(skeleton, np.repeat(skeleton.joints[None], 3, axis=0))
                for bone, turns in zip(pose.keyed, pose.turns):
                    segment = {bone: segment for segment, bone in skeleton.segments.items()}.get(bone, "")
                    if segment.startswith(("forearm", "hand")):
                        continue  # the palms turn to face each other
                    self.assertLess(np.abs(turns - np.eye(3)).max(), REST_TOLERANCE, skeleton.bones.names[bone])
                off = pose.joints()[0] - skeleton.joints
                self.assertLess(np.abs(off[EXACT_JOINTS, :]).max(), 1e-9)


def _mannequin_order() -> list[str]:
    """The bones of a fresh mannequin, in the armature's order."""
    rig = mannequin()
    names = [bone.name for bone in rig.data.bones]
    bpy.data.objects.remove(rig)
    return names


def _add_root(rig: bpy.types.Object) -> None:
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    root = rig.data.edit_bones.new("root")
    root.head, root.tail = (0.1, 0.3, 0.0), (0.3, 0.7, 0.2)
    rig.data.edit_bones["hips"].parent = root
    bpy.ops.object.mode_set(mode="OBJECT")


def _squat(rig: bpy.types.Object, frames: int) -> np.ndarray:
    """Joint centres of knees and elbows that go from bent to quite straight and back, posed in the joint space."""
    skeleton = read_rig(rig)
    joints = np.repeat(skeleton.joints[None], frames, axis=0)
    body = skeleton.to_body(joints)
    bend = np.radians(70.0) * np.maximum(0.0, np.cos(np.linspace(0.0, 2.0 * math.pi, frames)))
    turned = np.stack([turn_about((1, 0, 0), angle) for angle in bend])
    for _, word in SIDES:
        chain = [body[0, INDEX[f"{word}_{name}"]] for name in ("shoulder", "elbow", "wrist", "grip")]
        upper, lower, hand = (np.linalg.norm(b - a) for a, b in zip(chain, chain[1:]))
        down = np.array([0.0, 0.0, -1.0])
        elbow = chain[0] + upper * down
        wrist = elbow + lower * turned @ down
        body[:, INDEX[f"{word}_elbow"]], body[:, INDEX[f"{word}_wrist"]] = elbow, wrist
        body[:, INDEX[f"{word}_grip"]] = wrist + hand * turned @ down
        hip, knee, ankle, ball = (body[0, INDEX[f"{word}_{name}"]].copy() for name in
                                  ("hip", "knee", "ankle", "ball"))
        thigh, shin = np.linalg.norm(knee - hip), np.linalg.norm(ankle - knee)
        ahead = np.stack([turn_about((1, 0, 0), 0.5 * angle) for angle in bend]) @ down
        behind = np.stack([turn_about((1, 0, 0), -0.5 * angle) for angle in bend]) @ down
        body[:, INDEX[f"{word}_knee"]] = hip + thigh * ahead
        body[:, INDEX[f"{word}_ankle"]] = hip + thigh * ahead + shin * behind
        body[:, INDEX[f"{word}_ball"]] = body[:, INDEX[f"{word}_ankle"]] + ball - ankle
    return skeleton.to_world(body)
