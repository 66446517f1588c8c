# SPDX-License-Identifier: GPL-3.0-or-later
"""World transforms of objects as numpy arrays, refused in one sentence when they cannot be used."""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ..rigs.rotations import Array

#: How far an object's axes may be from one common length, or from right angles, as a part of that length.
MAX_UNEVEN = 1e-4


@dataclass(frozen=True)
class Placement:
    """World = origin + rotation @ (scale * local)."""

    origin: Array     #: (3,) metres
    rotation: Array   #: (3, 3) proper
    scale: Array      #: (3,) > 0

    def to_world(self, points: Array) -> Array:
        return self.origin + (np.asarray(points, float) * self.scale) @ self.rotation.T


def placement(item: bpy.types.Object) -> Placement:
    """Where an object is in the world; ValueError for NaN, zero, mirrored or sheared transforms."""
    matrix = np.array(item.matrix_world, dtype=float)
    if not np.all(np.isfinite(matrix)):
        raise ValueError(f"Object '{item.name}' has a transform that is not a number")
    axes = matrix[:3, :3]
    scale = np.linalg.norm(axes, axis=0)
    if np.any(scale < 1e-9):
        raise ValueError(f"Object '{item.name}' has a scale of {_listed(item.scale)}; every part must be above zero")
    if np.linalg.det(axes) < 0.0 or any(part < 0.0 for part in item.scale):
        raise ValueError(f"Object '{item.name}' is mirrored by a negative scale of {_listed(item.scale)}; "
                         f"every part must be above zero")
    rotation = axes / scale
    if np.max(np.abs(rotation.T @ rotation - np.eye(3))) > MAX_UNEVEN:
        raise ValueError(f"Object '{item.name}' is sheared by its parent's scale; give the parent an even scale")
    left, _, right = np.linalg.svd(rotation)
    return Placement(matrix[:3, 3], left @ right, scale)


def even_placement(item: bpy.types.Object) -> Placement:
    """Like `placement`; also refuses a scale that differs between the axes."""
    place = placement(item)
    if np.ptp(place.scale) > MAX_UNEVEN * np.max(place.scale):
        raise ValueError(f"Object '{item.name}' is scaled unevenly, by {_listed(place.scale)}; "
                         f"the three must be equal: apply its scale (Ctrl A)")
    return place


def evaluate_transforms() -> None:
    """Brings every `matrix_world` up to date with what a script has just set."""
    bpy.context.view_layer.update()


def _listed(values: object) -> str:
    return " x ".join(f"{value:g}" for value in values)  # type: ignore[attr-defined]
