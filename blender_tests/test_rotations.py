# SPDX-License-Identifier: GPL-3.0-or-later
"""Rotation maths and key values against mathutils, which is another implementation."""
from __future__ import annotations

import math
import unittest

import numpy as np
from mathutils import Euler, Quaternion
from reachcast.rigs import channels, rotations


class Rotations(unittest.TestCase):
    def setUp(self) -> None:
        random = np.random.default_rng(0)
        self.quaternions = rotations.normalise(random.normal(size=(200, 4)))
        self.matrices = rotations.from_quaternion(self.quaternions)

    def test_matrices(self) -> None:
        for quaternion, matrix in zip(self.quaternions, self.matrices):
            np.testing.assert_allclose(matrix, Quaternion(quaternion).to_matrix(), atol=1e-6)
        same = rotations.to_quaternion(self.matrices)
        np.testing.assert_allclose(np.abs(np.sum(same * self.quaternions, axis=1)), 1.0, atol=1e-12)

    def test_euler_orders(self) -> None:
        for order in channels.EULER_ORDERS:
            for matrix, angles in zip(self.matrices, channels.euler_angles(self.matrices, order)):
                np.testing.assert_allclose(Euler(angles, order).to_matrix(), matrix, atol=1e-5)

    def test_euler_angles_through_the_gimbal(self) -> None:
        for order in channels.EULER_ORDERS:
            middle = "XYZ".index(order[1])
            path = []
            for step in range(60):
                angles = [0.4, 0.4, 0.4]
                angles[middle] = math.radians(60.0 + step)  # passes exactly 90 degrees
                path.append(np.array(Euler(angles, order).to_matrix(), dtype=float))
            values = channels.euler_angles(np.stack(path), order)
            for matrix, angles in zip(path, values):
                np.testing.assert_allclose(Euler(angles, order).to_matrix(), matrix, atol=1e-5)
            self.assertLess(np.abs(np.diff(values, axis=0)).max(), 0.2)

    def test_values_do_not_jump(self) -> None:
        angle = np.linspace(0.0, 4.0 * math.pi, 120)
        spin = rotations.axis_rotation(np.broadcast_to([0.0, 0.6, 0.8], (120, 3)), angle)
        for mode, most in (("QUATERNION", 0.06), ("AXIS_ANGLE", 0.12), ("XYZ", 0.5), ("ZYX", 0.5)):
            values = channels.rotation_values(spin, mode)
            self.assertLess(np.abs(np.diff(values, axis=0)).max(), most, mode)

    def test_aim_is_a_rotation_even_backwards(self) -> None:
        start = rotations.normalise(np.random.default_rng(1).normal(size=(50, 3)))
        for end in (start[::-1].copy(), -start, start):
            turned = rotations.aim(start, end)
            np.testing.assert_allclose(rotations.turn(turned, start), end, atol=1e-9)
            np.testing.assert_allclose(np.linalg.det(turned), 1.0, atol=1e-9)
