# SPDX-License-Identifier: GPL-3.0-or-later
"""World transforms of objects as numpy arrays, refused in one sentence when they cannot be used."""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix

from ..rigs.rotations import Array, orthonormal
from .movers import is_carrier, movers, moves_object

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


def layer_of(scene: bpy.types.Scene) -> bpy.types.ViewLayer:
    """The view layer in which the objects of `scene` are read: the user's own in the user's scene, else the first."""
    return bpy.context.view_layer if scene == bpy.context.scene else scene.view_layers[0]


def refuse_removed(item: object, what: str) -> None:
    """ValueError for an object that has been deleted; any use of it would raise ReferenceError."""
    if isinstance(item, bpy.types.Object):
        try:
            item.name  # noqa: B018
        except ReferenceError:
            raise ValueError(f"The {what} has been removed from the file; choose another") from None


def world_matrix(item: bpy.types.Object, layer: bpy.types.ViewLayer | None = None) -> Array:
    """(4, 4): where `item` is in the world as `layer` (the user's own by default) evaluates it, brought up to date.

    What is hidden in all viewports or lies in an excluded collection is not evaluated: it is placed by its own
    transform and its parents'; ValueError when something else moves it.
    """
    layer = layer or bpy.context.view_layer
    layer.update()
    return np.array(_world(item, layer.depsgraph), dtype=float)


def _world(item: bpy.types.Object, graph: bpy.types.Depsgraph) -> Matrix:
    shown = item.evaluated_get(graph)
    if shown.is_evaluated:
        return shown.matrix_world
    if mover := next(movers(item, moves_object), None):
        raise ValueError(f"Object '{item.name}' follows {mover.what}, but not while it is hidden; show it")
    if item.parent is None:
        return item.matrix_basis
    return _world(item.parent, graph) @ item.matrix_parent_inverse @ item.matrix_basis


def above_matrix(item: bpy.types.Object, layer: bpy.types.ViewLayer | None = None) -> Array:
    """(4, 4): world = above @ the object's own location, rotation and scale, which `placement` has not refused;
    hands that carry the object now are left out."""
    layer = layer or bpy.context.view_layer
    world = world_matrix(item, layer)
    shown = item.evaluated_get(layer.depsgraph)
    if not shown.is_evaluated:
        return world @ np.linalg.inv(np.array(item.matrix_basis, dtype=float))
    for constraint in reversed(shown.constraints):
        if is_carrier(constraint) and not constraint.mute and constraint.influence > 0.0:
            if constraint.influence < 1.0:
                raise ValueError(f"Object '{item.name}' is carried by '{constraint.name}' with an influence of "
                                 f"{constraint.influence:g}; it must be 0 or 1")
            world = np.linalg.inv(np.array(constraint.target.matrix_world, dtype=float)) @ world
    return world @ np.linalg.inv(np.array(shown.matrix_basis, dtype=float))


def placement(item: bpy.types.Object, layer: bpy.types.ViewLayer | None = None) -> Placement:
    """Where an object is in the world; ValueError for NaN, zero, mirrored or sheared transforms."""
    matrix = world_matrix(item, layer)
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
    return Placement(matrix[:3, 3], orthonormal(rotation), scale)


def even_placement(item: bpy.types.Object, layer: bpy.types.ViewLayer | None = None) -> Placement:
    """Like `placement`; also refuses a scale that differs between the axes."""
    place = placement(item, layer)
    if np.ptp(place.scale) > MAX_UNEVEN * np.max(place.scale):
        raise ValueError(f"Object '{item.name}' is scaled unevenly, by {_listed(place.scale)}; "
                         f"the three must be equal: apply its scale (Ctrl A)")
    return place


def described(item: object) -> str:
    """What an argument is that should have been an object of another kind."""
    if item is None:
        return "nothing"
    return f"{item.type.lower()} '{item.name}'" if isinstance(item, bpy.types.Object) else repr(item)


def _listed(values: object) -> str:
    return " x ".join(f"{value:g}" for value in values)  # type: ignore[attr-defined]
