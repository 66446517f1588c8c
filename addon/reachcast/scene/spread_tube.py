# SPDX-License-Identifier: GPL-3.0-or-later
"""How far paths spread, as a tube about their mean: across it, an ellipse of two standard deviations."""
from __future__ import annotations

from collections.abc import Sequence

import bpy
import numpy as np

from ..rigs.rotations import Array, cross, normalise

DEVIATIONS = 2.0
_LEAST_RADIUS_M = 0.002
_AROUND = 20
_COLOUR = (0.1, 0.45, 0.9, 0.35)


def add_tube(name: str, paths: Sequence[Array], collection: bpy.types.Collection) -> bpy.types.Object:
    """A mesh in the world; paths: (motions, times, 3) for each tube, at least two motions."""
    corners, faces = [], []
    for path in paths:
        rings = tube_rings(path)
        faces += _faces(len(rings), sum(len(ring) for ring in corners))
        corners.append(rings.reshape(-1, 3))
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(np.concatenate(corners).tolist(), [], faces)
    mesh.shade_smooth() if hasattr(mesh, "shade_smooth") else mesh.polygons.foreach_set("use_smooth", [True] * len(faces))
    mesh.materials.append(_material())
    item = bpy.data.objects.new(name, mesh)
    item.color, item.show_transparent = _COLOUR, True
    collection.objects.link(item)
    return item


def tube_rings(paths: Array) -> Array:
    """(times, around, 3): paths (motions, times, 3) at equal relative times."""
    mean = paths.mean(axis=0)
    along = normalise(np.gradient(mean, axis=0))
    aside = _carried(along)
    other = cross(along, aside)
    away = paths - mean
    plane = np.stack([np.sum(away * aside, axis=2), np.sum(away * other, axis=2)], axis=2)
    covariance = np.einsum("mti,mtj->tij", plane, plane) / max(1, len(paths) - 1)
    variance, axes = np.linalg.eigh(covariance)
    radii = np.maximum(DEVIATIONS * np.sqrt(np.maximum(variance, 0.0)), _LEAST_RADIUS_M)
    # The root of the covariance keeps the points of neighbouring rings together where the ellipses turn.
    root = np.einsum("tik,tk,tjk->tij", axes, radii, axes)
    angles = 2.0 * np.pi * np.arange(_AROUND) / _AROUND
    circle = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    flat = np.einsum("tij,aj->tai", root, circle)
    return mean[:, None] + flat[:, :, :1] * aside[:, None] + flat[:, :, 1:] * other[:, None]


def _carried(along: Array) -> Array:
    """(times, 3) across `along`, turned from time to time no more than it must be."""
    start = np.eye(3)[np.argmin(np.abs(along[0]))]
    aside = []
    for direction in along:
        start = start - direction * (start @ direction)
        start = start / np.linalg.norm(start)
        aside.append(start)
    return np.array(aside)


def _faces(rings: int, first: int) -> list[list[int]]:
    faces = []
    for ring in range(rings - 1):
        here = first + ring * _AROUND
        for corner in range(_AROUND):
            after = (corner + 1) % _AROUND
            faces.append([here + corner, here + after, here + _AROUND + after, here + _AROUND + corner])
    last = first + (rings - 1) * _AROUND
    return faces + [list(range(first, first + _AROUND))[::-1], list(range(last, last + _AROUND))]


def _material() -> bpy.types.Material:
    material = bpy.data.materials.new("Spread")
    material.diffuse_color = _COLOUR
    material.use_nodes = True
    shader = material.node_tree.nodes.get("Principled BSDF")
    if shader is not None:
        shader.inputs["Base Color"].default_value = (*_COLOUR[:3], 1.0)
        shader.inputs["Alpha"].default_value = _COLOUR[3]
    if hasattr(material, "blend_method"):
        material.blend_method = "BLEND"
    return material
