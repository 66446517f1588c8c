# SPDX-License-Identifier: GPL-3.0-or-later
"""How much of a batch with pictures is spent outside Blender's renderer.

    blender -b --factory-startup --python-exit-code 1 --python blender_tests/bench_pictures.py -- [ENGINE] [SIZE] [STEP]
"""
from __future__ import annotations

import json
import sys
import tempfile
import time
from pathlib import Path
from typing import Any
from unittest import mock

import addon_utils
import bpy

sys.path.append(str(Path(__file__).resolve().parent.parent / "addon"))
addon_utils.enable("reachcast")

from reachcast.batch import pictures  # noqa: E402
from reachcast.batch.run import run_batch  # noqa: E402

MOST = 0.02     #: share of the time that may be spent outside the renderer
TASKS = 2


def timed(function: Any, seconds: dict[str, float]) -> Any:
    def call(*arguments: Any, **options: Any) -> Any:
        began = time.perf_counter()
        try:
            return function(*arguments, **options)
        finally:
            name = function.__name__
            seconds[name] = seconds.get(name, 0.0) + time.perf_counter() - began
    return call


def main(engine: str = "EEVEE", size: str = "640x480", step: str = "12") -> None:
    bpy.ops.wm.read_homefile(use_empty=True)
    addon_utils.enable("reachcast")
    rows = [{"id": f"t{number}", "stature": 1.6 + 0.1 * number, "home": "0 0.42 0.1", "target": f"{0.1 * number} 0.45 1",
             "outputs": "png mp4 sheet", "engine": engine, "resolution": size, "frame_step": step}
            for number in range(TASKS)]
    seconds: dict[str, float] = {}
    with tempfile.TemporaryDirectory() as folder:
        table = Path(folder) / "tasks.jsonl"
        table.write_text("".join(json.dumps(row) + "\n" for row in rows))
        names = ("render_frames", "write_film", "write_contact_sheet")
        with mock.patch.multiple(pictures, **{name: timed(getattr(pictures, name), seconds) for name in names}):
            began = time.perf_counter()
            counts = run_batch(table, Path(folder) / "out", say=lambda _: None).counts
            whole = time.perf_counter() - began
    if counts != {"done": TASKS}:
        raise SystemExit(f"bench_pictures: {counts}")
    outside = whole - sum(seconds.values())
    print(f"{engine} {size}, every {step} frames, {TASKS} tasks: {whole:.1f} s; " +
          ", ".join(f"{name} {value:.2f} s" for name, value in seconds.items()))
    print(f"ratio: {100 * outside / whole:.2f} % outside Blender (frames, film and sheet are its own), at most "
          f"{100 * MOST:g}; film and sheet {100 * (1 - seconds['render_frames'] / whole) - 100 * outside / whole:.2f} %")
    if outside > MOST * whole:
        raise SystemExit("bench_pictures: too much time outside the renderer")


if __name__ == "__main__":
    main(*(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []))
