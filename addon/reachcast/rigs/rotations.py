# SPDX-License-Identifier: GPL-3.0-or-later
"""Rotations as stacks of 3x3 matrices that act on columns: v_turned = R @ v. Quaternions are w, x, y, z.

Every function works on any leading shape; vectors are (..., 3), matrices (..., 3, 3), quaternions (..., 4).
"""
from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_TINY = 1e-12


def cross(a: Array, b: Array) -> Array:
    """a x b for stacks that broadcast; several times faster than numpy's own for the few rows of a motion."""
    ax, ay, az = a[..., 0], a[..., 1], a[..., 2]
    bx, by, bz = b[..., 0], b[..., 1], b[..., 2]
    x = ay * bz - az * by
    out = np.empty(x.shape + (3,))
    out[..., 0], out[..., 1], out[..., 2] = x, az * bx - ax * bz, ax * by - ay * bx
    return out


def normalise(vectors: Array) -> Array:
    """Unit vectors; a vector of (almost) no length stays as it is."""
    length = np.sqrt(np.einsum("...i,...i->...", vectors, vectors))[..., None]
    return vectors / np.where(length < _TINY, 1.0, length)


def turn(rotation: Array, vectors: Array) -> Array:
    """R @ v for stacks."""
    return np.einsum("...ij,...j->...i", rotation, vectors)


def orthonormal(matrices: Array) -> Array:
    """The nearest rotations to matrices within 1e-4 of one, to rounding: two of Newton's steps to the polar factor."""
    for _ in range(2):
        matrices = 1.5 * matrices - 0.5 * (matrices @ transpose(matrices) @ matrices)
    return matrices


def transpose(rotation: Array) -> Array:
    return np.swapaxes(rotation, -1, -2)


def dot(a: Array, b: Array) -> Array:
    return np.einsum("...i,...i->...", a, b)


def reject(vectors: Array, axis: Array) -> Array:
    """The part of each vector across the unit `axis`."""
    return vectors - axis * dot(vectors, axis)[..., None]


def twist_angle(rotation: Array, axis: Array) -> Array:
    """The part (...,) of each turn about the unit `axis` (swing and twist), in (-pi, pi]."""
    quaternion = to_quaternion(rotation)
    angle = 2.0 * np.arctan2(dot(quaternion[..., 1:], axis), quaternion[..., 0])
    return np.angle(np.exp(1j * angle))


def to_quaternion(rotation: Array) -> Array:
    """Unit quaternions with w >= 0, each from the largest of its four squares (no cancellation)."""
    r = rotation
    xx, yy, zz = r[..., 0, 0], r[..., 1, 1], r[..., 2, 2]
    xy, yz, zx = r[..., 0, 1] + r[..., 1, 0], r[..., 1, 2] + r[..., 2, 1], r[..., 2, 0] + r[..., 0, 2]
    wx, wy, wz = r[..., 2, 1] - r[..., 1, 2], r[..., 0, 2] - r[..., 2, 0], r[..., 1, 0] - r[..., 0, 1]
    products = np.stack([
        np.stack([1 + xx + yy + zz, wx, wy, wz], -1), np.stack([wx, 1 + xx - yy - zz, xy, zx], -1),
        np.stack([wy, xy, 1 - xx + yy - zz, yz], -1), np.stack([wz, zx, yz, 1 - xx - yy + zz], -1)], -2)
    largest = np.argmax(np.diagonal(products, axis1=-2, axis2=-1), axis=-1)
    quaternion = normalise(np.take_along_axis(products, largest[..., None, None], axis=-2)[..., 0, :])
    return quaternion * np.where(quaternion[..., :1] < 0.0, -1.0, 1.0)


def from_quaternion(quaternion: Array) -> Array:
    """Rotation matrices of quaternions, which are normalised first."""
    q = normalise(np.asarray(quaternion, float))
    skew = _cross_matrix(q[..., 1:])
    return np.eye(3) + 2.0 * q[..., :1, None] * skew + 2.0 * (skew @ skew)


def _cross_matrix(v: Array) -> Array:
    out = np.zeros(v.shape + (3,))
    out[..., 2, 1], out[..., 0, 2], out[..., 1, 0] = v[..., 0], v[..., 1], v[..., 2]
    out[..., 1, 2], out[..., 2, 0], out[..., 0, 1] = -v[..., 0], -v[..., 1], -v[..., 2]
    return out
