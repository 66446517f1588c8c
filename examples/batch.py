# SPDX-License-Identifier: GPL-3.0-or-later
"""Thousands of motions from a table of tasks.

    blender -b [scene.blend] --python-exit-code 1 --python examples/batch.py -- tasks.csv --out DIR
    blender -b --python examples/batch.py -- --help
"""
from __future__ import annotations

import os
import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, os.fspath(Path(__file__).resolve().parent.parent / "addon"))

import addon_utils  # noqa: E402
import bpy  # noqa: E402

if not bpy.data.filepath:
    bpy.ops.wm.read_homefile(use_empty=True)  # without the startup file's cube
addon_utils.enable("reachcast")

from reachcast.batch.command import main  # noqa: E402

sys.exit(main(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []))
