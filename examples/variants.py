# SPDX-License-Identifier: GPL-3.0-or-later
"""The same lift as people vary: ghosts drawn from seeds beside the mean, the spread of the hands' paths as a tube, and
the mean path as the Bezier curve that can be edited. Writes variants.blend and variants.png.

    blender -b --factory-startup --python-exit-code 1 --python examples/variants.py -- \\
        --corpus FILE --out DIR [--count 3] [--seed 1]
"""
from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path[:0] = [os.fspath(HERE.parent / "addon"), os.fspath(HERE)]

import addon_utils  # noqa: E402
import bpy  # noqa: E402

addon_utils.enable("reachcast")

import demo_render as render  # noqa: E402
import demo_scene as scenery  # noqa: E402
from reachcast.scene.path_session import begin_session  # noqa: E402
from reachcast.scene.variants import predict_variants  # noqa: E402

SHELF = (0.30, 0.45, 1.10)
SPACING = 1.1


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="variants.py")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--corpus", type=Path, required=True)
    parser.add_argument("--count", type=int, default=3)
    parser.add_argument("--seed", type=int, default=1)
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])


def main() -> None:
    options = arguments()
    options.out.mkdir(parents=True, exist_ok=True)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable("reachcast")
    scene = bpy.context.scene
    shelf = scenery.add_empty("Shelf", SHELF)
    home = scenery.add_empty("Home", scenery.HOME)
    box = scenery.add_box(home.location)
    worker = scenery.add_worker("mannequin", 1.75)
    task = {"home": home, "box": box, "corpus": options.corpus, "start_frame": 1}
    try:
        found = predict_variants(worker, shelf, count=options.count, seed=options.seed, ghosts=True, spacing=SPACING,
                                 **task)
        session = begin_session(worker, shelf, **task)
    except ValueError as error:
        sys.exit(f"variants: {error}.")
    bpy.data.objects[session.curves[0]].hide_render = False
    lift_off, placed = session.result.frames["lift_off"], session.result.frames["placed"]
    scene.frame_start, scene.frame_end = 1, max(result.frames["end"] for result in found.results)
    shown = [item for item in scene.objects if item.type == "MESH"]
    middle = (lift_off + placed) // 2
    points = render.bounds_over(shown, range(lift_off, placed, 4))
    render.furnish(points, toward_left=False)
    bpy.ops.wm.save_as_mainfile(filepath=os.fspath(options.out / "variants.blend"), check_existing=False)
    with render.quiet():
        render.render_frames(options.out, [middle])[middle].replace(options.out / "variants.png")
    print(f"{len(found.results)} variants, seeds {found.seeds}; not possible: {dict(found.failed) or 'none'}")


if __name__ == "__main__":
    main()
