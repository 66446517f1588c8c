# SPDX-License-Identifier: GPL-3.0-or-later
"""A camera that sees all of a motion, and what it is to see. World axes, metres."""
from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ..rigs.rotations import Array

LENS_MM = 50.0
SIDE_DEG, UP_DEG = 62.0, 14.0   #: from straight ahead of the worker; above the horizon
MARGIN_M = 0.13                 #: around what the camera is to see


def add_camera(name: str = "Camera") -> bpy.types.Object:
    """In the scene; it looks nowhere yet."""
    data = bpy.data.cameras.new(name)
    data.lens = LENS_MM
    camera = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(camera)
    return camera


def direction(ahead: Vector, toward_left: bool, side_deg: float = SIDE_DEG) -> Vector:
    """From the worker, who faces `ahead` (level), to a camera ahead of it, to its left or to its right; unit length."""
    side, up = math.radians(side_deg) * (1.0 if toward_left else -1.0), math.radians(UP_DEG)
    level = Matrix.Rotation(side, 3, "Z") @ ahead.normalized()
    return Vector((level.x * math.cos(up), level.y * math.cos(up), math.sin(up)))


def frame_points(camera: bpy.types.Object, points: Array, away: Vector, margin: float = MARGIN_M) -> None:
    """Puts the camera in the direction `away`, at the distance from which it sees all `points` (N, 3) and `margin`
    around them, in pictures of the scene's size."""
    camera.rotation_euler = (-away).to_track_quat("-Z", "Y").to_euler()
    bpy.context.view_layer.update()
    room = margin * np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    spread = (points[:, None, :] + room).reshape(-1, 3)
    camera.location, _ = camera.camera_fit_coords(bpy.context.evaluated_depsgraph_get(), spread.ravel().tolist())


def bounds_over(objects: Sequence[bpy.types.Object], frames: Iterable[int]) -> Array:
    """(N, 3): the corners of every object's bounds in every frame."""
    scene, corners = bpy.context.scene, []
    kept = scene.frame_current
    for frame in frames:
        scene.frame_set(frame)
        graph = bpy.context.evaluated_depsgraph_get()
        for item in objects:
            shown = item.evaluated_get(graph)
            corners += [tuple(shown.matrix_world @ Vector(corner)) for corner in shown.bound_box]
    scene.frame_set(kept)
    return np.unique(np.round(corners, 3), axis=0)
