# SPDX-License-Identifier: GPL-3.0-or-later
"""A synthetic data set: variants of one lift x cameras around it; images, 2D keypoints in COCO's form, and depth.

    blender -b --factory-startup --python-exit-code 1 --python examples/keypoints_dataset.py -- --out DIR \\
        [--corpus FILE] [--variants 3] [--seed 1] [--cameras 4] [--step 8] [--size 320x240] [--engine EEVEE]

Writes DIR/images/NAME.png, DIR/depth/NAME.exr (metres along the camera's axis, 0 where nothing is) and
DIR/annotations.json: one person an image, a keypoint for each joint centre of the 2004 paper, in pixels from the upper
left corner, visibility 2 (seen), 1 (hidden behind something) or 0 (outside the image). A joint centre lies within the
body: it counts as seen when nothing stands in the way but the 15 cm before it. Of COCO's fields "segmentation" is left
out, and "area" is that of the box around the body. Every image also has its camera: K (3 x 3) and R, t from the world
to the camera (x to the right, y down, z ahead; metres).
"""
from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path[:0] = [os.fspath(HERE.parent / "addon"), os.fspath(HERE)]

import addon_utils  # noqa: E402
import bpy  # noqa: E402
import numpy as np  # noqa: E402
from mathutils import Matrix, Vector  # noqa: E402

addon_utils.enable("reachcast")

from reachcast import native  # noqa: E402
from reachcast.batch.pictures import FLESH_M, motion_points  # noqa: E402
from reachcast.batch.stage import Stage  # noqa: E402
from reachcast.batch.tasks import ENGINES, read_task, units_of  # noqa: E402
from reachcast.corpora import default_corpus, opened_corpus  # noqa: E402
from reachcast.rigs.joints import INDEX, JOINTS  # noqa: E402
from reachcast.scene import camera as cameras  # noqa: E402
from reachcast.scene.depth import render_depth  # noqa: E402
from reachcast.scene.predict_action import write_solved  # noqa: E402
from reachcast.scene.prepare import solve  # noqa: E402
from reachcast.scene.render import Look, quiet, render_frames, set_look, set_pictures  # noqa: E402
from reachcast.scene.studio import add_studio, place_studio  # noqa: E402

AHEAD = Vector((0.0, 1.0, 0.0))
FIRST_DEG = 25.0    # of the first camera, from straight ahead of the worker to the left
KEYPOINTS = JOINTS[:23]
LIMBS = [(f"{side}_{a}", f"{side}_{b}") for side in ("left", "right") for a, b in (
    ("ball", "ankle"), ("ankle", "knee"), ("knee", "hip"), ("shoulder", "elbow"), ("elbow", "wrist"),
    ("wrist", "hand_front"), ("wrist", "hand_back"))]
BONES = [*LIMBS, ("left_hip", "l5s1"), ("right_hip", "l5s1"), ("l5s1", "c7t1"), ("c7t1", "suprasternale"),
         ("suprasternale", "left_shoulder"), ("suprasternale", "right_shoulder"), ("c7t1", "tragion"),
         ("tragion", "nasion")]


def arguments(given: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="keypoints_dataset.py")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--corpus", type=Path)
    for name, value in (("variants", 3), ("seed", 1), ("cameras", 4), ("step", 8)):
        parser.add_argument(f"--{name}", type=int, default=value)
    parser.add_argument("--size", default="320x240")
    parser.add_argument("--engine", choices=ENGINES, default="EEVEE")
    parser.add_argument("--target", default="0.3 0.4 1.1")
    return parser.parse_args(list(given))


def add_cameras(count: int, points: np.ndarray) -> list[bpy.types.Object]:
    """Evenly around what they all see."""
    made = []
    for number in range(count):
        camera = cameras.add_camera(f"Camera {number + 1}")
        away = cameras.direction(AHEAD, True, FIRST_DEG + 360.0 * number / count)
        cameras.frame_points(camera, points, away, FLESH_M)
        made.append(camera)
    bpy.context.view_layer.update()
    return made


def pinhole(camera: bpy.types.Object, size: tuple[int, int]) -> dict[str, Any]:
    """K, R and t of a camera as computer vision has them."""
    length = camera.data.lens / camera.data.sensor_width * max(size)
    world = camera.matrix_world.normalized()
    turn = Matrix(((1, 0, 0), (0, -1, 0), (0, 0, -1))) @ world.to_3x3().transposed()
    return {"K": [[length, 0.0, size[0] / 2], [0.0, length, size[1] / 2], [0.0, 0.0, 1.0]],
            "R": [list(row) for row in turn], "t": list(-(turn @ world.translation))}


def project(pinhole: dict[str, Any], points: np.ndarray) -> np.ndarray:
    """(N, 3): x, y in pixels from the upper left corner, and metres ahead of the camera."""
    seen = points @ np.array(pinhole["R"]).T + np.array(pinhole["t"])
    pixels = seen @ np.array(pinhole["K"]).T
    return np.column_stack([pixels[:, :2] / pixels[:, 2:], seen[:, 2]])


def visibility(camera: bpy.types.Object, joint: np.ndarray, place: np.ndarray, size: tuple[int, int]) -> int:
    if place[2] <= 0.0 or not (0.0 <= place[0] < size[0] and 0.0 <= place[1] < size[1]):
        return 0
    start = camera.matrix_world.translation
    way = Vector(joint.tolist()) - start
    free = way.length - FLESH_M
    hit, *_ = bpy.context.scene.ray_cast(bpy.context.evaluated_depsgraph_get(), start, way.normalized(), distance=free)
    return 1 if hit else 2


