# SPDX-License-Identifier: GPL-3.0-or-later
"""Rotation maths and key values against mathutils, which is another implementation."""
from __future__ import annotations

import math
import unittest
from collections.abc import Sequence

import numpy as np
from mathutils import Euler, Matrix, Quaternion
from reachcast import native
from reachcast.rigs import rotations
from rig_cases import EULER_ORDERS, turn_about

MODES = ("QUATERNION", "AXIS_ANGLE", *EULER_ORDERS)


def meant(values: Sequence[float], mode: str) -> Matrix:
    """What Blender makes of key values."""
    if mode == "QUATERNION":
        return Quaternion(values).to_matrix()
    if mode == "AXIS_ANGLE":
        return Quaternion(values[1:], values[0]).to_matrix()
    return Euler(values, mode).to_matrix()


class Rotations(unittest.TestCase):
    def setUp(self) -> None:
        random = np.random.default_rng(0)
        self.rotation_values = native.core().rotation_values
        self.quaternions = rotations.normalise(random.normal(size=(200, 4)))
        self.matrices = rotations.from_quaternion(self.quaternions)

    def test_matrices(self) -> None:
        for quaternion, matrix in zip(self.quaternions, self.matrices):
            np.testing.assert_allclose(matrix, Quaternion(quaternion).to_matrix(), atol=1e-6)
        same = rotations.to_quaternion(self.matrices)
        np.testing.assert_allclose(np.abs(np.sum(same * self.quaternions, axis=1)), 1.0, atol=1e-12)

    def test_orthonormal_is_the_nearest_rotation(self) -> None:
        near = self.matrices + np.random.default_rng(1).uniform(-3e-5, 3e-5, self.matrices.shape)
        left, _, right = np.linalg.svd(near)
        np.testing.assert_allclose(rotations.orthonormal(near), left @ right, atol=1e-14)

    def test_values_stand_for_the_rotations_in_every_mode(self) -> None:
        matrices = np.concatenate([[np.eye(3)], self.matrices, [np.diag([1, -1, -1]), np.diag([-1, 1, -1])]])
        for mode in MODES:
            values = self.rotation_values(matrices, mode)
            self.assertEqual(values.shape, (len(matrices), 4 if mode in MODES[:2] else 3))
            for matrix, row in zip(matrices, values):
                np.testing.assert_allclose(meant(row, mode), matrix, atol=1e-5, err_msg=mode)

    def test_euler_angles_through_the_gimbal(self) -> None:
        for order in EULER_ORDERS:
            middle = "XYZ".index(order[1])
            path = []
            for step in range(60):
                angles = [0.4, 0.4, 0.4]
                angles[middle] = math.radians(60.0 + step)  # passes exactly 90 degrees
                path.append(np.array(Euler(angles, order).to_matrix(), dtype=float))
            values = self.rotation_values(np.stack(path), order)
            for matrix, angles in zip(path, values):
                np.testing.assert_allclose(Euler(angles, order).to_matrix(), matrix, atol=1e-5)
            self.assertLess(np.abs(np.diff(values, axis=0)).max(), 0.2)

    def test_values_do_not_jump(self) -> None:
        spin = np.stack([turn_about((0.0, 0.6, 0.8), angle) for angle in np.linspace(0.0, 4.0 * math.pi, 120)])
        for mode, most in (("QUATERNION", 0.06), ("AXIS_ANGLE", 0.12), ("XYZ", 0.5), ("ZYX", 0.5)):
            values = self.rotation_values(spin, mode)
            self.assertLess(np.abs(np.diff(values, axis=0)).max(), most, mode)

    def test_wrong_arguments_are_named(self) -> None:
        for matrices, mode, words in ((np.eye(3), "XYZ", r"rotations has shape \(3, 3\)"),
                                      (np.full((1, 3, 3), np.nan), "XYZ", r"rotations\[0, 0, 0\] is nan"),
                                      (self.matrices, "XYX", "mode is 'XYX'; it must be one of QUATERNION")):
            with self.assertRaisesRegex(ValueError, words):
                self.rotation_values(matrices, mode)
