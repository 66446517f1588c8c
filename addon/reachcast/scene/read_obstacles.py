# SPDX-License-Identifier: GPL-3.0-or-later
"""Mesh objects as triangles that nothing may pass through, in a rig's body frame."""
from __future__ import annotations

from collections.abc import Iterable

import bpy
import numpy as np

from ..rigs.rotations import Array
from ..rigs.skeleton import Skeleton
from .transforms import described, refuse_removed

MOST_TRIANGLES = 1_000_000


def read_obstacles(skeleton: Skeleton, items: Iterable[bpy.types.Object], layer: bpy.types.ViewLayer) -> Array | None:
    """(triangles, 3, 3) corners of the evaluated meshes, body frame; None when there are none."""
    graph = None
    found: list[Array] = []
    for item in items:
        refuse_removed(item, "obstacle")
        if not isinstance(item, bpy.types.Object) or item.type != "MESH":
            raise ValueError(f"An obstacle must be a mesh object, not {described(item)}")
        if graph is None:
            layer.update()
            graph = layer.depsgraph
        found.append(_triangles(item.evaluated_get(graph)))
    if not found:
        return None
    triangles = np.concatenate(found)
    if len(triangles) > MOST_TRIANGLES:
        raise ValueError(f"The obstacles have {len(triangles)} triangles; at most {MOST_TRIANGLES} can be looked at")
    return skeleton.to_body(triangles)


def _triangles(item: bpy.types.Object) -> Array:
    """(triangles, 3, 3) in the world."""
    mesh = item.to_mesh()
    try:
        mesh.calc_loop_triangles()
        corners = np.empty(3 * len(mesh.vertices))
        mesh.vertices.foreach_get("co", corners)
        indices = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
        mesh.loop_triangles.foreach_get("vertices", indices)
    finally:
        item.to_mesh_clear()
    matrix = np.array(item.matrix_world)
    world = corners.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]
    if not np.all(np.isfinite(world)):
        raise ValueError(f"Obstacle '{item.name}' has a corner that is not finite")
    return world[indices].reshape(-1, 3, 3)
