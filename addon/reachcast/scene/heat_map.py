# SPDX-License-Identifier: GPL-3.0-or-later
"""A table of numbers as a picture: one coloured cell each, what has no number in grey. Drawn by Blender's sequencer."""
from __future__ import annotations

import os
import tempfile
from collections.abc import Sequence
from pathlib import Path

import bpy
import numpy as np

from ..rigs.rotations import Array
from .film import INK, PAPER, Caption, write_captioned

CELL = (96, 52)                                    #: pixels
MARGIN = (90, 70, 20, 90)                          #: pixels left, above, right, below the cells
LEGEND_HEIGHT = 14
NOTHING = (0.78, 0.78, 0.78)
#: From little to much, readable without telling red from green; sRGB.
RAMP = ((0.99, 0.91, 0.60), (0.98, 0.69, 0.39), (0.87, 0.40, 0.35), (0.60, 0.20, 0.42), (0.27, 0.10, 0.35))


def colour_of(value: float, low: float, high: float) -> tuple[float, float, float]:
    """sRGB; grey for NaN."""
    if np.isnan(value):
        return NOTHING
    place = np.clip((value - low) / max(high - low, 1e-12), 0.0, 1.0) * (len(RAMP) - 1)
    return tuple(float(np.interp(place, range(len(RAMP)), part)) for part in zip(*RAMP))  # type: ignore[return-value]


def write_heat_map(values: Array, texts: Sequence[Sequence[str]], rows: Sequence[str], columns: Sequence[str], *,
                   title: str, across: str, unit: str, path: Path) -> None:
    """values: (R, C), NaN where there is none; first row on top. texts: what stands in each cell.

    rows, columns: their headings. across: what the columns are, written beneath them.
    """
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    left, above, right, below = MARGIN
    width = left + CELL[0] * values.shape[1] + right
    width, height = max(width + width % 2, 620), above + CELL[1] * values.shape[0] + below
    canvas = np.tile(np.array(PAPER), (height, width, 1))
    captions = [Caption(title, 16, height - 34, 18, INK)]
    for row, line in enumerate(values):
        top = above + CELL[1] * row
        middle = height - top - CELL[1] // 2 - 6
        captions.append(Caption(rows[row], 16, middle, 15, INK))
        for column, value in enumerate(line):
            begin, colour = left + CELL[0] * column, colour_of(value, low, high)
            canvas[top + 1:top + CELL[1] - 1, begin + 1:begin + CELL[0] - 1] = colour
            dark = np.dot(colour, (0.3, 0.59, 0.11)) < 0.5
            captions.append(Caption(texts[row][column], begin + 10, middle, 15, (1, 1, 1, 1) if dark else INK))
    under = height - above - CELL[1] * values.shape[0]
    captions += [Caption(text, left + CELL[0] * column + 10, under - 22, 15, INK) for column, text in enumerate(columns)]
    captions.append(Caption(across, left, under - 44, 15, INK))
    _add_legend(canvas, captions, low, high, unit)
    _write(canvas, captions, path)


def _add_legend(canvas: Array, captions: list[Caption], low: float, high: float, unit: str) -> None:
    left, width = MARGIN[0], 220
    for step in range(width):
        canvas[-14 - LEGEND_HEIGHT:-14, left + step] = colour_of(low + step / (width - 1) * (high - low), low, high)
    captions.append(Caption(f"{low:.0f} to {high:.0f} {unit}", left + width + 10, 14, 15, INK))


def _write(canvas: Array, captions: Sequence[Caption], path: Path) -> None:
    height, width, _ = canvas.shape
    image = bpy.data.images.new("Heat Map", width, height)
    try:
        image.pixels.foreach_set(np.dstack([canvas, np.ones((height, width))])[::-1].ravel().astype(np.float32))
        with tempfile.TemporaryDirectory() as folder:
            image.filepath_raw, image.file_format = os.path.join(folder, "cells.png"), "PNG"
            image.save()
            write_captioned(Path(image.filepath_raw), (width, height), captions, path)
    finally:
        bpy.data.images.remove(image)
