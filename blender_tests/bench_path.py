# SPDX-License-Identifier: GPL-3.0-or-later
"""How often a second the whole body follows an edited hand path: 3,000 motions, both rigs, no window.

    blender -b --factory-startup --python-exit-code 1 --python blender_tests/bench_path.py

One update: a handle has moved, the body is solved again, its keys are rewritten and the scene is evaluated.
"""
from __future__ import annotations

import os
import statistics
import sys
import time
import unittest
from pathlib import Path

import addon_utils
import bpy

HERE = Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path[:0] = [os.fspath(HERE.parent / "addon"), os.fspath(HERE)]
UPDATES = 60
LEAST_PER_S = 30.0  #: the issue's own, for the mannequin


def updates_per_second(rig: str) -> tuple[float, float]:
    """Of the median and of the slowest update."""
    import corpora
    from lift_cases import Place, lift_scene, rig_of
    from reachcast.scene.path_session import begin_session, end_session
    scene = lift_scene(rig_of(rig, 1.72))
    scene.arrange(Place(1.0, 60, 0.55, facing=True), "floor")
    session = begin_session(scene.rig, scene.shelf, home=scene.home, box=scene.box, start_frame=1,
                            corpus=corpora.large_corpus())
    curve = bpy.data.objects[session.curves[0]]
    bpy.context.scene.frame_set(20)
    seconds = []
    for step in range(UPDATES):
        curve.data.splines[0].bezier_points[0].handle_right.z += 0.004 if step < UPDATES // 2 else -0.004
        began = time.perf_counter()
        assert session.update()
        bpy.context.view_layer.update()
        seconds.append(time.perf_counter() - began)
    end_session(session)
    return 1.0 / statistics.median(seconds), 1.0 / max(seconds)


def live_per_second() -> float:
    """The same for a shelf that moves, on the mannequin: the median."""
    import corpora
    from lift_cases import Place, lift_scene, rig_of
    from reachcast.scene.path_session import begin_session
    scene = lift_scene(rig_of("mannequin", 1.72))
    scene.arrange(Place(1.0, 60, 0.55, facing=True), "floor")
    session = begin_session(scene.rig, scene.shelf, home=scene.home, box=scene.box, start_frame=1,
                            corpus=corpora.large_corpus(), live=True)
    seconds = []
    for step in range(UPDATES):
        began = time.perf_counter()
        scene.shelf.location.z += 0.005 if step < UPDATES // 2 else -0.005
        assert session.update()
        bpy.context.view_layer.update()
        seconds.append(time.perf_counter() - began)
    return 1.0 / statistics.median(seconds)


def main() -> None:
    addon_utils.enable("reachcast")
    try:
        speeds = {rig: updates_per_second(rig) for rig in ("mannequin", "metarig")}
    except unittest.SkipTest as reason:
        print(f"skipped: {reason}")
        return
    live = live_per_second()
    print(f"live, mannequin: {live:.0f} updates a second in the median", flush=True)
    for rig, (median, least) in speeds.items():
        print(f"hand path, {rig}: {median:.0f} updates a second in the median, {least:.0f} at the slowest", flush=True)
    if min(live, speeds["mannequin"][0]) < LEAST_PER_S:
        sys.exit(f"the mannequin must follow {LEAST_PER_S:g} times a second")


if __name__ == "__main__":
    main()
