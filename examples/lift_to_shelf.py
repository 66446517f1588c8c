# SPDX-License-Identifier: GPL-3.0-or-later
"""A worker lifts a box to a shelf: predicts the motion, measures it in the evaluated scene, renders it.

    blender -b --factory-startup --python-exit-code 1 --python examples/lift_to_shelf.py -- \\
        --out=DIR --corpus=FILE [--rig=mannequin|rigify] [--x=0.55 --y=0.35 --z=1.05] [--stature=1.75] [--quick]

examples/lift_to_shelf.sh builds what this needs and calls it.
"""
from __future__ import annotations

import argparse
import json
import math
import os
import shutil
import sys
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path[:0] = [os.fspath(HERE.parent / "addon"), os.fspath(HERE)]

import addon_utils  # noqa: E402
import bpy  # noqa: E402
import numpy as np  # noqa: E402

addon_utils.enable("reachcast")

import demo_render as render  # noqa: E402
import demo_scene as scenery  # noqa: E402
from reachcast.scene.measure import foot_slip, measure_lift, sample  # noqa: E402
from reachcast.scene.predict_action import PredictionResult, predict_motion  # noqa: E402
from reachcast.scene.read_rig import read_rig  # noqa: E402
from reachcast.scene.read_task import read_box  # noqa: E402

FRAME_RATE = 24
FIRST_FRAME = 1
LAST_FRAME_SECONDS = 0.8  # the film rests on its last frame
PHASES = ("reach", "transfer", "return")
RESULTS = ("lift.blend", "lift.mp4", "contact_sheet.png", "report.json")


@dataclass(frozen=True)
class Stage:
    worker: bpy.types.Object
    shelf: bpy.types.Object
    home: bpy.types.Object
    box: bpy.types.Object
    furniture: list[bpy.types.Object]  #: what the box and the hands keep clear of


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="lift_to_shelf.py")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--corpus", type=Path, required=True)
    parser.add_argument("--rig", choices=("mannequin", "rigify"), default="mannequin")
    parser.add_argument("--stature", type=float, default=1.75)
    for axis, place in zip("xyz", (0.55, 0.35, 1.05)):
        parser.add_argument(f"--{axis}", type=float, default=place)
    parser.add_argument("--quick", action="store_true")
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])


