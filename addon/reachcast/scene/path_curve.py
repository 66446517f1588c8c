# SPDX-License-Identifier: GPL-3.0-or-later
"""The path of the hands as a Bezier curve object: two points whose inner handles are the inner control points.

Control points are (4, 3), world metres: where the middle between the hands begins, the two inner ones, where it ends.
"""
from __future__ import annotations

import bpy
import numpy as np

from ..rigs.rotations import Array

_THICKNESS_M = 0.006
_COLOUR = (1.0, 0.45, 0.05, 1.0)
#: Custom property of a curve that is the path of the hands of a rig, whose name is its value.
_PATH_OF = "reachcast_path_of"


def add_path_curve(name: str, control: Array, collection: bpy.types.Collection, rig: str) -> bpy.types.Object:
    data = bpy.data.curves.new(name, "CURVE")
    data.dimensions = "3D"
    data.resolution_u = 32
    data.bevel_depth = _THICKNESS_M
    data.bevel_resolution = 1
    spline = data.splines.new("BEZIER")
    spline.bezier_points.add(1)
    for point in spline.bezier_points:
        point.handle_left_type = point.handle_right_type = "FREE"
    item = bpy.data.objects.new(name, data)
    item[_PATH_OF] = rig
    item.color = _COLOUR
    item.show_in_front = True
    item.hide_render = True
    collection.objects.link(item)
    write_control(item, control)
    return item


def remove_path_curves(rig: str) -> None:
    """Takes away the curves of this rig's paths, also those that a file was saved with."""
    data = [item.data for item in bpy.data.objects if item.get(_PATH_OF) == rig and item.library is None]
    bpy.data.batch_remove([item for item in bpy.data.objects if item.data in data])
    bpy.data.batch_remove([curve for curve in data if curve.users == 0])


def read_control(item: bpy.types.Object) -> Array:
    """(4, 3), also while the curve is being edited. ValueError when it is no longer such a curve."""
    splines = item.data.splines
    if len(splines) != 1 or splines[0].type != "BEZIER" or len(splines[0].bezier_points) != 2:
        raise ValueError(f"The hand path '{item.name}' must stay one Bezier curve between two points; undo the change "
                         f"or edit the path anew")
    first, last = splines[0].bezier_points
    local = np.array([first.co, first.handle_right, last.handle_left, last.co], dtype=float)
    matrix = np.array(item.matrix_world, dtype=float)
    return local @ matrix[:3, :3].T + matrix[:3, 3]


def write_control(item: bpy.types.Object, control: Array) -> None:
    """Outer handles continue the curve straight on; they have no influence on it."""
    matrix = np.linalg.inv(np.array(item.matrix_world, dtype=float))
    start, after, before, end = np.asarray(control, float) @ matrix[:3, :3].T + matrix[:3, 3]
    first, last = item.data.splines[0].bezier_points
    first.co, first.handle_right, first.handle_left = start, after, start - 0.25 * (after - start)
    last.co, last.handle_left, last.handle_right = end, before, end - 0.25 * (before - end)
