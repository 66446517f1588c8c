# SPDX-License-Identifier: GPL-3.0-or-later
"""Two sheets of predictions: one person's lifts to thirty places, and one place reached by people of five statures.

    blender -b --factory-startup --python-exit-code 1 --python examples/prediction_sheet.py -- --out out/sheets \\
        [--corpus FILE] [--moment placed|lift_off|...] [--size PIXELS]

Three towers (ahead, 45 degrees to the right, to the right), five heights from the ankle to above the head, near and far.
Each picture shows the moment at which the box stands; --moment names another event. A place that is out of reach is a
line of print and no picture.
"""
from __future__ import annotations

import argparse
import math
import os
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path[:0] = [os.fspath(HERE.parent / "addon"), os.fspath(HERE)]

import addon_utils  # noqa: E402

addon_utils.enable("reachcast")

import bpy  # noqa: E402
from mathutils import Vector  # noqa: E402
from reachcast.batch.stage import add_cuboid, add_mannequin, remove_made  # noqa: E402
from reachcast.scene import camera as cameras  # noqa: E402
from reachcast.scene.film import Moment, write_contact_sheet  # noqa: E402
from reachcast.scene.predict_action import predict_motion  # noqa: E402
from reachcast.scene.render import Look, quiet, render_frames, set_look, set_pictures  # noqa: E402
from reachcast.scene.studio import add_studio, place_studio  # noqa: E402

STATURE, STATURES = 1.75, (1.50, 1.60, 1.70, 1.80, 1.92)
TOWERS_DEG = {"ahead": 0.0, "half right": 45.0, "right": 90.0}
HEIGHTS = (0.15, 0.55, 0.95, 1.35, 1.65)    #: metres, of the box's base
DEPTHS = {"near": 0.38, "far": 0.52}        #: metres from between the feet
HOME, BOX = Vector((0.0, 0.45, 0.75)), (0.36, 0.28, 0.22)
ONE_PLACE = ("half right", 1.2, "near")


def place_at(tower: str, height: float, depth: str) -> tuple[Vector, float]:
    """Where the box goes, and its turn about the vertical."""
    angle, away = math.radians(TOWERS_DEG[tower]), DEPTHS[depth]
    return Vector((away * math.sin(angle), away * math.cos(angle), height)), -angle


def draw(cases: Iterable[tuple[str, float, tuple[str, float, str]]], options: argparse.Namespace, path: Path,
         columns: int) -> int:
    """(label, stature, place) of each picture. Returns how many there are."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable("reachcast")
    scene, size = bpy.context.scene, (options.size, options.size)
    box, home, shelf = add_cuboid(BOX), *(bpy.data.objects.new(name, None) for name in ("Home", "Shelf"))
    for empty in (home, shelf):
        scene.collection.objects.link(empty)
    home.location = HOME
    camera = scene.camera = cameras.add_camera()
    studio = add_studio(scene)
    set_pictures(scene, "EEVEE", size)
    set_look(scene, Look("EEVEE"))
    rig, shown, pictures = None, [], {}
    with tempfile.TemporaryDirectory(prefix="reachcast-") as folder:
        for label, stature, place in cases:
            if rig is None or rig["reachcast_stature"] != stature:
                if rig is not None:
                    remove_made(rig)
                rig = add_mannequin(stature, None)
            shelf.location, shelf.rotation_euler.z = place_at(*place)
            try:
                result = predict_motion(rig, shelf, home=home, box=box, corpus=options.corpus, start_frame=1)
            except ValueError as refused:
                print(f"{label}: {refused}", flush=True)
                continue
            scene.frame_set(result.frames[options.moment])
            points = cameras.bounds_over([box, *(item for item in rig.children if item.type == "MESH")],
                                         [scene.frame_current])
            away = cameras.direction(Vector((0.0, 1.0, 0.0)), True)
            place_studio(studio, Vector((points.min(axis=0) + points.max(axis=0)).tolist()) / 2.0,
                         Vector((0.0, 1.0, 0.0)), True)
            cameras.frame_points(camera, points, away)
            with quiet():
                picture = render_frames(Path(folder), [scene.frame_current])[scene.frame_current]
            pictures[len(shown)] = picture.replace(Path(folder) / f"place{len(shown)}.png")
            shown.append(Moment(len(shown), label))
        with quiet():
            write_contact_sheet(shown, pictures, size, path, columns)
    return len(shown)


def main() -> None:
    parser = argparse.ArgumentParser(prog="prediction_sheet.py", description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, required=True, help="folder of the two pictures")
    parser.add_argument("--corpus", help="motions to learn from; without it the corpus that ships")
    parser.add_argument("--moment", default="placed", choices=("grasp", "lift_off", "placed", "release"))
    parser.add_argument("--size", type=int, default=300, help="width and height of each picture")
    options = parser.parse_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])
    options.out.mkdir(parents=True, exist_ok=True)
    places = [(tower, height, depth) for height in reversed(HEIGHTS) for depth in DEPTHS for tower in TOWERS_DEG]
    for name, cases, columns in (
            ("places.png", [(f"{tower}, {depth}, {height:.2f} m", STATURE, (tower, height, depth))
                            for tower, height, depth in places], len(TOWERS_DEG) * len(DEPTHS)),
            ("statures.png", [(f"{stature:.2f} m tall", stature, ONE_PLACE) for stature in STATURES], len(STATURES))):
        count = draw(cases, options, options.out / name, columns)
        print(f"{options.out / name}: {count} of {len(cases)} lifts", flush=True)


if __name__ == "__main__":
    main()
