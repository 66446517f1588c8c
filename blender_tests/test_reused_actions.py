# SPDX-License-Identifier: GPL-3.0-or-later
"""An Action that holds one motion after another is at any time the one that would have been made for it."""
from __future__ import annotations

import os
import shutil
import tempfile
import unittest
from pathlib import Path

import bpy
import numpy as np
from reachcast.batch.run import run_batch
from reachcast.scene.action_writer import Channel, curves_of, write_action
from reachcast.scene.reused_actions import ReusedActions

STYLES = ("interpolation", "handle_left_type", "handle_right_type", "easing", "type")
NUMBERS = (("co", 2), ("handle_left", 2), ("handle_right", 2), ("back", 1), ("amplitude", 1), ("period", 1))


def channels_of(seed: int, frames: int) -> list[Channel]:
    """Columns that change and ones that do not, and steps."""
    draw = np.random.default_rng(seed)
    moving, still = draw.normal(size=(frames, 4)), np.ones((frames, 3))
    mixed = np.concatenate([moving[:, :2], still[:, :1]] if seed % 2 else [still[:, :2], moving[:, :1]], axis=1)
    steps = (0, 3, 5, 9)[:2 + seed % 3]
    return [Channel("rotation_quaternion", moving, "Turns"), Channel("scale", still, "Turns"),
            Channel("location", mixed, "Places"), Channel('["held"]', draw.normal(size=(len(steps), 1)), "Held", steps)]


def contents(action: bpy.types.Action) -> list[object]:
    """All that is in it but what it is called."""
    found: list[object] = [{key: value.to_list() if hasattr(value, "to_list") else value for key, value in action.items()}]
    found.append(getattr(action, "id_root", None))
    for curve in curves_of(action):
        points = curve.keyframe_points
        found.append((curve.data_path, curve.array_index, curve.group.name, curve.extrapolation))
        found.append([[getattr(key, style) for style in STYLES] for key in points])
        for name, width in NUMBERS:
            values = np.empty(width * len(points), np.float32)
            points.foreach_get(name, values)
            found.append(values.tolist())
    return found


def what_it_says(path: Path) -> bytes:
    """Of a glTF file, without its numbers: Blender adds up normals in no fixed order."""
    data = path.read_bytes()
    return data[20:20 + int.from_bytes(data[12:16], "little")]


class Reused(unittest.TestCase):
    def setUp(self) -> None:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        self.owner = bpy.data.objects.new("Owner", None)
        bpy.context.scene.collection.objects.link(self.owner)
        self.actions = ReusedActions()

    def test_it_is_as_a_new_one_would_be(self) -> None:
        for seed, frames in enumerate((40, 40, 55, 12, 12, 70)):
            with self.subTest(seed=seed):
                action = self.actions.write(self.owner, f"motion {seed}", channels_of(seed, frames), 1 + seed)
                made = write_action(self.owner, "new", channels_of(seed, frames), 1 + seed)
                self.assertTrue(contents(action) == contents(made))  # a difference would be too long to print
                self.assertEqual(action.name, f"motion {seed}")
                self.assertEqual(tuple(action.frame_range), tuple(made.frame_range))
                if hasattr(action, "slots"):
                    self.assertEqual(*[[slot.identifier for slot in each.slots] for each in (action, made)])
                action["left over"] = seed
                bpy.data.actions.remove(made)
                self.assertEqual(len(bpy.data.actions), 1)

    def test_other_channels_take_the_place_of_the_old_ones(self) -> None:
        self.actions.write(self.owner, "first", channels_of(0, 20), 1)
        action = self.actions.write(self.owner, "second", channels_of(0, 20)[:2], 1)
        self.assertEqual([each.name for each in bpy.data.actions], ["second"])
        self.assertEqual({curve.data_path for curve in curves_of(action)}, {"rotation_quaternion", "scale"})

    def test_nothing_is_left_behind(self) -> None:
        self.actions.write(self.owner, "motion", channels_of(0, 20), 1)
        self.actions.forget(self.owner)
        self.assertFalse(bpy.data.actions)
        self.actions.write(self.owner, "motion", channels_of(1, 20), 1)
        self.actions.close()
        self.assertFalse(bpy.data.actions)


class InABatch(unittest.TestCase):
    def test_no_task_sees_which_ones_came_before(self) -> None:
        """Other phases, another person and a task with glTF, whose Actions are made anew, before the same task."""
        bpy.ops.wm.read_factory_settings(use_empty=True)
        folder = Path(tempfile.mkdtemp(prefix="reachcast-reused-"))
        self.addCleanup(shutil.rmtree, folder, ignore_errors=True)
        task = "{},{},0 0.42 0.1,0.2 0.45 {},{},{}\n"
        last = task.format("last", 1.7, 1.0, "transfer", "action")
        before = [task.format("a", 1.7, 0.8, "reach transfer return", "action"), task.format("b", 1.6, 0.9, "", "action"),
                  task.format("c", 1.7, 1.1, "transfer", "action"), task.format("d", 1.7, 1.0, "transfer", "action gltf")]
        head = "id,stature,home,target,phases,outputs\n"
        for name, rows in (("alone", [last]), ("after", [*before, last]), ("glTF", before[-1:])):
            (folder / f"{name}.csv").write_text(head + "".join(rows))
            run_batch(folder / f"{name}.csv", folder / name, say=lambda _: None)
            self.assertFalse(bpy.data.actions)
        alone, after, anew = (self.saved(folder / path / "action.blend") for path in (
            "alone/tasks/last", "after/tasks/last", "after/tasks/d"))
        self.assertTrue(alone == after)
        one, other = (what_it_says(folder / path / "tasks" / "d" / "motion.glb") for path in ("after", "glTF"))
        self.assertTrue(one == other)
        self.assertTrue([found for _, found in sorted(alone.items())] == [found for _, found in sorted(anew.items())])

    def saved(self, path: Path) -> dict[str, list[object]]:
        with bpy.data.libraries.load(os.fspath(path)) as (there, here):
            here.actions = there.actions
        found = {action.name: contents(action) for action in here.actions}
        bpy.data.batch_remove(here.actions)
        return found


if __name__ == "__main__":
    unittest.main()
