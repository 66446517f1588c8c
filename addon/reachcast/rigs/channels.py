# SPDX-License-Identifier: GPL-3.0-or-later
"""Rotations over time as the numbers a bone is keyed with: continuous quaternions, Euler angles or axis and angle."""
from __future__ import annotations

import math

import numpy as np

from .rotations import Array, to_quaternion

EULER_ORDERS = ("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX")
_GIMBAL = 1e-9  # cosine of the middle angle below which only the sum of the other two is defined


def rotation_values(rotation: Array, mode: str) -> Array:
    """Values (F, 3 or 4) of rotations (F, 3, 3) in a Blender rotation mode, without jumps from frame to frame."""
    if mode == "QUATERNION":
        return continuous_quaternions(to_quaternion(rotation))
    if mode == "AXIS_ANGLE":
        return axis_angles(rotation)
    return euler_angles(rotation, mode)


def continuous_quaternions(quaternion: Array) -> Array:
    """The same rotations (F, 4), each with the sign nearest to the one before."""
    agree = np.sum(quaternion[1:] * quaternion[:-1], axis=1) >= 0.0
    signs = np.concatenate([[1.0], np.cumprod(np.where(agree, 1.0, -1.0))])
    return quaternion * signs[:, None]


def axis_angles(rotation: Array) -> Array:
    """(F, 4): angle in radians, then the unit axis; the axis never flips and the angle never jumps by a turn."""
    quaternions = continuous_quaternions(to_quaternion(rotation))
    sines = np.linalg.norm(quaternions[:, 1:], axis=1)
    turned = np.flatnonzero(sines > 1e-9)
    axis = quaternions[turned[0], 1:] / sines[turned[0]] if len(turned) else np.array([0.0, 1.0, 0.0])
    angle, values = 0.0, np.empty((len(rotation), 4))
    for index, (quaternion, sine) in enumerate(zip(quaternions, sines)):
        sign = 1.0
        if sine > 1e-9:
            direction = quaternion[1:] / sine
            sign = 1.0 if direction @ axis >= 0.0 else -1.0
            axis = sign * direction
        angle = _near(2.0 * math.atan2(sign * sine, quaternion[0]), angle)
        values[index] = angle, *axis
    return values


def euler_angles(rotation: Array, order: str) -> Array:
    """Angles (F, 3) about x, y, z in radians for Blender's `order` ("XYZ" turns about x first).

    Of the two triples that give a rotation, the one nearest to the frame before is taken.
    """
    i, j, k = ("XYZ".index(axis) for axis in order)
    parity = 1.0 if (j - i) % 3 == 1 else -1.0
    values = np.empty((len(rotation), 3))
    before = (0.0, 0.0, 0.0)
    for index, r in enumerate(rotation):
        cosine = math.hypot(r[i, i], r[j, i])
        middle = math.atan2(-parity * r[k, i], cosine)
        if cosine > _GIMBAL:
            first, last = math.atan2(parity * r[k, j], r[k, k]), math.atan2(parity * r[j, i], r[i, i])
            choices = ((first, middle, last), (first + math.pi, math.pi - middle, last + math.pi))
        else:
            choices = ((before[0], middle, _last_at_gimbal(r, before[0], i, j, k, parity)),)
        near = [tuple(map(_near, choice, before)) for choice in choices]
        before = min(near, key=lambda choice: sum(abs(a - b) for a, b in zip(choice, before)))
        values[index, [i, j, k]] = before
    return values


def _last_at_gimbal(r: Array, first: float, i: int, j: int, k: int, parity: float) -> float:
    """The last angle when the first is given: r turned back by the first leaves R_k R_j, whose j column is R_k e_j."""
    sine, cosine = math.sin(first), math.cos(first)
    column = cosine * r[:, j] - parity * sine * r[:, k]
    return math.atan2(-parity * column[i], column[j])


def _near(angle: float, target: float) -> float:
    """`angle` plus the whole turns that bring it within half a turn of `target`."""
    return angle + math.tau * round((target - angle) / math.tau)
