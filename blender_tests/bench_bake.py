# SPDX-License-Identifier: GPL-3.0-or-later
"""Prediction from 3,000 motions and key writing, against `nla.bake` of the same frames of an IK setup on the same rig.

    blender -b --factory-startup --python-exit-code 1 --python blender_tests/bench_bake.py

Prints the medians and their ratio, which must be below a tenth; else the exit status is 1.
"""
from __future__ import annotations

import math
import os
import statistics
import sys
import time
import unittest
from collections.abc import Callable
from pathlib import Path

import addon_utils
import bpy

HERE = Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path[:0] = [os.fspath(HERE.parent / "addon"), os.fspath(HERE)]
RUNS = 7          #: of each; the median is taken
MOST_RATIO = 0.1  #: the issue's own
#: Bone that holds the constraint, whose tail follows the target, and how many bones it bends.
IK = {"hand.L": 3, "hand.R": 3, "shin.L": 2, "shin.R": 2}


def median_seconds(task: Callable[[], object], before: Callable[[], object]) -> float:
    """Of RUNS runs after one to warm up; `before` each is not timed."""
    seconds = []
    for _ in range(RUNS + 1):
        before()
        began = time.perf_counter()
        task()
        seconds.append(time.perf_counter() - began)
    return statistics.median(seconds[1:])


def bone_tails(rig: bpy.types.Object, names: list[str], frames: range) -> dict[str, list[tuple[float, ...]]]:
    """World places of bones' tails, per frame."""
    tails: dict[str, list[tuple[float, ...]]] = {name: [] for name in names}
    for frame in frames:
        bpy.context.scene.frame_set(frame)
        for name in names:
            tails[name].append(tuple(rig.matrix_world @ rig.pose.bones[name].tail))
    return tails


def add_ik(rig: bpy.types.Object, tails: dict[str, list[tuple[float, ...]]], frames: range) -> None:
    """Hands and feet pulled to Empties that are keyed along `tails`."""
    for name, places in tails.items():
        target = bpy.data.objects.new(f"target {name}", None)
        bpy.context.collection.objects.link(target)
        for frame, place in zip(frames, places):
            target.location = place
            target.keyframe_insert("location", frame=frame)
        constraint = rig.pose.bones[name].constraints.new("IK")
        constraint.target, constraint.chain_count = target, IK[name]


def bake(rig: bpy.types.Object, frames: range) -> None:
    bpy.ops.nla.bake(frame_start=frames[0], frame_end=frames[-1], only_selected=False, visual_keying=True,
                     clear_constraints=False, use_current_action=False, bake_types={"POSE"})


def ik_error(rig: bpy.types.Object, tails: dict[str, list[tuple[float, ...]]], frames: range) -> float:
    """Metres by which the baked hands and feet miss the predicted ones without constraints: what was timed works."""
    for constraint in (constraint for bone in rig.pose.bones for constraint in bone.constraints):
        constraint.mute = True
    baked = bone_tails(rig, list(IK), frames)
    return max(math.dist(one, other) for name in baked for one, other in zip(baked[name], tails[name]))


def compare(rig_name: str, corpus: str) -> float:
    """Prints both medians for a rig; returns their ratio."""
    from lift_cases import Place, lift_scene, rig_of
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="reachcast")
    scene = lift_scene(rig_of(rig_name, 1.72))
    rig, place = scene.rig, Place(1.0, 20, 0.45, facing=True)
    predicted = median_seconds(lambda: scene.predict(corpus, start_frame=1), lambda: scene.arrange(place, "floor"))
    action = rig.animation_data.action
    frames = range(1, int(action.frame_range[1]) + 1)
    tails = bone_tails(rig, list(IK), frames)
    add_ik(rig, tails, frames)  # on top of the predicted Action, which moves the trunk
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="POSE")
    baked = median_seconds(lambda: bake(rig, frames), lambda: setattr(rig.animation_data, "action", action))
    from reachcast.scene.action_writer import curves_of
    keys = sum(len(curve.keyframe_points) for curve in curves_of(rig.animation_data.action))
    print(f"{rig_name}: {len(frames)} frames, {len(rig.pose.bones)} bones")
    print(f"  predict and write keys  {1000 * predicted:8.1f} ms")
    print(f"  nla.bake                {1000 * baked:8.1f} ms ({keys} keys, hands and feet within "
          f"{1e6 * ik_error(rig, tails, frames):.1f} micrometres)")
    print(f"  ratio                   {predicted / baked:8.3f} (must be below {MOST_RATIO})", flush=True)
    return predicted / baked


def main() -> int:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if addon_utils.enable("reachcast") is None:
        raise SystemExit("The add-on 'reachcast' could not be enabled")
    import corpora
    try:
        corpus = os.fspath(corpora.large_corpus())
    except unittest.SkipTest as reason:
        print(f"skipped: {reason}")
        return 0
    print(f"corpus of {corpora.LARGE} motions, medians of {RUNS} runs")
    return 0 if max(compare(rig, corpus) for rig in ("mannequin", "metarig")) < MOST_RATIO else 1


if __name__ == "__main__":
    sys.exit(main())
