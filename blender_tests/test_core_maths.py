# SPDX-License-Identifier: GPL-3.0-or-later
"""The maths of reachcast_core from Python: chains and curves give what the design promises, and refuse in words.

Runs in Blender with the other tests, and alone:  /usr/bin/python3 blender_tests/test_core_maths.py
"""
from __future__ import annotations

import math
import unittest
from typing import Any

import numpy as np
from core_cases import Refusing, rc, with_nan

CHAIN_M = 1e-9       #: of chains: the promise of the issue
CURVE_M = 1e-9       #: of least squares on points that lie on the curve
ARM = (0.31, 0.26, 0.10)
#: The 2007 paper's: right, forward, up, as parts of the distance.
PUBLISHED_OFFSETS = ((-0.025, -0.148, 0.077), (-0.015, -0.139, -0.002))


def random_chains(random: np.random.Generator, lengths: Any, frames: int) -> np.ndarray:
    """(F, n+1, 3) of chains whose links point anywhere."""
    links = random.normal(size=(frames, len(lengths), 3))
    links *= np.asarray(lengths)[:, None] / np.linalg.norm(links, axis=2, keepdims=True)
    joints = np.concatenate([np.zeros((frames, 1, 3)), np.cumsum(links, axis=1)], axis=1)
    return joints + random.normal(size=(frames, 1, 3))


class Chains(Refusing):
    def test_decode_inverts_encode(self) -> None:
        random = np.random.default_rng(1)
        for links in range(2, 9):
            lengths = random.uniform(0.05, 0.6, links)
            chain = rc.Chain(lengths, list(random.permutation(np.arange(1, links))))
            points = random_chains(random, lengths, 40)
            coordinates = chain.encode(points)
            self.assertEqual(coordinates.shape, (40, chain.coordinate_count))
            back = chain.decode(points[:, 0], points[:, -1], coordinates)
            np.testing.assert_allclose(back, points, atol=CHAIN_M)

    def test_a_single_link_has_no_coordinates(self) -> None:
        points = random_chains(np.random.default_rng(9), [0.3], 4)
        coordinates = rc.Chain([0.3], []).encode(points)
        self.assertEqual(coordinates.shape, (4, 0))
        back = rc.Chain([0.3], []).decode(points[:, 0], points[:, 1], coordinates)
        np.testing.assert_allclose(back, points, atol=CHAIN_M)

    def test_any_mean_of_coordinates_decodes_to_the_lengths(self) -> None:
        random = np.random.default_rng(2)
        chain = rc.Chain(ARM, [1, 2])
        coordinates = chain.encode(random_chains(random, ARM, 60))
        means = random.dirichlet(np.ones(60), 50) @ coordinates
        ends = np.array([0.4, 0.1, -0.1]) + random.uniform(-0.1, 0.1, (50, 3))
        points = chain.decode(np.zeros((50, 3)), ends, means)
        np.testing.assert_allclose(np.linalg.norm(np.diff(points, axis=1), axis=2), np.tile(ARM, (50, 1)), atol=CHAIN_M)
        np.testing.assert_allclose(points[:, -1], ends, atol=CHAIN_M)

    def test_reach_is_the_sum_and_what_the_longest_link_leaves(self) -> None:
        self.assertEqual(rc.Chain([0.43, 0.26], [1]).reach, (0.43 - 0.26, 0.43 + 0.26))
        self.assertEqual(rc.Chain([0.3, 0.3, 0.3], [1, 2]).reach[0], 0.0)
        self.assertEqual(rc.Chain([0.3], []).reach, (0.3, 0.3))

    def test_a_hinge_s_limit_raises_the_least_reach(self) -> None:
        upper, lower, most = 0.31, 0.26, math.radians(150)
        least = math.sqrt(upper ** 2 + lower ** 2 + 2 * upper * lower * math.cos(most))
        self.assertAlmostEqual(rc.Chain([upper, lower], [1], {1: (0.0, most)}).reach[0], least, places=12)

    def test_an_end_out_of_reach_is_refused(self) -> None:
        chain = rc.Chain(ARM, [1, 2])
        zero = np.zeros((1, chain.coordinate_count))
        self.refuses("0.67", call=lambda: chain.decode([[0, 0, 0]], [[0.9, 0, 0]], zero))

    def test_bad_arguments_are_named(self) -> None:
        chain = rc.Chain(ARM, [1, 2])
        points = random_chains(np.random.default_rng(3), ARM, 2)
        zero, numbers = np.zeros((2, 3)), chain.encode(points)
        self.refuses("lengths", call=lambda: rc.Chain([0.3, -0.2], [1]))
        self.refuses("lengths", call=lambda: rc.Chain([0.3, math.nan], [1]))
        self.refuses("lengths", call=lambda: rc.Chain([[0.3, 0.2]], [1]))
        self.refuses("lengths", call=lambda: rc.Chain([], []))
        self.refuses("pivot", call=lambda: rc.Chain([0.3, 0.2], [2]))
        self.refuses("limit", call=lambda: rc.Chain([0.3, 0.2], [1], {1: (2.0, 1.0)}))
        self.refuses("points", "(2, 3, 3)", call=lambda: chain.encode(points[:, :3]))
        self.refuses("points[1, 2, 0]", "nan", call=lambda: chain.encode(with_nan(points, (1, 2, 0))))
        self.refuses("points", "link 0", call=lambda: chain.encode(2.0 * points))
        self.refuses("start", call=lambda: chain.decode(zero[:1], zero, numbers))
        self.refuses("end", call=lambda: chain.decode(zero, with_nan(zero, (0, 1)), numbers))
        self.refuses("coordinates", call=lambda: chain.decode(zero, zero, numbers[:, 1:]))


