# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments at the lower back against figures worked out by hand."""
from __future__ import annotations

import unittest

import numpy as np
from core_cases import Refusing, rc, with_nan
from reachcast.rigs.joints import INDEX, JOINTS

GRAVITY = 9.81


def figure(**places: tuple[float, float, float]) -> np.ndarray:
    """(1, 27, 3): all joints at L5/S1 but those given."""
    joints = np.tile(places.pop("l5s1", (0.0, 0.0, 1.0)), (1, len(JOINTS), 1)).astype(float)
    for name, place in places.items():
        joints[0, INDEX[name]] = place
    return joints


class BackLoad(Refusing):
    def test_a_level_trunk_is_abdomen_thorax_and_head_on_their_levers(self) -> None:
        joints = figure(c7t1=(0.0, 0.5, 1.0), tragion=(0.0, 0.7, 1.0))
        by_hand = 80.0 * 9.81 * (0.139 * 0.125 + 0.216 * 0.35 + 0.081 * (0.5 + 0.9 * 0.2))
        np.testing.assert_allclose(rc.back_moment(joints, 80.0), [by_hand], rtol=1e-12)

    def test_a_load_counts_by_its_level_distance_while_it_is_carried(self) -> None:
        joints, centre = figure(), np.array([[0.3, 0.4, 2.0]])
        np.testing.assert_allclose(rc.back_moment(joints, 80.0, 10.0, centre), [10.0 * GRAVITY * 0.5])
        np.testing.assert_allclose(rc.back_moment(joints, 80.0, 10.0), [0.0])

    def test_both_sides_balance(self) -> None:
        joints = figure(left_elbow=(-0.3, 0, 1), left_wrist=(-0.5, 0, 1), right_elbow=(0.3, 0, 1), right_wrist=(0.5, 0, 1))
        np.testing.assert_allclose(rc.back_moment(joints, 80.0), [0.0], atol=1e-12)

    def test_the_moment_does_not_depend_on_where_and_which_way_one_stands(self) -> None:
        joints = np.asarray(rc.Body.from_stature(1.75).posture)[None] + np.random.default_rng(5).normal(
            scale=0.1, size=(4, len(JOINTS), 3))
        turned = joints @ np.array([[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0], [0.0, 0.0, 1.0]]) + [3.0, -2.0, 0.5]
        np.testing.assert_allclose(rc.back_moment(turned, 70.0), rc.back_moment(joints, 70.0))

    def test_trunk_head_and_arms_are_54_percent_of_the_mass(self) -> None:
        joints = np.tile((1.0, 0.0, 1.0), (1, len(JOINTS), 1))
        joints[0, INDEX["l5s1"]] = (0.0, 0.0, 1.0)
        trunk = 0.25 * 0.139 + 0.70 * 0.216  # these two lie on the way to c7t1
        np.testing.assert_allclose(rc.back_moment(joints, 1.0), [GRAVITY * (0.536 - 0.139 - 0.216 + trunk)])

    def test_bad_input_is_named(self) -> None:
        joints = figure()
        self.refuses("joints[0, 3, 1]", "nan", call=lambda: rc.back_moment(with_nan(joints, (0, 3, 1)), 80.0))
        self.refuses("joints has shape", call=lambda: rc.back_moment(joints[0], 80.0))
        self.refuses("body_mass is 0", call=lambda: rc.back_moment(joints, 0.0))
        self.refuses("load is -1", call=lambda: rc.back_moment(joints, 80.0, -1.0))
        self.refuses("load_centres has 2 rows", call=lambda: rc.back_moment(joints, 80.0, 1.0, np.zeros((2, 3))))


if __name__ == "__main__":
    unittest.main()
