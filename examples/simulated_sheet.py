# SPDX-License-Identifier: GPL-3.0-or-later
"""A sheet of simulated motions: each row is one motion of the corpus at five moments, from the right and a little ahead.

    blender -b --factory-startup --python-exit-code 1 --python examples/simulated_sheet.py -- --out sheet.png \\
        [--corpus FILE] [--rows stature,origin ...] [--view DEGREES]

Without --corpus it is the one that ships. A row names a subject by the stature that comes nearest, and the end of the
motion's origin, such as 1.75,floor/t9/r1/transfer.
"""
from __future__ import annotations

import argparse
import math
import os
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path[:0] = [os.fspath(HERE.parent / "addon"), os.fspath(HERE)]

import addon_utils  # noqa: E402
import bpy  # noqa: E402
import numpy as np  # noqa: E402
from mathutils import Vector  # noqa: E402

addon_utils.enable("reachcast")

import demo_render as render  # noqa: E402
import demo_scene as scenery  # noqa: E402
from reachcast import native  # noqa: E402
from reachcast.corpora import default_corpus  # noqa: E402
from reachcast.rigs.retarget import retarget  # noqa: E402
from reachcast.scene.mannequin import build_mannequin, standing_posture  # noqa: E402
from reachcast.scene.read_rig import read_rig  # noqa: E402
from reachcast.scene.write_motion import write_rig_action  # noqa: E402

ROWS = ("1.55,floor/t5/transfer", "1.84,floor/t9/transfer", "1.69,paper/t9/transfer", "1.72,paper/t15/transfer",
        "1.62,paper/t27/retrieve", "1.91,paper/t1/reach", "1.65,paper/t13/return", "1.47,paper/t7/transfer")
MOMENTS = (0, 2, 5, 8, 10)  # of the eleven postures of a motion
SPACING_M = 1.0
PANEL = (800, 340)
COLUMNS = 2


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="simulated_sheet.py")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--corpus", type=Path)
    parser.add_argument("--rows", nargs="+", default=ROWS)
    parser.add_argument("--view", type=float, default=62.0, help="degrees from straight ahead, to the person's right")
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])


def chosen(corpus, row: str):
    """The motion that a row names."""
    stature, origin = row.split(",")
    series, _, rest = origin.partition("/")
    fitting = [motion for motion in corpus.motions() if not motion.mirrored and motion.origin.startswith(series)
               and all(f"/{part}" in f"{motion.origin}/" and f"/{part}/" in f"{motion.origin}/"
                       for part in rest.split("/"))]
    if not fitting:
        sys.exit(f"simulated_sheet: the corpus holds no motion '{origin}'")
    return min(fitting, key=lambda motion: (abs(motion.subject.stature - float(stature)), motion.id))


def add_person(core, motion, posture, place: Vector) -> None:
    """A mannequin in a posture, moved by `place`; with the box where the hands carry or find one."""
    joints = standing_posture(motion.subject.stature, motion.subject.sex)
    worker = build_mannequin(bpy.context.collection, joints, motion.subject.sex, stature=motion.subject.stature)
    bpy.context.view_layer.update()
    skeleton = read_rig(worker)
    write_rig_action(worker, skeleton, retarget(skeleton, skeleton.to_world(posture)[None]), "Posture", 1)
    worker.rotation_euler.z += math.pi
    worker.location += place
    grips = [posture[core.JOINTS.index(f"{side}_grip")] for side in ("left", "right")]
    if motion.phase in ("transfer", "retrieve"):
        hold, across = (grips[0] + grips[1]) / 2, grips[1] - grips[0]
    else:
        hold = motion.target if motion.phase == "reach" else motion.home
        across = np.array([hold[1] + 0.1, -hold[0], 0.0])
    box = scenery.add_box(Vector(hold) + place - Vector((0.0, 0.0, scenery.HANDLE_HEIGHT)))
    box.rotation_euler.z = math.atan2(across[1], across[0])


def draw_row(core, corpus, row: str, view: float, path: Path) -> str:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable("reachcast")
    motion = chosen(corpus, row)
    postures = core.replay(corpus, motion.id)
    side = math.radians(view)
    across = Vector((-math.cos(side), math.sin(side), 0.0))  # to the right of the picture
    for number, moment in enumerate(MOMENTS):
        add_person(core, motion, postures[moment], SPACING_M * number * across)
    scene = bpy.context.scene
    scene.frame_set(1)
    meshes = [item for item in scene.objects if item.type == "MESH"]
    points = render.bounds_over(meshes, [1])
    render.furnish(points, False, size=PANEL, side_deg=view)
    with tempfile.TemporaryDirectory() as folder, render.quiet():
        render.render_frames(Path(folder), [1])[1].replace(path)
    age, sex = motion.subject.age, "woman" if motion.subject.sex == "female" else "man"
    return f"{sex} of {motion.subject.stature:.2f} m, {age:.0f} years: {motion.phase}, {motion.duration:.1f} s, {motion.origin}"


def main() -> None:
    options = arguments()
    core = native.core()
    corpus = core.Corpus.open(os.fspath(options.corpus or default_corpus()))
    options.out.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        pictures = [Path(folder) / f"{number}.png" for number in range(len(options.rows))]
        labels = [draw_row(core, corpus, row, options.view, path) for row, path in zip(options.rows, pictures)]
        chains, inputs = [], []
        for number, (picture, label) in enumerate(zip(pictures, labels)):
            inputs += ["-i", os.fspath(picture)]
            text = label.replace(":", "\\:")
            chains.append(f"[{number}]drawtext=fontfile={render.FONT}:text='{text}':fontsize=17:fontcolor=white:x=10:y=8"
                          f"[p{number}]")
        corners = "|".join(f"{PANEL[0] * (n % COLUMNS)}_{PANEL[1] * (n // COLUMNS)}" for n in range(len(pictures)))
        panels = "".join(f"[p{number}]" for number in range(len(pictures)))
        chains.append(f"{panels}xstack=inputs={len(pictures)}:layout={corners}[sheet]" if len(pictures) > 1
                      else "[p0]copy[sheet]")
        render.ffmpeg(*inputs, "-filter_complex", ";".join(chains), "-map", "[sheet]", "-frames:v", "1",
                      os.fspath(options.out))
    print(f"{options.out}: {len(labels)} motions")


if __name__ == "__main__":
    main()