class Curves(Refusing):
    def test_a_bezier_curve_is_fitted_back_from_its_points(self) -> None:
        control = np.random.default_rng(4).normal(size=(4, 3))
        times = np.linspace(0.0, 1.0, 25)
        points = rc.eval_bezier(control, times)
        np.testing.assert_allclose(points[[0, -1]], control[[0, -1]], atol=1e-15)
        np.testing.assert_allclose(rc.fit_bezier(points, times=times), control, atol=CURVE_M)

    def test_evaluation_is_bernstein_s(self) -> None:
        control, s = np.random.default_rng(5).normal(size=(4, 3)), np.linspace(0, 1, 11)[:, None]
        by_hand = ((1 - s) ** 3 * control[0] + 3 * s * (1 - s) ** 2 * control[1] + 3 * s ** 2 * (1 - s) * control[2]
                   + s ** 3 * control[3])
        np.testing.assert_allclose(rc.eval_bezier(control, s[:, 0]), by_hand, atol=1e-14)

    def test_the_published_model_bends_by_its_offsets(self) -> None:
        model, start, end = rc.HandPathModel.published(), np.array([0.1, 0.3, 0.9]), np.array([0.4, 0.7, 1.3])
        control, speed = model.predict(start, end)
        far = np.linalg.norm(end - start)
        for i, offset in enumerate(PUBLISHED_OFFSETS, start=1):
            np.testing.assert_allclose(control[i], start + i / 3 * (end - start) + far * np.array(offset), atol=1e-12)
        self.assertAlmostEqual(speed.alpha / (speed.alpha + speed.beta), 0.48, places=2)
        left, _ = model.predict(start * [-1, 1, 1], end * [-1, 1, 1], hand="left")
        np.testing.assert_allclose(left * [-1, 1, 1], control, atol=1e-12)

    def test_samples_follow_their_seed(self) -> None:
        random = np.random.default_rng(6)
        paths = [np.linspace([0, 0, 0], [0.2, 0.4, 0.3 + 0.01 * i], 20) + np.sin(np.linspace(0, np.pi, 20))[:, None]
                 * random.normal(0.0, 0.02, 3) for i in range(12)]
        model = rc.HandPathModel.fit(paths)
        one, same, other = (model.sample([0, 0, 0], [0.2, 0.4, 0.3], seed).control for seed in (7, 7, 8))
        np.testing.assert_array_equal(one, same)
        self.assertGreater(np.abs(one - other).max(), 1e-4)

    def test_bad_arguments_are_named(self) -> None:
        points = np.random.default_rng(7).normal(size=(9, 3))
        self.refuses("points", "(9, 2)", call=lambda: rc.fit_bezier(points[:, :2]))
        self.refuses("points[4, 1]", call=lambda: rc.fit_bezier(with_nan(points, (4, 1))))
        self.refuses("degree", call=lambda: rc.fit_bezier(points, degree=0))
        self.refuses("control", call=lambda: rc.eval_bezier(points[:, 0], [0.5]))
        self.refuses("s", call=lambda: rc.eval_bezier(points[:4], [0.5, math.nan]))
        model = rc.HandPathModel.published()
        self.refuses("start", call=lambda: model.predict([0, 0], [1, 1, 1]))
        self.refuses("end[2]", call=lambda: model.predict([0, 0, 0], [1, 1, math.inf]))
        self.refuses("hand", "both", call=lambda: model.predict([0, 0, 0], [1, 1, 1], hand="both"))
        self.refuses("paths[1]", call=lambda: rc.HandPathModel.fit([points, points[:, :1]]))


if __name__ == "__main__":
    unittest.main()
