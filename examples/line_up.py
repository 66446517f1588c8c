# SPDX-License-Identifier: GPL-3.0-or-later
"""A line-up: ten women and men from short to tall do the same lift side by side, as a film.

    blender -b --factory-startup --python-exit-code 1 --python examples/line_up.py -- --out DIR \\
        [--corpus FILE] [--percentiles 5 25 50 75 95] [--shelf 0.1 0.45 1.2] [--size 1280x480] [--step 2] [--engine EEVEE]

A woman and a man of every percentile of stature (US Army survey of 1988). Writes line_up.blend, line_up.mp4 and
line_up.png (the moments of the first who lifts). Who cannot do it is named and left out.
"""
from __future__ import annotations

import argparse
import os
import shutil
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path[:0] = [os.fspath(HERE.parent / "addon"), os.fspath(HERE)]

import addon_utils  # noqa: E402
import bpy  # noqa: E402
from mathutils import Vector  # noqa: E402

addon_utils.enable("reachcast")

import demo_scene as scenery  # noqa: E402
from reachcast.batch.pictures import moments  # noqa: E402
from reachcast.batch.tasks import ENGINES, read_task  # noqa: E402
from reachcast.people import Person  # noqa: E402
from reachcast.scene import camera as cameras  # noqa: E402
from reachcast.scene.family import FamilyResult, predict_family  # noqa: E402
from reachcast.scene.film import write_contact_sheet, write_film  # noqa: E402
from reachcast.scene.render import Look, quiet, render_frames, set_look, set_pictures  # noqa: E402
from reachcast.scene.studio import add_studio, place_studio  # noqa: E402

AHEAD = Vector((0.0, 1.0, 0.0))
SPACING_M = 1.0
SIDE_DEG = 8.0
PHASES = ("reach", "transfer", "return")
REST_S = 0.8    # on the last frame


def arguments(given: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="line_up.py")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--corpus", type=Path)
    parser.add_argument("--percentiles", type=float, nargs="+", default=[5, 25, 50, 75, 95])
    parser.add_argument("--shelf", type=float, nargs=3, default=[0.1, 0.45, 1.2])
    parser.add_argument("--size", default="1280x480")
    parser.add_argument("--step", type=int, default=2)
    parser.add_argument("--engine", choices=ENGINES, default="EEVEE")
    return parser.parse_args(list(given))


def line_up(options: argparse.Namespace) -> FamilyResult:
    """Ten people beside a worker who shows where the first would stand, and who is then taken away with its box."""
    bpy.ops.wm.read_homefile(use_empty=True)
    addon_utils.enable("reachcast")
    shelf = scenery.add_empty("Shelf", options.shelf, scenery.facing_yaw(*options.shelf[:2]))
    home = scenery.add_empty("Home", scenery.HOME)
    box = scenery.add_box(home.location)
    worker = scenery.add_worker("mannequin", 1.75)
    people = [Person(sex, percentile) for percentile in options.percentiles for sex in ("female", "male")]
    found = predict_family(worker, shelf, home=home, box=box, members=sorted(people, key=lambda person: person.stature),
                           spacing=SPACING_M, corpus=options.corpus, phases=PHASES, start_frame=1)
    for item in (*worker.children, worker, box):
        bpy.data.objects.remove(item)
    return found


def film(found: FamilyResult, options: argparse.Namespace, size: tuple[int, int]) -> None:
    scene = bpy.context.scene
    rate = scene.render.fps / scene.render.fps_base
    scene.frame_start, scene.frame_end = 1, max(result.frames["end"] for _, result in found.results)
    set_pictures(scene, options.engine, size)
    shown = [item for item in bpy.data.collections[found.collection].objects if item.type == "MESH"]
    points = cameras.bounds_over(shown, range(1, scene.frame_end + 1, 6))
    place_studio(add_studio(scene), Vector(points.min(axis=0) + points.max(axis=0)) / 2.0, AHEAD, True)
    set_look(scene, Look(options.engine))
    scene.camera = cameras.add_camera()
    cameras.frame_points(scene.camera, points, cameras.direction(AHEAD, True, SIDE_DEG))
    bpy.ops.wm.save_as_mainfile(filepath=os.fspath(options.out / "line_up.blend"), check_existing=False)
    first = found.results[0][1]
    sheet = moments({event: frame - first.first_frame for event, frame in first.frames.items()},
                    scene.frame_end, rate, 1)
    drawn = set(range(1, scene.frame_end + 1, options.step))
    draft = Path(tempfile.mkdtemp(dir=options.out))
    try:
        pictures = render_frames(draft, sorted(drawn | {moment.frame for moment in sheet}))
        write_film([pictures[frame] for frame in sorted(drawn)], size, rate / options.step, options.out / "line_up.mp4",
                   rest=REST_S)
        write_contact_sheet(sheet, pictures, size, options.out / "line_up.png")
    finally:
        shutil.rmtree(draft)


def main(given: Sequence[str]) -> FamilyResult:
    options = arguments(given)
    options.out.mkdir(parents=True, exist_ok=True)
    try:
        size = read_task({"target": "0 0 0", "resolution": options.size, "frame_step": options.step}, 1).resolution
        found = line_up(options)
    except ValueError as error:
        sys.exit(f"line_up: {error}.")
    with quiet():
        film(found, options, size)
    for person, reason in found.failed:
        print(f"left out: {person}: {reason}")
    print(f"{len(found.results)} people, {bpy.context.scene.frame_end} frames: {options.out / 'line_up.mp4'}", flush=True)
    return found


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])
