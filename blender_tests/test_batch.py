# SPDX-License-Identifier: GPL-3.0-or-later
"""Batches: what a row asks for is what is written; rows fail alone; nothing that is finished is lost or done twice."""
from __future__ import annotations

import csv
import json
import math
import os
import random
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from collections import namedtuple
from pathlib import Path
from unittest import mock

import bpy
import numpy as np
from lift_cases import cuboid
from reachcast import native
from reachcast.batch.run import run_batch
from reachcast.batch.stage import add_mannequin
from reachcast.batch.store import DiskFull
from reachcast.rigs.joints import INDEX, JOINTS
from reachcast.scene.measure import sample
from reachcast.scene.read_rig import read_rig

PROJECT = Path(__file__).resolve().parent.parent
HOME, TARGET = "0 0.42 0.1", "0.2 0.45 1.0"
CSV_M = 1e-5          #: five decimals
BVH_M = 1e-4          #: six decimals of degrees and metres, over a chain of bones; single precision is not involved
PROMISED_M = 1e-3


class Batch(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="reachcast-batch-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.out = self.folder / "out"
        self.table = self.folder / "tasks.jsonl"

    def run_rows(self, *rows: object, **options: object):  # type: ignore[no-untyped-def]
        self.table.write_text("".join((row if isinstance(row, str) else json.dumps(row)) + "\n" for row in rows))
        return run_batch(self.table, self.out, say=lambda _: None, **options)

    def results(self) -> list[dict[str, str]]:
        with (self.out / "results.csv").open(newline="") as file:
            return list(csv.DictReader(file))


class Rows(Batch):
    def test_bad_rows_fail_alone_with_their_reason(self) -> None:
        self.run_rows({"id": "good", "home": HOME, "target": TARGET}, {"id": "high", "target": "0 0.4 3.5"},
                      {"id": "../up", "target": TARGET}, {"id": "tall", "target": TARGET, "stature": "nan"},
                      {"id": "good", "target": TARGET}, {"id": "what", "target": TARGET, "colour": "red"},
                      "{broken", {"id": "nowhere"}, {"id": "absent", "target": "Shelf 9"},
                      {"id": "late", "target": TARGET, "outputs": "movie"}, {"id": "last", "target": [0.1, 0.4, 1.0]})
        found = {row["id"]: (row["status"], row["reason"]) for row in self.results() if row["id"] != "good"}
        self.assertEqual([row["status"] for row in self.results() if row["id"] == "good"], ["done", "bad row"])
        self.assertEqual(found["last"], ("done", ""))
        for name, status, word in (("high", "refused", "reach"), ("../up", "bad row", "letters"),
                                   ("tall", "bad row", "stature is 'nan'"), ("what", "bad row", "colour"),
                                   ("row-00007", "bad row", "row 7"), ("nowhere", "bad row", "target is empty"),
                                   ("absent", "refused", "'Shelf 9'"), ("late", "bad row", "'movie'")):
            with self.subTest(row=name):
                self.assertEqual(found[name][0], status)
                self.assertIn(word, found[name][1])
        self.assertEqual(sorted(os.listdir(self.out)), ["index.html", "results.csv", "tasks"])
        self.assertEqual(os.listdir(self.out / "tasks" / "high"), ["result.json"])

    def test_a_table_that_is_none_is_refused(self) -> None:
        for name, text, words in (("a.txt", "x", "must end in"), ("a.csv", "id,target\n", "no rows"),
                                  ("a.jsonl", b"\xff\xfe", "cannot be read")):
            path = self.folder / name
            path.write_bytes(text if isinstance(text, bytes) else text.encode())
            with self.assertRaisesRegex(ValueError, words):
                run_batch(path, self.out)

    def test_csv_and_json_lines_say_the_same(self) -> None:
        self.run_rows({"id": "one", "stature": 1.6, "home": HOME, "target": TARGET, "load": 3, "outputs": "csv"})
        first = self.results()
        table = self.folder / "tasks.csv"
        table.write_text(f"id,stature,home,target,load,sex\none,1.6,{HOME},{TARGET},3,\n")
        self.assertEqual(run_batch(table, self.out, say=lambda _: None).worked, 0)
        self.assertEqual(self.results(), first)

    def test_variants_follow_their_seeds(self) -> None:
        row = {"id": "v", "home": HOME, "target": TARGET, "variants": 2, "seed": 5}
        self.run_rows(row)
        drawn = {name: (self.out / "tasks" / name / "joints.csv").read_bytes() for name in ("v_seed5", "v_seed6")}
        self.assertNotEqual(*drawn.values())
        shutil.rmtree(self.out)
        self.run_rows({**row, "seed": 6, "variants": 1})
        self.assertEqual((self.out / "tasks" / "v_seed6" / "joints.csv").read_bytes(), drawn["v_seed6"])

    def test_objects_of_the_scene_take_part(self) -> None:
        rig, box = add_mannequin(1.7, None), cuboid("Carton", (0.36, 0.28, 0.24))
        rig.name, box.location = "Anna", (0.0, 0.42, 0.1)
        bpy.context.view_layer.update()
        self.run_rows({"id": "a", "rig": "Anna", "object": "Carton", "target": TARGET},
                      {"id": "b", "stature": 1.7, "object": "0.36x0.28x0.24", "home": [0, 0.42, 0.1, 0], "target": TARGET})
        one, other = (self.clip(name).positions for name in "ab")
        np.testing.assert_allclose(one, other, atol=2 * CSV_M)

    def test_a_mesh_that_lies_on_its_side_starts_where_it_lies(self) -> None:
        box = cuboid("Chest", (0.36, 0.24, 0.28))
        box.rotation_euler.x = math.radians(90.0)  # what was its height now points to the worker
        box.location = (0.0, 0.42 + 0.14, 0.1 + 0.12)
        bpy.context.view_layer.update()
        self.run_rows({"id": "a", "stature": 1.7, "object": "Chest", "target": TARGET},
                      {"id": "b", "stature": 1.7, "object": "0.36x0.28x0.24", "home": [0, 0.42, 0.1, 0], "target": TARGET})
        one, other = (self.clip(name).positions for name in "ab")
        np.testing.assert_allclose(one, other, atol=2 * CSV_M)

    def clip(self, name: str):  # type: ignore[no-untyped-def]
        return native.core().read_motion(os.fspath(self.out / "tasks" / name / "joints.csv"))


class Outputs(Batch):
    def test_files_hold_the_same_motion(self) -> None:
        self.run_rows({"id": "all", "stature": 1.7, "home": HOME, "target": TARGET, "phases": "reach transfer return",
                       "outputs": ["action", "csv", "bvh", "gltf"]})
        row, folder = self.results()[0], self.out / "tasks" / "all"
        self.assertEqual((row["status"], row["files"]), ("done", "joints.csv motion.bvh action.blend motion.glb"))
        self.assertFalse(bpy.data.actions)
        core = native.core()
        table = core.read_motion(os.fspath(folder / "joints.csv"))
        self.assertEqual(tuple(table.names), JOINTS)
        joints = np.asarray(table.positions)
        self.check_bvh(core.read_motion(os.fspath(folder / "motion.bvh")), joints)
        self.check_action(folder / "action.blend", joints)
        self.check_gltf(folder / "motion.glb", float(row["duration_s"]))

    def check_bvh(self, clip, joints) -> None:  # type: ignore[no-untyped-def]
        names = list(clip.names)
        for bone, joint in (("spine", "l5s1"), ("neck", "c7t1"), ("upper_arm.L", "left_shoulder"),
                            ("hand.R", "right_wrist"), ("shin.L", "left_knee"), ("foot.R", "right_ankle")):
            read = np.asarray(clip.positions)[:, names.index(bone)]
            self.assertLess(np.abs(read - joints[:, INDEX[joint]]).max(), BVH_M, bone)

    def check_action(self, path: Path, joints) -> None:  # type: ignore[no-untyped-def]
        rig = add_mannequin(1.7, None)
        with bpy.data.libraries.load(os.fspath(path)) as (there, here):
            here.actions = [name for name in there.actions if name.startswith("Worker")]
        rig.animation_data_create().action = here.actions[0]
        if hasattr(here.actions[0], "slots"):
            rig.animation_data.action_slot = here.actions[0].slots[0]
        shown = sample(rig, read_rig(rig), range(1, len(joints) + 1))
        self.assertLess(np.linalg.norm(shown.joints - joints, axis=2).max(), PROMISED_M)

    def check_gltf(self, path: Path, seconds: float) -> None:
        data = path.read_bytes()
        self.assertEqual(data[:4], b"glTF")
        said = json.loads(data[20:20 + int.from_bytes(data[12:16], "little")])
        ends = [said["accessors"][sampler["input"]]["max"][0] for animation in said["animations"]
                for sampler in animation["samplers"]]
        self.assertAlmostEqual(max(ends) - min(said["accessors"][sampler["input"]]["min"][0] for animation in
                                               said["animations"] for sampler in animation["samplers"]),
                               seconds, delta=0.05)


class Resuming(Batch):
    ROWS = tuple({"id": f"r{number}", "home": HOME, "target": f"{0.05 * number:g} 0.45 0.9"} for number in range(4))

    def test_a_second_start_does_what_is_not_done_or_has_changed(self) -> None:
        self.assertEqual(self.run_rows(*self.ROWS).worked, 4)
        whole = (self.out / "results.csv").read_bytes()
        self.assertEqual(self.run_rows(*self.ROWS).worked, 0)
        shutil.rmtree(self.out / "tasks" / "r1")
        (self.out / "tasks" / "r2" / "result.json").write_text("{")
        self.assertEqual(self.run_rows(*self.ROWS).worked, 2)
        self.assertEqual((self.out / "results.csv").read_bytes(), whole)
        self.assertEqual(self.run_rows({**self.ROWS[0], "target": "0 0.45 1.1"}, *self.ROWS[1:]).worked, 1)

    def test_parts_together_are_the_whole(self) -> None:
        self.run_rows(*self.ROWS)
        whole = (self.out / "results.csv").read_bytes()
        shutil.rmtree(self.out)
        done = [self.run_rows(*self.ROWS, part=(number, 3), collect=False).worked for number in (1, 2, 3)]
        self.assertEqual(sum(done), 4)
        self.assertEqual(self.run_rows(*self.ROWS).worked, 0)
        self.assertEqual((self.out / "results.csv").read_bytes(), whole)

    def test_a_full_disk_stops_the_run_and_leaves_no_half_task(self) -> None:
        usage = namedtuple("usage", "total used free")
        with mock.patch("shutil.disk_usage", return_value=usage(10, 10, 0)), self.assertRaisesRegex(DiskFull, "full"):
            self.run_rows(*self.ROWS)
        self.assertEqual(os.listdir(self.out / "tasks"), [])
        self.assertFalse((self.out / "drafts").exists())
        self.assertEqual(self.run_rows(*self.ROWS).worked, 4)

    def test_killed_runs_lose_nothing(self) -> None:
        """kill -9 at random moments; then one run to the end is as one that was never killed."""
        rows = [{"id": f"k{number}", "home": HOME, "target": f"{0.001 * number:g} 0.45 0.9"} for number in range(120)]
        self.run_rows(*rows)
        whole = (self.out / "results.csv").read_bytes()
        files = {item.name: (item / "joints.csv").read_bytes() for item in (self.out / "tasks").iterdir()}
        shutil.rmtree(self.out)
        draw, finished = random.Random(7), 0
        for _ in range(2):
            process = subprocess.Popen(
                ["blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python",
                 PROJECT / "examples" / "batch.py", "--", self.table, "--out", self.out],
                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
            while process.poll() is None and self.finished() <= finished:
                time.sleep(0.005)
            time.sleep(draw.uniform(0.0, 0.08))
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            finished = self.finished()
            for item in (self.out / "tasks").iterdir():
                self.assertEqual((item / "joints.csv").read_bytes(), files[item.name])
        self.assertEqual(self.run_rows(*rows).worked, len(rows) - finished)
        self.assertEqual((self.out / "results.csv").read_bytes(), whole)
        self.assertFalse((self.out / "drafts").exists())

    def finished(self) -> int:
        return len(os.listdir(self.out / "tasks")) if (self.out / "tasks").exists() else 0


if __name__ == "__main__":
    unittest.main()