def body_box(worker: bpy.types.Object, pinhole: dict[str, Any], size: tuple[int, int]) -> list[float]:
    """x, y, width, height in pixels of what the worker's meshes cover within the image."""
    graph, places = bpy.context.evaluated_depsgraph_get(), []
    for item in worker.children:
        if item.type == "MESH":
            shown = item.evaluated_get(graph)
            local = np.empty(3 * len(shown.data.vertices), np.float32)
            shown.data.vertices.foreach_get("co", local)
            matrix = np.array(shown.matrix_world)
            places.append(project(pinhole, local.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3])[:, :2])
    low, high = (np.clip(ends, 0, size) for ends in (np.min(np.vstack(places), 0), np.max(np.vstack(places), 0)))
    return [round(float(part), 2) for part in (*low, *(high - low))]


def annotation(number: int, camera: bpy.types.Object, view: dict[str, Any], worker: bpy.types.Object,
               joints: np.ndarray, size: tuple[int, int]) -> dict[str, Any]:
    """joints: (27, 3) world in the scene's current frame."""
    keypoints: list[float] = []
    for joint, place in zip(joints[:len(KEYPOINTS)], project(view, joints[:len(KEYPOINTS)])):
        seen = visibility(camera, joint, place, size)
        keypoints += [round(float(place[0]), 3), round(float(place[1]), 3), seen] if seen else [0, 0, 0]
    box = body_box(worker, view, size)
    return {"id": number, "image_id": number, "category_id": 1, "iscrowd": 0, "bbox": box, "area": box[2] * box[3],
            "keypoints": keypoints, "num_keypoints": sum(seen > 0 for seen in keypoints[2::3])}


def main(given: Sequence[str]) -> dict[str, Any]:
    options = arguments(given)
    bpy.ops.wm.read_homefile(use_empty=True)
    addon_utils.enable("reachcast")
    scene = bpy.context.scene
    stage = Stage(opened_corpus(native.core(), os.fspath(options.corpus or default_corpus())))
    task = read_task({"home": "0 0.42 0.1", "target": options.target, "variants": options.variants,
                      "seed": options.seed, "phases": "reach transfer return", "resolution": options.size,
                      "outputs": "png", "frame_step": options.step}, 1)
    if options.cameras < 1:
        raise ValueError(f"--cameras is {options.cameras}; it must be at least 1")
    size = task.resolution
    said: dict[str, Any] = {
        "info": {"description": "Lifts predicted by Reachcast", "units": "pixels; metres"}, "images": [],
        "annotations": [], "categories": [{
            "id": 1, "name": "person", "supercategory": "person", "keypoints": list(KEYPOINTS),
            "skeleton": [[INDEX[a] + 1, INDEX[b] + 1] for a, b in BONES]}]}
    for folder in ("images", "depth"):
        (options.out / folder).mkdir(parents=True, exist_ok=True)
    set_pictures(scene, options.engine, size)
    studio = add_studio(scene)
    set_look(scene, Look(options.engine))
    seen_from: list[bpy.types.Object] = []
    for variant, unit in enumerate(units_of(task), 1):
        prepared, worker, load = stage.prepared(unit)
        try:
            solved = solve(prepared)
        except ValueError as error:
            print(f"variant {variant} is left out: {error}", flush=True)
            continue
        write_solved(prepared, solved, worker.rig, load.box, unit.id, 1, bpy.context.view_layer)
        points = motion_points(solved, load)
        place_studio(studio, Vector(((points.min(axis=0) + points.max(axis=0)) / 2.0).tolist()), AHEAD, True)
        for camera in seen_from:
            bpy.data.objects.remove(camera)
        seen_from = add_cameras(options.cameras, points)
        frames = list(range(1, len(solved.joints) + 1, options.step))
        for number, camera in enumerate(seen_from, 1):
            name = f"v{variant}_c{number}"
            scene.camera = camera
            write_images(options.out, name, frames)
            view = pinhole(camera, size)
            for frame in frames:
                scene.frame_set(frame)
                image = len(said["images"]) + 1
                said["images"].append({"id": image, "file_name": f"images/{name}_{frame:04d}.png", "width": size[0],
                                       "height": size[1], "depth_file_name": f"depth/{name}_{frame:04d}.exr",
                                       "frame": frame, "variant_seed": unit.seed, "camera": view})
                said["annotations"].append(annotation(image, camera, view, worker.rig, solved.joints[frame - 1], size))
        print(f"variant {variant} of {options.variants}: {len(said['images'])} images", flush=True)
    if not said["images"]:
        raise ValueError(f"None of the {options.variants} variants can be done")
    (options.out / "annotations.json").write_text(json.dumps(said) + "\n", encoding="utf-8")
    return said


def write_images(out: Path, name: str, frames: Sequence[int]) -> None:
    """Pictures and depth through the scene's camera."""
    with tempfile.TemporaryDirectory(dir=out) as draft, quiet():
        for render, folder, suffix in ((render_frames, "images", "png"), (render_depth, "depth", "exr")):
            for frame, picture in render(Path(draft), frames).items():
                os.replace(picture, out / folder / f"{name}_{frame:04d}.{suffix}")


if __name__ == "__main__":
    try:
        main(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])
    except ValueError as error:
        sys.exit(f"keypoints_dataset: {error}.")
