# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of the examples, whose worker faces +y: the package's studio and camera, film and contact sheet by it."""
from __future__ import annotations

import subprocess
from collections.abc import Sequence
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector
from reachcast.scene import camera as cameras
from reachcast.scene.camera import bounds_over
from reachcast.scene.film import Moment, write_contact_sheet, write_film
from reachcast.scene.render import Look, quiet, render_frames, set_look, set_pictures
from reachcast.scene.studio import add_studio, place_studio

__all__ = ["Moment", "bounds_over", "ffmpeg", "furnish", "look_through_camera", "quiet", "render_and_say",
           "render_frames", "write_contact_sheet", "write_film"]

SIZE, QUICK_SIZE = (960, 720), (384, 288)
QUICK_STEP, QUICK_SAMPLES = 8, 4
FRAMES_A_LINE = 10
AHEAD = Vector((0.0, 1.0, 0.0))
FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"


def furnish(points: np.ndarray, toward_left: bool, *, quick: bool = False, size: tuple[int, int] | None = None,
            side_deg: float = cameras.SIDE_DEG) -> bpy.types.Object:
    """Studio, look and a camera that sees all `points` (N, 3), which is returned."""
    scene = bpy.context.scene
    place_studio(add_studio(scene), Vector(points.min(axis=0) + points.max(axis=0)) / 2.0, AHEAD, toward_left)
    set_pictures(scene, "EEVEE", size or (QUICK_SIZE if quick else SIZE))
    set_look(scene, Look("EEVEE", QUICK_SAMPLES if quick else None))
    scene.camera = cameras.add_camera()
    cameras.frame_points(scene.camera, points, cameras.direction(AHEAD, toward_left, side_deg))
    return scene.camera


def render_and_say(folder: Path, frames: Sequence[int]) -> dict[int, Path]:
    """`render_frames`, which says now and then how far it is."""
    pictures: dict[int, Path] = {}
    for start in range(0, len(frames), FRAMES_A_LINE):
        with quiet(folder / "blender.log"):
            pictures |= render_frames(folder, frames[start:start + FRAMES_A_LINE])
        print(f"Rendered {len(pictures)} of {len(frames)} frames", flush=True)
    return pictures


def look_through_camera() -> None:
    """Whoever opens the file sees the scene as it is rendered."""
    for area in bpy.data.screens["Layout"].areas:
        if area.type == "VIEW_3D":
            area.spaces.active.region_3d.view_perspective = "CAMERA"
            area.spaces.active.shading.type = "MATERIAL"
            area.spaces.active.show_region_ui = True


def ffmpeg(*arguments: str) -> None:
    done = subprocess.run(["ffmpeg", "-nostdin", "-v", "error", "-y", *arguments], capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"ffmpeg failed: {done.stderr.strip()}")
