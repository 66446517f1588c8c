# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of the scene as PNG files, by EEVEE, Workbench or Cycles."""
from __future__ import annotations

import errno
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import bpy

from .blender_versions import ENGINES, set_eevee, set_file_format

#: Of light, per pixel. Without a graphics card every one costs about a second of processor time at 960 x 720.
SAMPLES = {"EEVEE": 5, "WORKBENCH": 5, "CYCLES": 16}
#: What Blender would write into the files; without it the same picture is the same bytes.
_STAMPS = tuple(f"use_stamp_{what}" for what in (
    "camera", "date", "filename", "frame", "frame_range", "hostname", "lens", "marker", "memory", "note",
    "render_time", "scene", "sequencer_strip", "time"))
_KEPT = (*_STAMPS, "engine", "resolution_x", "resolution_y", "resolution_percentage", "filepath", "use_file_extension",
         "use_overwrite", "use_placeholder", "fps", "fps_base")


@dataclass(frozen=True)
class Look:
    """How the pictures of a studio are made."""

    engine: str                 #: EEVEE, WORKBENCH or CYCLES
    samples: int | None = None  #: None: as SAMPLES


def set_pictures(scene: bpy.types.Scene, engine: str, size: tuple[int, int]) -> None:
    """PNG of `size` pixels by EEVEE, WORKBENCH or CYCLES. Nothing else of the scene is changed, but that Cycles does
    not denoise."""
    render = scene.render
    render.engine = ENGINES[engine]
    render.resolution_x, render.resolution_y = size
    render.resolution_percentage = 100
    set_file_format(render.image_settings, "PNG")
    render.image_settings.compression = 15
    leave_no_stamp(scene)
    if engine == "CYCLES":
        scene.cycles.use_denoising = False


def leave_no_stamp(scene: bpy.types.Scene) -> None:
    for name in _STAMPS:
        setattr(scene.render, name, False)


def set_look(scene: bpy.types.Scene, look: Look) -> None:
    """For a scene without settings of its own."""
    samples = look.samples or SAMPLES[look.engine]
    if look.engine == "EEVEE":
        set_eevee(scene, samples)
    elif look.engine == "CYCLES":
        scene.cycles.samples = samples
    else:
        shading = scene.display.shading
        shading.light, shading.color_type = "STUDIO", "MATERIAL"
        shading.show_shadows, shading.show_cavity = True, True
    lit = look.engine != "WORKBENCH"
    scene.view_settings.view_transform = "Filmic" if lit else "Standard"
    scene.view_settings.look = "Medium High Contrast" if lit else "None"
    scene.view_settings.exposure = 0.0 if lit else 1.0


@contextmanager
def kept_render(scene: bpy.types.Scene) -> Iterator[None]:
    """Camera, frames and the main settings of rendering are put back."""
    render, frames = scene.render, (scene.frame_start, scene.frame_end, scene.frame_step, scene.frame_current)
    kept, camera = {name: getattr(render, name) for name in _KEPT}, scene.camera
    form, compression = render.image_settings.file_format, render.image_settings.compression
    view = scene.view_settings.view_transform, scene.view_settings.look, scene.view_settings.exposure
    try:
        yield
    finally:
        for name, value in kept.items():
            setattr(render, name, value)
        set_file_format(render.image_settings, form)
        render.image_settings.compression = compression
        scene.camera = camera
        scene.view_settings.view_transform, scene.view_settings.look, scene.view_settings.exposure = view
        scene.frame_start, scene.frame_end, scene.frame_step = frames[:3]
        scene.frame_set(frames[3])


def render_frames(folder: Path, frames: Sequence[int], scene: bpy.types.Scene | None = None,
                  suffix: str = "png") -> dict[int, Path]:
    """`folder`/0001.png and so on, one picture for each of the rising `frames`. OSError when one is not there.

    suffix: of the scene's file format.
    """
    scene = scene or bpy.context.scene
    scene.render.filepath = os.fspath(folder) + os.sep
    scene.render.use_file_extension = scene.render.use_overwrite = True
    scene.render.use_placeholder = False
    for run in _runs(frames):
        scene.frame_start, scene.frame_end, scene.frame_step = run.start, run[-1], run.step
        bpy.ops.render.render(animation=True, scene=scene.name)
    pictures = {frame: folder / f"{frame:04d}.{suffix}" for frame in frames}
    for picture in pictures.values():
        if not picture.is_file() or not picture.stat().st_size:
            raise OSError(errno.EIO, f"Blender did not write the picture '{picture.name}'")
    return pictures


def _runs(frames: Sequence[int]) -> list[range]:
    """The frames as few evenly spaced runs: Blender renders each of them in one go."""
    runs: list[range] = []
    for frame in frames:
        last = runs[-1] if runs else None
        if last is not None and len(last) == 1:
            runs[-1] = range(last.start, frame + 1, frame - last.start)
        elif last is not None and frame == last[-1] + last.step:
            runs[-1] = range(last.start, frame + 1, last.step)
        else:
            runs.append(range(frame, frame + 1))
    return runs


@contextmanager
def quiet(log: Path | str = os.devnull) -> Iterator[None]:
    """What Blender prints meanwhile goes to a file."""
    sys.stdout.flush()
    kept = [os.dup(stream) for stream in (1, 2)]
    with open(log, "ab") as file:
        for stream in (1, 2):
            os.dup2(file.fileno(), stream)
    try:
        yield
    finally:
        sys.stdout.flush()  # an operator's report is still in Python's buffer
        for stream, copy in zip((1, 2), kept):
            os.dup2(copy, stream)
            os.close(copy)
