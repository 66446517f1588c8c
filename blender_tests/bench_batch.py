# SPDX-License-Identifier: GPL-3.0-or-later
"""Motions a second that one process of a batch makes, as CSV and as Actions, with the share of each step; beside them
`nla.bake` of an IK setup that does the same tasks.

    blender -b --factory-startup --python-exit-code 1 --python blender_tests/bench_batch.py -- [TASKS]

"a second of one core" counts the time that this process was computing, whatever else the machine does meanwhile.
"""
from __future__ import annotations

import json
import resource
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Any
from unittest import mock

import addon_utils
import bpy

HERE = Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path[:0] = [str(HERE.parent / "addon"), str(HERE)]
addon_utils.enable("reachcast")

from bench_bake import IK, add_ik, bake, bone_tails  # noqa: E402
from reachcast.batch import run, unit_work  # noqa: E402
from reachcast.batch.stage import Stage, add_mannequin  # noqa: E402
from reachcast.batch.store import Store  # noqa: E402
from reachcast.batch.tasks import Unit  # noqa: E402
from reachcast.scene import prepare  # noqa: E402

TASKS = 1000
PEOPLE = 8
BAKED = 5        #: tasks that are also baked
WANTED = 200.0   #: motions a second of one core that is not shared
#: Step by step: where its function is looked up, and the function.
STEPS = (("rows and checksums", run, "read_table"), ("rows and checksums", Unit, "checksum"),
         ("scene", Stage, "prepared"), ("predict", prepare, "_predict"), ("onto the rig", unit_work, "solve"),
         ("files", unit_work, "write_outputs"), ("folders and renames", Store, "draft"),
         ("folders and renames", Store, "finish"), ("what is done, results.csv", Store, "result"),
         ("what is done, results.csv", Store, "write_results"))


def rows(count: int, outputs: str) -> list[dict[str, object]]:
    return [{"id": f"t{number:05d}", "stature": 1.5 + 0.05 * (number * PEOPLE // count), "home": "0 0.42 0.1",
             "target": f"{0.3 * (number % 17) / 17:.4f} 0.45 {0.7 + 0.6 * (number % 31) / 31:.4f}", "outputs": outputs}
            for number in range(count)]


def counted(step: str, function: Callable[..., Any], seconds: Counter[str], inside: list[float]) -> Callable[..., Any]:
    """`function`, whose own time, without that of other steps in it, is added to `seconds`."""
    def call(*arguments: Any, **options: Any) -> Any:
        began = time.process_time()
        inside.append(0.0)
        try:
            return function(*arguments, **options)
        finally:
            spent = time.process_time() - began
            seconds[step] += spent - inside.pop()
            if inside:
                inside[-1] += spent
    return call


def run_rows(folder: Path, count: int, outputs: str) -> tuple[float, float]:
    """Wall and computing seconds of a batch; ends everything when a task is not done."""
    table = folder / "tasks.jsonl"
    table.write_text("".join(json.dumps(row) + "\n" for row in rows(count, outputs)))
    began, worked = time.perf_counter(), time.process_time()
    found = run.run_batch(table, folder / outputs, say=lambda _: None)
    if found.counts != {"done": count}:
        sys.exit(f"bench_batch: {found.counts}")
    return time.perf_counter() - began, time.process_time() - worked


def measure(count: int, outputs: str) -> float:
    """Prints the rate and the shares; returns motions a second of one core."""
    with tempfile.TemporaryDirectory() as name:
        run_rows(Path(name), 2 * PEOPLE, outputs)  # corpus and Blender's own modules are loaded
    seconds: Counter[str] = Counter()
    inside: list[float] = []
    with tempfile.TemporaryDirectory() as name, ExitStack() as patches:
        wall, worked = run_rows(Path(name), count, outputs)
        (Path(name) / outputs).rename(Path(name) / "first")
        for step, owner, function in STEPS:
            patches.enter_context(mock.patch.object(
                owner, function, counted(step, getattr(owner, function), seconds, inside)))
        _, traced = run_rows(Path(name), count, outputs)
    rate = count / worked
    print(f"{outputs}: {rate:.0f} motions a second of one core (wanted {WANTED:.0f}), {count / wall:.0f} a second now; "
          f"{count} tasks of {PEOPLE} people, {memory_mb():.0f} MB")
    seconds["all else"] = traced - sum(seconds.values())
    for step, spent in seconds.most_common():
        print(f"  {step:26} {100 * spent / traced:5.1f} %")
    return rate


def bakes_a_second() -> float:
    """nla.bake of the first tasks, hands and feet on IK targets, of one core; the motions themselves are not counted."""
    spent = 0.0
    with tempfile.TemporaryDirectory() as name:
        run_rows(Path(name), BAKED, "action")
        for row in rows(BAKED, "action"):
            rig = add_mannequin(float(row["stature"]), None, dressed=False)  # type: ignore[arg-type]
            path = Path(name) / "action" / "tasks" / str(row["id"]) / "action.blend"
            with bpy.data.libraries.load(str(path)) as (there, here):
                here.actions = [action for action in there.actions if action.startswith("Worker")]
            action = here.actions[0]
            rig.animation_data_create().action = action
            if hasattr(action, "slots"):
                rig.animation_data.action_slot = action.slots[0]
            frames = range(1, int(action.frame_range[1]) + 1)
            add_ik(rig, bone_tails(rig, list(IK), frames), frames)
            bpy.context.view_layer.objects.active = rig
            bpy.ops.object.mode_set(mode="POSE")
            began = time.process_time()
            bake(rig, frames)
            spent += time.process_time() - began
            bpy.ops.object.mode_set(mode="OBJECT")
            bpy.data.batch_remove([rig, *(item for item in bpy.data.objects if item.name.startswith("target"))])
    return BAKED / spent


def additions_s() -> float:
    """How fast this core is while others use the machine: ten million additions in Python."""
    began, total = time.process_time(), 0
    for number in range(10_000_000):
        total += number
    return time.process_time() - began


def memory_mb() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


def main(count: int) -> None:
    bpy.ops.wm.read_homefile(use_empty=True)
    addon_utils.enable("reachcast")
    print(f"ten million additions in Python take {additions_s():.2f} s of this core")
    rates = {outputs: measure(count, outputs) for outputs in ("csv", "action")}
    baked = bakes_a_second()
    print(f"nla.bake of an IK setup: {baked:.2f} a second of one core; ratio {rates['action'] / baked:.0f} to Actions, "
          f"{rates['csv'] / baked:.0f} to CSV", flush=True)


if __name__ == "__main__":
    given = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    main(int(given[0]) if given else TASKS)
