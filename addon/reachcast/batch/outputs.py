# SPDX-License-Identifier: GPL-3.0-or-later
"""One solved motion as files in a folder."""
from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from ..rigs.joints import JOINTS
from ..scene.blender_versions import one_gltf_animation
from ..scene.carry import carriers_of
from ..scene.predict_action import write_solved
from ..scene.prepare import Prepared, Solved
from ..scene.reused_actions import ReusedActions
from .bvh import write_bvh
from .pictures import PICTURES, write_pictures
from .stage import Load, Worker
from .tasks import Unit

FIRST_FRAME = 1


@dataclass(frozen=True)
class Work:
    unit: Unit
    prepared: Prepared
    worker: Worker
    load: Load
    solved: Solved
    frame_rate: float
    actions: ReusedActions


def write_outputs(work: Work, folder: Path) -> list[str]:
    """The files that the task asks for, by name."""
    wanted, files = set(work.unit.task.outputs), []
    if "csv" in wanted:
        write_csv(work, folder / "joints.csv")
        files.append("joints.csv")
    if "bvh" in wanted:
        write_bvh(folder / "motion.bvh", work.worker.skeleton, work.solved.pose, work.frame_rate)
        files.append("motion.bvh")
    if wanted & {"gltf", *PICTURES}:
        files += _write_from_scene(work, folder, wanted)
    elif "action" in wanted:
        _write_action(work, folder / "action.blend")
        files.append("action.blend")
    return files


def write_csv(work: Work, path: Path) -> None:
    """Joint centres, world, metres to a hundredth of a millimetre: time_s, then NAME_x, NAME_y, NAME_z."""
    joints = work.solved.joints
    times = np.arange(len(joints)) / work.frame_rate
    # Whole numbers of 10 micrometres are divided as text: formatting floats would take as long as predicting them.
    rows = np.column_stack([times, joints.reshape(len(joints), -1)])
    path.write_bytes(_HEADER + _decimal_lines(rows))


def _decimal_lines(values: np.ndarray) -> bytes:
    """Rows of comma-separated numbers with five decimals, each as ' 000.00000' or '-000.00000', |value| < 1000."""
    whole = np.rint(np.abs(values) * 1e5).astype(np.int64)
    if whole.max(initial=0) >= 10 ** 8:
        raise ValueError("A joint is 1,000 m or more from the world's origin, which the table has no room for")
    text = np.empty((*values.shape, 11), np.uint8)
    text[..., 0] = np.where((values < 0.0) & (whole > 0), ord("-"), ord("+"))
    for column in (9, 8, 7, 6, 5, 3, 2, 1):
        quotient = whole // 10
        text[..., column] = whole - 10 * quotient + ord("0")
        whole = quotient
    text[..., 4], text[..., 10] = ord("."), ord(",")
    text[:, -1, 10] = ord("\n")
    return text.tobytes()


_HEADER = (",".join(["time_s", *(f"{name}_{axis}" for name in JOINTS for axis in "xyz")]) + "\n").encode()


def _write_action(work: Work, path: Path) -> None:
    """The Actions of rig and box, which nobody plays."""
    with _carriers_kept(work):
        result = write_solved(work.prepared, work.solved, work.worker.rig, work.load.box, work.unit.id, FIRST_FRAME,
                              bpy.context.view_layer, work.load.above, work.actions.write)
    written = {bpy.data.actions[name] for name in (result.action, result.box_action) if name}
    bpy.data.libraries.write(str(path), written, fake_user=True)


@contextmanager
def _carriers_kept(work: Work) -> Iterator[None]:
    """Afterwards a box of the scene is carried by whom it was: the next task's Action has no channels of this one's
    rig. A box that was made is always carried by the same."""
    box = work.load.box
    carriers = {constraint.name for constraint in carriers_of(box)}
    try:
        yield
    finally:
        for constraint in carriers_of(box) if isinstance(work.unit.task.object, str) else ():
            if constraint.name not in carriers:
                box.constraints.remove(constraint)


def _write_from_scene(work: Work, folder: Path, wanted: set[str]) -> list[str]:
    """What needs the Actions on rig and box. Afterwards the scene is as it was: memory does not grow, and no task sees
    which ones came before."""
    rig, box = work.worker.rig, work.load.box
    kept = {item: item.animation_data.action if item.animation_data else None for item in (rig, box)}
    written: list[Any] = []
    files = []
    work.actions.close()  # an exporter takes every Action that fits the rig
    with _carriers_kept(work):
        try:
            result = write_solved(work.prepared, work.solved, rig, box, work.unit.id, FIRST_FRAME,
                                  bpy.context.view_layer, work.load.above)
            written = [bpy.data.actions[name] for name in (result.action, result.box_action) if name]
            if "action" in wanted:
                bpy.data.libraries.write(str(folder / "action.blend"), set(written), fake_user=True)
                files.append("action.blend")
            if "gltf" in wanted:
                _write_gltf(work, folder / "motion.glb")
                files.append("motion.glb")
            if wanted & PICTURES:
                files += write_pictures(work.unit.task, work.prepared, work.solved, work.worker, work.load, FIRST_FRAME,
                                        work.frame_rate, folder)
        finally:
            for item, action in kept.items():
                if item.animation_data:
                    item.animation_data.action = action
            for action in written:
                bpy.data.actions.remove(action)
    return files


def _write_gltf(work: Work, path: Path) -> None:
    """The rig, what it wears and the box, by Blender's exporter, as one animation."""
    rig, box, scene = work.worker.rig, work.load.box, bpy.context.scene
    scene.frame_start, scene.frame_end = FIRST_FRAME, FIRST_FRAME + len(work.solved.joints) - 1
    for item in bpy.context.view_layer.objects:
        item.select_set(item in (rig, box) or item.parent == rig)
    bpy.ops.export_scene.gltf(filepath=str(path), export_format="GLB", use_selection=True, export_animations=True,
                              export_frame_range=True, export_force_sampling=True, export_yup=True,
                              **one_gltf_animation())
