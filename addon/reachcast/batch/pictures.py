# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of one motion that is on rig and box: frames, a film, a contact sheet, and a thumbnail for the gallery."""
from __future__ import annotations

import os
import re
import shutil
from collections.abc import Mapping
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector

from ..rigs.rotations import Array
from ..scene import camera as cameras
from ..scene.film import Moment, write_contact_sheet, write_film
from ..scene.prepare import Prepared, Solved
from ..scene.render import Look, kept_render, quiet, render_frames, set_look, set_pictures
from ..scene.studio import add_studio, place_studio, studio_of
from .stage import Load, Worker
from .tasks import Task

PICTURES = frozenset({"png", "mp4", "sheet"})
THUMBNAIL = "thumbnail.png"
THUMBNAIL_WIDTH = 240    #: pixels
OWN_CAMERA = "Batch Camera"
FLESH_M = 0.15           #: by which the body may reach beyond its joint centres


def write_pictures(task: Task, prepared: Prepared, solved: Solved, worker: Worker, load: Load, first: int, rate: float,
                   folder: Path) -> list[str]:
    """What the task wants of PICTURES, and the thumbnail. The Actions are on rig and box from frame `first` on."""
    scene, wanted = bpy.context.scene, PICTURES & set(task.outputs)
    shown = moments(solved.motion.events, len(solved.joints), rate, first)
    drawn = set(range(first, first + len(solved.joints), task.frame_step)) if wanted & {"png", "mp4"} else set()
    extra = {moment.frame for moment in shown} if "sheet" in wanted else set()
    frames, files = folder / "frames", []
    frames.mkdir()
    with kept_render(scene), quiet():
        set_pictures(scene, task.engine, task.resolution)
        scene.camera = ready_camera(task, prepared, solved, load)
        if studio_of(scene):
            set_look(scene, Look(task.engine))
        pictures = render_frames(frames, sorted(drawn | extra))
        if "mp4" in wanted:
            write_film([pictures[frame] for frame in sorted(drawn)], task.resolution, rate / task.frame_step,
                       folder / "motion.mp4")
            files.append("motion.mp4")
        if "sheet" in wanted:
            write_contact_sheet(shown, pictures, task.resolution, folder / "sheet.png")
            files.append("sheet.png")
        middle = shown[len(shown) // 2].frame
        _write_thumbnail(pictures[min(pictures, key=lambda frame: (abs(frame - middle), frame))], folder / THUMBNAIL)
    if "png" in wanted:
        for frame in extra - drawn:
            pictures[frame].unlink()
        files.append("frames")
    else:
        shutil.rmtree(frames)
    return [*files, THUMBNAIL]


def moments(events: Mapping[str, int], count: int, rate: float, first: int) -> list[Moment]:
    """The start, the events and the end, in order, each frame once; and the thirds of the way of a box that is carried
    once.

    events: frames from 0; first: the scene's frame of the first of `count` frames, `rate` a second.
    """
    named = {0: "start"}
    for event, frame in events.items():
        named.setdefault(frame, re.sub(r"_\d+$", "", event).replace("_", " "))
    if "lift_off" in events and "placed" in events and "lift_off_2" not in events:
        begun, put = events["lift_off"], events["placed"]
        for part in (1 / 3, 2 / 3):
            named.setdefault(begun + round(part * (put - begun)), "on the way")
    named.setdefault(count - 1, "end")
    return [Moment(first + frame, f"{word}   frame {first + frame}, {frame / rate:.2f} s")
            for frame, word in sorted(named.items())]


def ready_camera(task: Task, prepared: Prepared, solved: Solved, load: Load) -> bpy.types.Object:
    """The scene's own that the task names, else one that sees the whole motion; with a studio for a scene without any.

    The scene has the size of the pictures already.
    """
    scene = bpy.context.scene
    if task.camera is not None:
        found = scene.objects.get(task.camera)
        if found is None or found.type != "CAMERA":
            raise ValueError(f"The camera '{task.camera}' is not in the scene")
        return found
    skeleton = prepared.skeleton
    ahead = Vector(skeleton.axes[1].tolist())
    toward_left = prepared.lift.target[0] >= 0.0  # the shelf is not between the camera and the worker
    points = motion_points(solved, load)
    camera = scene.objects.get(OWN_CAMERA)
    if camera is None:
        if not any(item.type == "CAMERA" for item in scene.objects):
            add_studio(scene)
        camera = cameras.add_camera(OWN_CAMERA)
    if studio := studio_of(scene):
        place_studio(studio, Vector(((points.min(axis=0) + points.max(axis=0)) / 2.0).tolist()), ahead, toward_left,
                     float(skeleton.origin[2]))
    cameras.frame_points(camera, points, cameras.direction(ahead, toward_left), FLESH_M)
    return camera


def motion_points(solved: Solved, load: Load) -> Array:
    """(N, 3) world: every joint centre and every corner of the box in every frame."""
    shape = load.shape
    corners = np.array([(x * shape.width / 2, y * shape.depth / 2, z * shape.height)
                        for x in (-1, 1) for y in (-1, 1) for z in (0, 1)])
    origins, turns = solved.places
    boxes = origins[:, None, :] + np.einsum("fij,cj->fci", turns, corners)
    return np.concatenate([solved.joints.reshape(-1, 3), boxes.reshape(-1, 3)])


def _write_thumbnail(picture: Path, path: Path) -> None:
    image = bpy.data.images.load(os.fspath(picture))
    try:
        width, height = image.size
        if width > THUMBNAIL_WIDTH:
            image.scale(THUMBNAIL_WIDTH, max(1, round(height * THUMBNAIL_WIDTH / width)))
        image.filepath_raw, image.file_format = os.fspath(path), "PNG"
        image.save()
    finally:
        bpy.data.images.remove(image)
