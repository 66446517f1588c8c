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


def transpose(rotation: Array) -> Array:
    return np.swapaxes(rotation, -1, -2)


def dot(a: Array, b: Array) -> Array:
    return np.einsum("...i,...i->...", a, b)


def reject(vectors: Array, axis: Array) -> Array:
    """The part of each vector across the unit `axis`."""
    return vectors - axis * dot(vectors, axis)[..., None]


def any_across(axis: Array) -> Array:
    """Some unit vector across each unit `axis`, the same for the same axis."""
    least = np.eye(3)[np.argmin(np.abs(axis), axis=-1)]
    return normalise(cross(axis, least))


def frame(primary: Array, secondary: Array) -> Array:
    """Right-handed frames with columns: along `primary` exactly, towards `secondary`, and their cross product."""
    first = normalise(primary)
    across = reject(np.broadcast_to(secondary, first.shape), first)
    lost = dot(across, across) < 1e-18
    if np.any(lost):
        across = np.where(lost[..., None], any_across(first), across)
    second = normalise(across)
    out = np.empty(first.shape + (3,))
    out[..., 0], out[..., 1], out[..., 2] = first, second, cross(first, second)
    return out


def axis_rotation(axis: Array, angle: Array) -> Array:
    """Turns by `angle` (...,) radians about the unit `axis` (..., 3)."""
    axis, angle = np.asarray(axis, float), np.asarray(angle, float)
    skew = _cross_matrix(axis)
    sine, versine = np.sin(angle)[..., None, None], (1.0 - np.cos(angle))[..., None, None]
    return np.eye(3) + sine * skew + versine * (skew @ skew)


def aim(start: Array, end: Array) -> Array:
    """The smallest turns that bring unit vectors `start` onto `end`; half a turn about some axis when they oppose."""
    start, end = np.broadcast_arrays(start, end)
    cosine = dot(start, end)
    skew = _cross_matrix(cross(start, end))
    opposed = cosine < -1.0 + 1e-12
    scale = 1.0 / np.where(opposed, 1.0, 1.0 + cosine)
    turned = np.eye(3) + skew + scale[..., None, None] * (skew @ skew)
    if not np.any(opposed):
        return turned
    half_turn = axis_rotation(any_across(start), np.full(cosine.shape, np.pi))
    return np.where(opposed[..., None, None], half_turn, turned)


def signed_angle(start: Array, end: Array, axis: Array) -> Array:
    """Angle (...,) in (-pi, pi] from `start` to `end` seen along the unit `axis` they are across."""
    return np.arctan2(dot(axis, cross(start, end)), dot(start, end))


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
