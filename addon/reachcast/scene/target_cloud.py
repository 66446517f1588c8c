# SPDX-License-Identifier: GPL-3.0-or-later
"""Points drawn in the 3D view where a corpus has targets. Nothing is added to the scene."""
from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from mathutils import Matrix

from ..rigs.rotations import Array

_COLOUR = (1.0, 0.55, 0.1, 0.9)
_SIZE_PX = 5.0
_handle: Any = None
_points: Array = np.zeros((0, 3))
_rig = ""             #: name of the object that the points go with, if any
_batch: Any = None    #: of the points, once they have been drawn


def set_points(points: Array, rig: bpy.types.Object | None = None) -> None:
    """(N, 3) world. What is drawn while the points are shown; they go along when `rig` is moved or turned."""
    global _points, _rig, _batch
    points = np.asarray(points, dtype=float)
    if rig is not None:
        back = np.array(_stand(rig).inverted())
        points = points @ back[:3, :3].T + back[:3, 3]
    _points, _rig, _batch = points.astype(np.float32), rig.name if rig else "", None


def shown_points() -> Array:
    """(N, 3) world: where the points are now."""
    place = np.array(_place())
    return _points @ place[:3, :3].T + place[:3, 3]


def _stand(rig: bpy.types.Object) -> Matrix:
    """Where an object is, without its scale: the points are metres."""
    place, turn, _ = rig.matrix_world.decompose()
    return Matrix.LocRotScale(place, turn, None)


def _place() -> Matrix:
    rig = bpy.data.objects.get(_rig) if _rig else None
    return _stand(rig) if rig else Matrix()


def is_shown() -> bool:
    return _handle is not None


def show(wanted: bool, context: bpy.types.Context | None = None) -> None:
    """Begins or ends the drawing. Without windows there is nothing to draw in."""
    global _handle
    if wanted and _handle is None and not bpy.app.background:
        _handle = bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_VIEW")
    elif not wanted and _handle is not None:
        bpy.types.SpaceView3D.draw_handler_remove(_handle, "WINDOW")
        _handle = None
    for area in context.screen.areas if context and context.screen else ():
        if area.type == "VIEW_3D":
            area.tag_redraw()


def _draw() -> None:
    global _batch
    import gpu
    from gpu_extras.batch import batch_for_shader

    if not len(_points):
        return
    # Blender 4.0 named the built-in shaders anew.
    shader = gpu.shader.from_builtin("UNIFORM_COLOR" if bpy.app.version >= (4, 0) else "3D_UNIFORM_COLOR")
    if _batch is None:
        _batch = batch_for_shader(shader, "POINTS", {"pos": _points.tolist()})
    gpu.state.point_size_set(_SIZE_PX)
    gpu.state.blend_set("ALPHA")
    with gpu.matrix.push_pop():
        gpu.matrix.multiply_matrix(_place())
        shader.bind()
        shader.uniform_float("color", _COLOUR)
        _batch.draw(shader)
    gpu.state.blend_set("NONE")
    gpu.state.point_size_set(1.0)
