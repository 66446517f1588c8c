# SPDX-License-Identifier: GPL-3.0-or-later
"""The measures of elbows and knees by themselves: a joint that bends the wrong way must come out below zero."""
from __future__ import annotations

import functools
import os
import unittest

import corpora
import numpy as np
from lift_cases import Place, lift_scene, rig_of
from reachcast.rigs.joints import INDEX, JOINTS, SIDES
from reachcast.rigs.retarget import retarget
from reachcast.rigs.rotations import normalise, reject
from reachcast.rigs.skeleton import Skeleton
from reachcast.scene.measure import LEAST_BEND_DEG, Samples, elbow_flexion, knee_flexion, sample
from reachcast.scene.read_rig import read_rig

RIGHT, AHEAD, UP = np.eye(3)
#: Where a right arm points, where its elbow may lie from there, and where it never lies.
RIGHT_ARMS = {
    "hanging": (-UP, (-AHEAD, RIGHT), (AHEAD, -RIGHT)),
    "reaching ahead": (AHEAD, (-UP, RIGHT), (UP, -RIGHT)),
    "raised": (UP, (AHEAD, RIGHT), (-AHEAD, -RIGHT)),
    "ahead and to its side": (AHEAD + RIGHT, (-UP,), (UP,)),
    "across the chest": (AHEAD - RIGHT, (-UP,), (UP,)),
}
LIFTS = ((0.1, 0), (0.7, 60), (1.0, 0), (1.3, -60), (1.6, 0))  #: heights and bearings of shelves


def of_joints(joints: np.ndarray) -> Samples:
    return Samples(tuple(range(len(joints))), joints, {}, np.zeros((len(joints), 1)), None, None)


def mirrored_through(joints: np.ndarray, word: str, names: tuple[str, str, str]) -> np.ndarray:
    """The middle joint on the other side of the line between its neighbours, the limb's lengths kept."""
    first, middle, last = (joints[:, INDEX[f"{word}_{name}"]] for name in names)
    off = reject(middle - first, normalise(last - first))
    changed = joints.copy()
    changed[:, INDEX[f"{word}_{names[1]}"]] = middle - 2.0 * off
    return changed


def posture(side: str, arm: np.ndarray, elbow: np.ndarray) -> Samples:
    """One frame in which an arm of two equal links points along `arm`, its elbow off the line towards `elbow`."""
    sign = np.array([1.0 if side == "R" else -1.0, 1.0, 1.0])
    joints, word = np.zeros((1, len(JOINTS), 3)), dict(SIDES)[side]
    for other, x in (("left", -0.2), ("right", 0.2)):
        joints[0, INDEX[f"{other}_shoulder"]] = (x, 0.0, 1.4)
    shoulder = joints[0, INDEX[f"{word}_shoulder"]]
    joints[0, INDEX[f"{word}_elbow"]] = shoulder + sign * (0.25 * normalise(arm) + 0.1 * elbow)
    joints[0, INDEX[f"{word}_wrist"]] = shoulder + sign * 0.5 * normalise(arm)
    return of_joints(joints)


@functools.cache
def lifts() -> tuple[tuple[Skeleton, np.ndarray], ...]:
    """Joints of some lifts by a mannequin, in the evaluated scene."""
    found = []
    scene = lift_scene(rig_of("mannequin", 1.72))
    for height, bearing in LIFTS:
        scene.arrange(Place(height, bearing, 0.45, facing=True), "floor")
        result = scene.predict(os.fspath(corpora.recorded_corpus()), start_frame=1)
        skeleton = read_rig(scene.rig)
        found.append((skeleton, sample(scene.rig, skeleton, range(1, result.frames["end"] + 1)).joints))
    return tuple(found)


class Elbows(unittest.TestCase):
    def test_sides_of_an_arm(self) -> None:
        for side, _ in SIDES:
            for name, (arm, natural, never) in RIGHT_ARMS.items():
                with self.subTest(side=side, arm=name):
                    for elbow in natural:
                        self.assertGreater(elbow_flexion(posture(side, arm, elbow), side)[0], LEAST_BEND_DEG)
                    for elbow in never:
                        self.assertLess(elbow_flexion(posture(side, arm, elbow), side)[0], -LEAST_BEND_DEG)

    def test_a_straight_arm_and_one_along_the_shoulders_have_no_side(self) -> None:
        self.assertEqual(elbow_flexion(posture("R", AHEAD, 0.01 * UP), "R")[0], 0.0)
        self.assertEqual(elbow_flexion(posture("L", RIGHT, UP), "L")[0], 0.0)

    def test_the_elbows_of_lifts_are_natural_and_their_mirror_images_are_not(self) -> None:
        for skeleton, joints in lifts():
            for side, word in SIDES:
                right_way = elbow_flexion(of_joints(joints), side)
                wrong = mirrored_through(joints, word, ("shoulder", "elbow", "wrist"))
                self.assertGreaterEqual(right_way.min(), 0.0)
                np.testing.assert_allclose(elbow_flexion(of_joints(wrong), side), -right_way, atol=1e-6)
                followed = retarget(skeleton, wrong).joints()  # the bones' own hinges follow
                self.assertLess(elbow_flexion(of_joints(followed), side).min(), -LEAST_BEND_DEG)


class Knees(unittest.TestCase):
    def test_the_knees_of_lifts_point_ahead_and_their_mirror_images_do_not(self) -> None:
        for skeleton, joints in lifts():
            for side, word in SIDES:
                right_way = knee_flexion(of_joints(joints), skeleton, side)
                wrong = mirrored_through(joints, word, ("hip", "knee", "ankle"))
                self.assertGreaterEqual(right_way.min(), 0.0)
                np.testing.assert_allclose(knee_flexion(of_joints(wrong), skeleton, side), -right_way, atol=1e-6)
