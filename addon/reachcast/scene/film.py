# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures become a film or a contact sheet, by Blender's own sequencer, in a scene that is removed again."""
from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np

from .blender_versions import add_caption, add_effect, set_file_format, strips_of
from .render import leave_no_stamp

COLUMNS = 3
PANEL_WIDTH = 480             #: pixels, at most
GAP, CAPTION = 6, 34          #: pixels between the panels and beneath them
MOST_CAPTIONS = 100           #: at once: a sequencer has 128 channels
PAPER, INK = (0.95, 0.957, 0.965), (0.125, 0.157, 0.188, 1.0)


@dataclass(frozen=True)
class Moment:
    """A picture of the contact sheet."""

    frame: int
    label: str


@dataclass(frozen=True)
class Caption:
    """Text on a picture; x, y: pixels from its lower left corner to that of the text."""

    text: str
    x: float
    y: float
    size: int                                     #: pixels
    colour: tuple[float, float, float, float]


def write_film(pictures: Sequence[Path], size: tuple[int, int], rate: float, path: Path, rest: float = 0.0) -> None:
    """H.264 of the pictures, which lie in one folder, `rate` a second; it stays on the last one for `rest` seconds."""
    with _sequence(size) as scene:
        strip = strips_of(scene).new_image("Film", os.fspath(pictures[0]), 1, 1, fit_method="ORIGINAL")
        for picture in [*pictures[1:], *pictures[-1:] * round(rest * rate)]:
            strip.elements.append(picture.name)
        scene.frame_end = len(strip.elements)
        render = scene.render
        render.fps = max(1, round(rate))
        render.fps_base = render.fps / rate
        set_file_format(render.image_settings, "FFMPEG")
        coding = render.ffmpeg
        coding.format, coding.codec, coding.audio_codec = "MPEG4", "H264", "NONE"
        coding.constant_rate_factor, coding.ffmpeg_preset, coding.gopsize = "HIGH", "REALTIME", 12
        render.filepath = os.fspath(path)
        bpy.ops.render.render(animation=True, scene=scene.name)


def write_contact_sheet(moments: Sequence[Moment], pictures: dict[int, Path], size: tuple[int, int],
                        path: Path, most_columns: int = COLUMNS) -> None:
    """Pictures in rows, of `size` or smaller; under each what it shows."""
    scale = min(1.0, PANEL_WIDTH / size[0])
    panel = round(size[0] * scale), round(size[1] * scale)
    cell = panel[0] + 2 * GAP, panel[1] + 2 * GAP + CAPTION
    columns = min(most_columns, len(moments))
    # A cell a frame: a sequencer that lays every picture over the whole sheet takes three times as long.
    with _sequence(cell) as scene, tempfile.TemporaryDirectory(dir=path.parent) as folder:
        add_effect(scene, "COLOR", 1, len(moments)).color = PAPER
        for number, moment in enumerate(moments):
            _add_panel(scene, pictures[moment.frame], 2, scale, (0.0, 0.5 * CAPTION), number + 1)
            _add_text(scene, Caption(moment.label, GAP + 4, GAP + 0.25 * CAPTION, min(16, max(6, panel[0] // 18)), INK),
                      cell, 3, number + 1)
        scene.render.image_settings.compression = 0  # they are read again at once
        cells = _write_stills(scene, Path(folder) / "cell", len(moments))
        _join(cells, cell, columns, path)


def write_captioned(picture: Path, size: tuple[int, int], captions: Sequence[Caption], path: Path) -> None:
    """The picture, of `size`, with text on it."""
    for begin in range(0, len(captions), MOST_CAPTIONS):
        with _sequence(size) as scene:
            _add_panel(scene, path if begin else picture, 1, 1.0, (0.0, 0.0))
            for number, caption in enumerate(captions[begin:begin + MOST_CAPTIONS]):
                _add_text(scene, caption, size, number + 2)
            _write_stills(scene, path, 1)[0].replace(path)


def _add_text(scene: bpy.types.Scene, caption: Caption, size: tuple[int, int], channel: int, frame: int = 1) -> None:
    strip = add_caption(scene, caption.text, channel, 1)
    strip.frame_start = frame
    strip.font_size, strip.color = caption.size, caption.colour
    strip.location = caption.x / size[0], caption.y / size[1]
    strip.blend_type = "ALPHA_OVER"


def _write_stills(scene: bpy.types.Scene, path: Path, count: int) -> list[Path]:
    """Of the frames from 1 on, named after `path`."""
    scene.frame_end = count
    scene.render.filepath = os.fspath(path.with_suffix("")) + "-"
    bpy.ops.render.render(animation=True, scene=scene.name)  # a still is of the window's scene's frame
    return [path.with_name(f"{path.stem}-{frame:04d}.png") for frame in range(1, count + 1)]


def _join(cells: Sequence[Path], size: tuple[int, int], columns: int, path: Path) -> None:
    """Pictures of one size in rows as one, on paper."""
    (width, height), rows = size, -(-len(cells) // columns)
    sheet = np.ones((rows * height, columns * width, 4), np.float32)   # the lowest row first, as in an image's pixels
    sheet[..., :3] = PAPER
    for number, cell in enumerate(cells):
        left, top = number % columns * width, (rows - number // columns) * height
        sheet[top - height:top, left:left + width] = _pixels(cell).reshape(height, width, 4)
    image = bpy.data.images.new(path.stem, columns * width, rows * height)
    try:
        image.pixels.foreach_set(sheet.ravel())
        image.filepath_raw, image.file_format = os.fspath(path), "PNG"
        image.save()
    finally:
        bpy.data.images.remove(image)


def _pixels(picture: Path) -> np.ndarray:
    image = bpy.data.images.load(os.fspath(picture))
    try:
        values = np.empty(len(image.pixels), np.float32)
        image.pixels.foreach_get(values)
        return values
    finally:
        bpy.data.images.remove(image)


def _add_panel(scene: bpy.types.Scene, picture: Path, channel: int, scale: float, middle: tuple[float, float],
               frame: int = 1) -> None:
    """middle: pixels from the middle of the sequencer's picture."""
    strip = strips_of(scene).new_image(picture.name, os.fspath(picture), channel, frame, fit_method="ORIGINAL")
    strip.blend_type = "ALPHA_OVER"
    strip.transform.scale_x = strip.transform.scale_y = scale
    strip.transform.offset_x, strip.transform.offset_y = middle


@contextmanager
def _sequence(size: tuple[int, int]) -> Iterator[bpy.types.Scene]:
    """A scene for the sequencer alone, which shows pictures as they are."""
    scene, fonts = bpy.data.scenes.new("Film"), set(bpy.data.fonts.keys())
    try:
        scene.view_settings.view_transform, scene.view_settings.look = "Standard", "None"
        render = scene.render
        render.resolution_x, render.resolution_y = size
        render.resolution_percentage = 100
        set_file_format(render.image_settings, "PNG")
        render.image_settings.color_mode = "RGB"
        leave_no_stamp(scene)
        scene.frame_start = 1
        yield scene
    finally:
        bpy.data.scenes.remove(scene)
        bpy.data.batch_remove([font for font in bpy.data.fonts if font.name not in fonts])
