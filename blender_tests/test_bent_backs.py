# SPDX-License-Identifier: GPL-3.0-or-later
"""A back that bends: the bones between spine and chest share the bend, and the chest lands where the joints have it."""
from __future__ import annotations

import unittest
from dataclasses import replace

import bpy
import numpy as np
from published_rigs import PUBLISHED, build
from reachcast import native
from reachcast.rigs.joints import INDEX
from reachcast.rigs.retarget import EXACT_JOINTS, body_of, retarget
from reachcast.rigs.skeleton import Skeleton
from reachcast.scene.measure import sample
from reachcast.scene.read_rig import read_rig
from reachcast.scene.write_motion import write_rig_action
from rig_cases import RIGS, mannequin, random_motion, turn_about

PROMISED_M = 1e-3
FRAMES, FIRST = 12, 1
MOST_RAD = 1.2

_HANGING = [index for name, index in INDEX.items()
            if name not in ("l5s1", "left_hip", "right_hip", "left_knee", "right_knee", "left_ankle", "right_ankle",
                            "left_ball", "right_ball")]


def rigs() -> dict[str, bpy.types.Object]:
    return {**{name: make() for name, make in RIGS.items()}, **{name: build(name) for name in PUBLISHED}}


def with_bent_back(skeleton: Skeleton, joints: np.ndarray, bends: np.ndarray) -> np.ndarray:
    """(F, 27, 3): what is above c7t1 goes along as one piece. By walking along the bones of the back, which turn by
    equal parts of the bend per length; the chord keeps its direction."""
    core = native.core()
    bones = skeleton.bones
    rest = core.RestRig(bones.parents, bones.heads, bones.rotations, skeleton.segments, skeleton.joints, skeleton.axes)
    points = np.concatenate([skeleton.joint("l5s1")[None], rest.back_joints, skeleton.joint("c7t1")[None]])
    pieces = np.diff(points, axis=0)
    lengths = np.linalg.norm(pieces, axis=1)
    middles = (np.cumsum(lengths) - 0.5 * lengths) / lengths.sum() - 0.5
    chord = skeleton.joint("c7t1") - skeleton.joint("l5s1")
    along = chord / np.linalg.norm(chord)
    sideways = skeleton.axes[0] - along * (along @ skeleton.axes[0])
    axis = -sideways / np.linalg.norm(sideways)
    out = joints.copy()
    for frame, bend in enumerate(bends):
        turns = [turn_about(axis, bend * middle) for middle in middles]
        end = sum(turn @ piece for turn, piece in zip(turns, pieces))
        back = turn_about(axis, np.arctan2(axis @ np.cross(end, along), end @ along))
        chest = _chest(joints[frame]) @ _chest(skeleton.joints).T
        upper = chest @ back @ turns[-1] @ chest.T
        neck = joints[frame, INDEX["l5s1"]] + chest @ back @ end
        out[frame, _HANGING] = neck + (joints[frame, _HANGING] - joints[frame, INDEX["c7t1"]]) @ upper.T
    return out


def _chest(joints: np.ndarray) -> np.ndarray:
    waist, neck, clavicle = (joints[INDEX[name]] for name in ("l5s1", "c7t1", "right_clavicle"))
    along = (neck - waist) / np.linalg.norm(neck - waist)
    aside = clavicle - waist - along * (along @ (clavicle - waist))
    aside /= np.linalg.norm(aside)
    return np.stack([along, aside, np.cross(along, aside)], axis=1)


class BentBacks(unittest.TestCase):
    def test_every_rig_lands_its_chest_where_the_joints_have_it(self) -> None:
        bends = np.linspace(0.0, MOST_RAD, FRAMES)
        for name, rig in rigs().items():
            with self.subTest(rig=name):
                skeleton = read_rig(rig)
                joints = with_bent_back(skeleton, random_motion(rig, skeleton, 3, FRAMES), bends)
                write_rig_action(rig, skeleton, retarget(skeleton, joints, bends), "bent", FIRST)
                samples = sample(rig, skeleton, range(FIRST, FIRST + FRAMES))
                off = np.linalg.norm(samples.joints - joints, axis=2)[:, EXACT_JOINTS] / max(1.0, skeleton.height / 1.8)
                self.assertLess(off.max(), PROMISED_M, f"{np.unravel_index(off.argmax(), off.shape)}")

    def test_the_mannequins_bones_bend_evenly(self) -> None:
        rig = mannequin()
        skeleton = read_rig(rig)
        joints = with_bent_back(skeleton, np.repeat(skeleton.joints[None], 2, axis=0), np.array([0.0, 0.9]))
        write_rig_action(rig, skeleton, retarget(skeleton, joints, np.array([0.0, 0.9])), "bent", FIRST)
        bpy.context.scene.frame_set(FIRST + 1)
        bones = rig.evaluated_get(bpy.context.evaluated_depsgraph_get()).pose.bones
        lengths = {name: rig.data.bones[name].length for name in ("spine", "ribs", "chest")}
        for above, below in (("ribs", "spine"), ("chest", "ribs")):
            turned = bones[below].matrix.to_3x3().inverted() @ bones[above].matrix.to_3x3()
            rest = rig.data.bones[below].matrix_local.to_3x3().inverted() @ rig.data.bones[above].matrix_local.to_3x3()
            angle = (rest.inverted() @ turned).to_quaternion().angle
            share = 0.5 * (lengths[above] + lengths[below]) / sum(lengths.values())
            self.assertAlmostEqual(angle, 0.9 * share, places=4)

    def test_a_back_of_one_bone_has_nowhere_to_bend(self) -> None:
        rig = mannequin()
        known = read_rig(rig).bone_map
        skeleton = read_rig(rig, replace(known, segments={**known.segments, "chest": known.segments["spine"]}))
        joints = np.repeat(skeleton.joints[None], 2, axis=0)
        bent, straight = retarget(skeleton, joints, np.array([0.0, 0.9])), retarget(skeleton, joints)
        np.testing.assert_allclose(bent.turns, straight.turns, atol=1e-12)

    def test_points_of_another_shape_are_refused(self) -> None:
        with self.assertRaisesRegex(ValueError, "points"):
            body_of(read_rig(mannequin())).bending_at(np.zeros((2, 2)))


if __name__ == "__main__":
    unittest.main()
