# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments at the lower back against figures worked out by hand."""
from __future__ import annotations

import math
import unittest

import numpy as np
from reachcast import native
from reachcast.back_load import GRAVITY, PARTS, back_moment, trunk_inclination
from reachcast.rigs.joints import INDEX, JOINTS


def figure(**places: tuple[float, float, float]) -> np.ndarray:
    """(1, 27, 3): all joints at L5/S1 but those given."""
    joints = np.tile(places.pop("l5s1", (0.0, 0.0, 1.0)), (1, len(JOINTS), 1)).astype(float)
    for name, place in places.items():
        joints[0, INDEX[name]] = place
    return joints


class BackLoad(unittest.TestCase):
    def test_a_level_trunk_is_abdomen_thorax_and_head_on_their_levers(self) -> None:
        joints = figure(c7t1=(0.0, 0.5, 1.0), tragion=(0.0, 0.7, 1.0))
        by_hand = 80.0 * 9.81 * (0.139 * 0.125 + 0.216 * 0.35 + 0.081 * (0.5 + 0.9 * 0.2))
        np.testing.assert_allclose(back_moment(joints, 80.0), [by_hand], rtol=1e-12)
        np.testing.assert_allclose(trunk_inclination(joints), [math.pi / 2])

    def test_a_load_counts_by_its_level_distance_while_it_is_carried(self) -> None:
        joints = np.repeat(figure(), 2, axis=0)
        centres = np.array([[0.3, 0.4, 2.0], [math.nan] * 3])
        np.testing.assert_allclose(back_moment(joints, 80.0, 10.0, centres), [10.0 * GRAVITY * 0.5, 0.0])

    def test_both_sides_balance(self) -> None:
        joints = figure(left_elbow=(-0.3, 0, 1), left_wrist=(-0.5, 0, 1), right_elbow=(0.3, 0, 1), right_wrist=(0.5, 0, 1))
        np.testing.assert_allclose(back_moment(joints, 80.0), [0.0], atol=1e-12)

    def test_the_moment_does_not_depend_on_where_and_which_way_one_stands(self) -> None:
        joints = np.asarray(native.core().Body.from_stature(1.75).posture)[None] + np.random.default_rng(5).normal(
            scale=0.1, size=(4, len(JOINTS), 3))
        turned = joints @ np.array([[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0], [0.0, 0.0, 1.0]]) + [3.0, -2.0, 0.5]
        np.testing.assert_allclose(back_moment(turned, 70.0), back_moment(joints, 70.0))

    def test_trunk_head_and_arms_are_54_percent_of_the_mass(self) -> None:
        self.assertAlmostEqual(sum(share for *_, share in PARTS), 0.536, places=9)


if __name__ == "__main__":
    unittest.main()
