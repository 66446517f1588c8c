# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures as arrays, for tests that look at them."""
from __future__ import annotations

import os
from pathlib import Path

import bpy
import numpy as np


def pixels(path: Path) -> np.ndarray:
    """(height, width, 3), top row first, as they are in the file: 0 to 1 in a PNG."""
    image = bpy.data.images.load(os.fspath(path))
    image.colorspace_settings.name = "Non-Color"
    values = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(values)
    width, height = image.size
    bpy.data.images.remove(image)
    return values.reshape(height, width, -1)[::-1, :, :3]
