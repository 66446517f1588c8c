# SPDX-License-Identifier: GPL-3.0-or-later
"""One motion to each of several places."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
from mathutils import Matrix

from .movers import is_carrier
from .predict_action import PredictionResult, keep_all, predict_motion
from .steps import Progress, Steps, run_to_end


@dataclass(frozen=True)
class TargetsResult:
    results: tuple[PredictionResult, ...]    #: in the order of the shelves
    failed: tuple[tuple[str, str], ...]      #: (shelf, why not)


def predict_to_targets(rig: bpy.types.Object, shelves: Sequence[bpy.types.Object],
                       **options: object) -> TargetsResult:
    """All of `target_steps` at once."""
    return run_to_end(target_steps(rig, shelves, **options))  # type: ignore[arg-type]


def target_steps(rig: bpy.types.Object, shelves: Sequence[bpy.types.Object], *,
                 box: bpy.types.Object | None = None, start_frame: int | None = None,
                 scene: bpy.types.Scene | None = None, **options: object) -> Steps[TargetsResult]:
    """What `predict_motion` does, for every shelf: an Action each on the rig and on the box, the first of them active.

    All start at the same frame. A place that cannot be served is named in `failed`; ValueError when none can, or when
    there is none. Every Action is kept with the file (fake user), since only one can be active.
    A step is a shelf.
    """
    if not shelves:
        raise ValueError("No targets are given; select the Empties on the shelves")
    scene = scene or bpy.context.scene
    first = scene.frame_current if start_frame is None else int(start_frame)
    former = {item: item.animation_data.action if item.animation_data else None for item in (rig, box) if item}
    place = box.matrix_basis.copy() if box else None
    results, failed = [], []
    for number, shelf in enumerate(shelves):
        if (yield Progress(number, len(shelves))):
            break
        _take_up(former)  # each motion begins from what the user had, not from the one before
        if box is not None and former[box] is None:
            _put_down(box, place)
        try:
            results.append(predict_motion(rig, shelf, box=box, start_frame=first, scene=scene, **options))
        except ValueError as error:
            failed.append((shelf.name, str(error)))
    if not results and not failed:
        raise ValueError("Stopped before the first target was finished")
    if not results:
        raise ValueError(f"No target can be served; '{failed[0][0]}': {failed[0][1]}")
    keep_all(results)
    _take_up({rig: bpy.data.actions[results[0].action],
              **({box: bpy.data.actions[results[0].box_action]} if box else {})})
    return TargetsResult(tuple(results), tuple(failed))


def _put_down(box: bpy.types.Object, place: Matrix) -> None:
    """Where the box stood before it was animated: without an Action it keeps what the last one gave it."""
    box.matrix_basis = place
    for constraint in filter(is_carrier, box.constraints):
        constraint.influence = 0.0


def _take_up(actions: dict[bpy.types.Object, bpy.types.Action | None]) -> None:
    for item, action in actions.items():
        if item.animation_data is not None:
            item.animation_data.action = action