def set_stage(options: argparse.Namespace) -> Stage:
    """Everything that takes part in the prediction."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable("reachcast")
    bpy.context.scene.render.fps = FRAME_RATE
    shelf = scenery.add_empty("Shelf", (options.x, options.y, options.z), scenery.facing_yaw(options.x, options.y))
    home = scenery.add_empty("Home", scenery.HOME, scenery.facing_yaw(*scenery.HOME[:2]))
    box = scenery.add_box(home.location)
    box.rotation_euler.z = home.rotation_euler.z
    furniture = [scenery.add_shelf_board(shelf), scenery.add_pallet(home)]
    return Stage(scenery.add_worker(options.rig, options.stature), shelf, home, box, furniture)


def predict(stage: Stage, options: argparse.Namespace) -> PredictionResult:
    result = predict_motion(stage.worker, stage.shelf, corpus=options.corpus, home=stage.home, box=stage.box,
                            stature=options.stature, start_frame=FIRST_FRAME, phases=PHASES,
                            obstacles=stage.furniture)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = FIRST_FRAME, result.frames["end"]
    settings = scene.reachcast
    settings.rig, settings.shelf, settings.home, settings.box = stage.worker, stage.shelf, stage.home, stage.box
    settings.errand = "REACH_LIFT_RETURN"
    settings.corpus, settings.stature = os.fspath(options.corpus), options.stature
    return result


def measures(stage: Stage, result: PredictionResult) -> dict[str, float]:
    """The worst values over all frames of the evaluated scene."""
    skeleton = read_rig(stage.worker)
    samples = sample(stage.worker, skeleton, range(FIRST_FRAME, result.frames["end"] + 1), stage.box)
    lift = measure_lift(samples, skeleton, dict(result.frames), FRAME_RATE, read_box(stage.box),
                        np.array(stage.shelf.location))
    return {**lift.as_dict(), "right_foot_m": foot_slip(samples, "right")}


def report(stage: Stage, result: PredictionResult, options: argparse.Namespace) -> dict[str, Any]:
    shape = read_box(stage.box)
    return {
        "subject": {"stature_m": options.stature, "rig": options.rig},
        "task": {
            "phases": list(PHASES),
            "home_m": rounded(stage.home.location), "shelf_m": rounded(stage.shelf.location),
            "shelf_yaw_deg": round(math.degrees(stage.shelf.rotation_euler.z), 4),
            "box": {"size_m": rounded((shape.width, shape.depth, shape.height)), "handle_height_m": shape.handle_height,
                    "grip_distance_m": shape.grip_distance, "mass_kg": shape.mass},
        },
        "corpus": os.fspath(options.corpus),
        "corpus_kind": result.corpus_kind,
        "neighbours": [{"phase": near.phase, "id": near.id, "origin": near.origin, "mirrored": near.mirrored, "weight": near.weight,
                        "distances_m": dict(near.distances)} for near in result.neighbours],
        "outside_data": result.outside_data,
        "outside_reasons": list(result.outside_reasons),
        "corrections": list(result.corrections),
        "frame_rate": FRAME_RATE,
        "first_frame": result.first_frame,
        "frames": dict(result.frames),
        "measured_in_evaluated_scene": measures(stage, result),
    }


def rounded(place: Iterable[float]) -> list[float]:
    return [round(float(part), 6) for part in place]


def moments(result: PredictionResult) -> list[render.Moment]:
    frames = result.frames
    carried = frames["placed"] - frames["lift_off"]
    between = [frames["lift_off"] + round(part * carried) for part in (1 / 3, 2 / 3)]
    chosen = [(FIRST_FRAME, "at ease"), (frames["grasp"], "grasp"), (between[0], "on the way"),
              (between[1], "on the way"), (frames["placed"], "placed"), (frames["end"], "at ease again")]
    return [render.Moment(frame, f"{word}   frame {frame}, {(frame - FIRST_FRAME) / FRAME_RATE:.2f} s")
            for frame, word in chosen]


def furnish(stage: Stage, options: argparse.Namespace) -> None:
    """What is only looked at."""
    scene = bpy.context.scene
    seen = [stage.box, *stage.furniture, *(item for item in stage.worker.children if item.type == "MESH")]
    points = render.bounds_over(seen, range(scene.frame_start, scene.frame_end + 1, 3))
    toward_left = options.x >= 0.0  # the shelf is not between the camera and the worker
    render.furnish(points, toward_left, quick=options.quick)
    render.look_through_camera()
    scene.frame_set(scene.frame_start)


def write_results(draft: Path, stage: Stage, result: PredictionResult, options: argparse.Namespace) -> dict[str, Any]:
    """All files, in a folder nobody looks into."""
    said = report(stage, result, options)
    (draft / "report.json").write_text(json.dumps(said, indent=2, allow_nan=False) + "\n")
    furnish(stage, options)
    with render.quiet(draft / "blender.log"):
        bpy.ops.wm.save_as_mainfile(filepath=os.fspath(draft / "lift.blend"), check_existing=False)
    shown = moments(result)
    step = render.QUICK_STEP if options.quick else 1
    frames = sorted({*range(FIRST_FRAME, result.frames["end"] + 1, step), *(moment.frame for moment in shown)})
    size = render.QUICK_SIZE if options.quick else render.SIZE
    pictures = render.render_and_say(draft, frames)
    with render.quiet(draft / "blender.log"):
        render.write_film([pictures[frame] for frame in frames], size, FRAME_RATE / step, draft / "lift.mp4",
                          rest=LAST_FRAME_SECONDS)
        render.write_contact_sheet(shown, pictures, size, draft / "contact_sheet.png")
    return said


def summary(said: dict[str, Any], out: Path) -> str:
    got, frames = said["measured_in_evaluated_scene"], said["frames"]
    kind = said["corpus_kind"]
    where = f"outside the {kind} data: " + "; ".join(said["outside_reasons"]) if said["outside_data"] \
        else f"within the {kind} data"
    return "\n".join((
        f"{said['subject']['rig']} of {said['subject']['stature_m']:g} m carries {said['task']['box']['mass_kg']:g} kg "
        f"to {tuple(said['task']['shelf_m'])} m in {(frames['end'] - FIRST_FRAME) / FRAME_RATE:.1f} s",
        f"learned from {len(said['neighbours'])} {kind} motions; {where}",
        f"box lands {1e6 * got['landing_m']:.1f} micrometres from the shelf's mark, hands keep within "
        f"{1e6 * got['held_m']:.1f} of their handles, the left foot moves {1e6 * got['left_foot_m']:.1f}",
        *(f"corrected: {line}" for line in said["corrections"]),
        f"{', '.join(RESULTS)} are in {out}"))


def main() -> None:
    options = arguments()
    options.out.mkdir(parents=True, exist_ok=True)
    draft = Path(tempfile.mkdtemp(prefix=".lift-", dir=options.out))
    try:
        stage = set_stage(options)
        said = write_results(draft, stage, predict(stage, options), options)
        for name in RESULTS:
            os.replace(draft / name, options.out / name)
        print(summary(said, options.out), flush=True)
    except ValueError as error:
        sys.exit(f"lift_to_shelf: {error}.")
    finally:
        shutil.rmtree(draft, ignore_errors=True)


if __name__ == "__main__":
    main()
