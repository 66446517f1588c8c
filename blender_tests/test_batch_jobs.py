# SPDX-License-Identifier: GPL-3.0-or-later
"""Several processes of one batch: what they make is what one makes, also when some of them are killed."""
from __future__ import annotations

import contextlib
import hashlib
import json
import os
import shutil
import signal
import tempfile
import threading
import time
import unittest
from collections.abc import Callable, Iterator
from pathlib import Path
from unittest import mock

import bpy
import numpy as np
from lift_cases import cuboid
from reachcast.batch import unit_work
from reachcast.batch.jobs import MOST_TRIES, JobsFailed
from reachcast.batch.run import BatchResult, collect_batch, run_batch
from reachcast.scene.action_writer import curves_of

NORMALS = 1e-6   #: Blender's threads add up the normals of a mesh in no fixed order
HOME = "0 0.42 0.1"
ROWS = [{"id": f"r{number}", "stature": 1.6 + 0.1 * (number % 2), "home": HOME, "outputs": "csv bvh",
         "target": f"{0.005 * number:g} 0.45 0.9"} for number in range(40)]


def checksums(out: Path) -> dict[str, str]:
    """Of every file below `out`, by its path there."""
    return {os.fspath(path.relative_to(out)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(out.rglob("*")) if path.is_file()}


def glb_of(path: Path) -> tuple[bytes, np.ndarray]:
    """What a glTF file says, and its numbers."""
    data = path.read_bytes()
    begin = 20 + int.from_bytes(data[12:16], "little")
    return data[:begin], np.frombuffer(data[begin + 8:], "<f4")


def labels_of(action: bpy.types.Action) -> list[tuple[str, object]]:
    """Custom properties, by name; arrays as lists, which can be compared."""
    return sorted((name, value.to_list() if hasattr(value, "to_list") else value) for name, value in action.items())


def keys_of(path: Path) -> dict[str, object]:
    """All that a file's Actions say: labels, channels, keys."""
    with bpy.data.libraries.load(os.fspath(path)) as (there, here):
        here.actions = list(there.actions)
    said = {action.name: (labels_of(action), [(curve.data_path, curve.array_index, curve.group.name, [
        (*point.co, point.interpolation) for point in curve.keyframe_points]) for curve in curves_of(action)])
        for action in here.actions}
    bpy.data.batch_remove(here.actions)
    return said


@contextlib.contextmanager
def killing(out: Path, is_due: Callable[[Path, int], bool]) -> Iterator[list[int]]:
    """kill -9 for every worker that `is_due` by its folder of drafts and how many were killed; the list is who was."""
    killed: list[int] = []
    ended = threading.Event()

    def watch() -> None:
        while not ended.is_set():
            for folder in (out / "drafts").glob("*"):
                process = int(folder.name.rpartition("-")[2])
                if process != os.getpid() and process not in killed and is_due(folder, len(killed)):
                    with contextlib.suppress(ProcessLookupError):
                        os.kill(process, signal.SIGKILL)
                    killed.append(process)
            time.sleep(0.002)

    thread = threading.Thread(target=watch)
    thread.start()
    try:
        yield killed
    finally:
        ended.set()
        thread.join()


class Jobs(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="reachcast-jobs-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.out, self.said = self.folder / "out", []

    def run_rows(self, rows: list[dict[str, object]], out: Path | None = None, **options: object) -> BatchResult:
        table = self.folder / "tasks.jsonl"
        table.write_text("".join(json.dumps(row) + "\n" for row in rows))
        return run_batch(table, out or self.out, say=self.said.append, **options)

    def finished(self) -> int:
        return len(os.listdir(self.out / "tasks"))

    def test_two_processes_make_what_one_makes(self) -> None:
        cuboid("Shelf", (0.3, 0.3, 0.02)).location = (0.1, 0.45, 1.0)  # not in any file: the workers get this scene
        rows = [*ROWS, {"id": "named", "home": HOME, "target": "Shelf"}, {"id": "far", "target": "0 3 1"},
                *({**ROWS[0], "id": f"a{number}", "stature": 1.6 + 0.1 * number, "outputs": "action gltf"}
                  for number in range(3))]
        self.run_rows(rows, self.folder / "one")
        found = self.run_rows(rows, jobs=2)
        self.assertEqual((found.counts, found.worked, found.lost), ({"done": 44, "refused": 1}, 45, 0))
        self.assertRegex(self.said[-1], r"^45 of 45, [\d.]+ a second, 0 s left$")
        one, other = checksums(self.folder / "one"), checksums(self.out)
        for name in [name for name in one if name.endswith(".blend")]:  # a .blend has addresses of memory in it
            self.assertEqual(keys_of(self.folder / "one" / name), keys_of(self.out / name))
            del one[name], other[name]
        for name in [name for name in one if name.endswith(".glb")]:
            said, numbers = glb_of(self.folder / "one" / name)
            self.assertEqual(glb_of(self.out / name)[0], said)
            np.testing.assert_allclose(glb_of(self.out / name)[1], numbers, atol=NORMALS)
            del one[name], other[name]
        self.assertEqual(other, one)

    def test_killed_processes_leave_their_motions_to_others(self) -> None:
        self.run_rows(ROWS, self.folder / "one")
        with killing(self.out, lambda _, dead: dead < 3 and self.finished() >= 5 + 10 * dead) as killed:
            found = self.run_rows(ROWS, jobs=2)
        self.assertGreaterEqual(len(killed), 2)
        self.assertGreaterEqual(found.lost, 2)
        self.assertTrue(any("signal 9" in line for line in self.said), self.said)
        self.assertEqual(checksums(self.out), checksums(self.folder / "one"))

    def test_a_motion_that_kills_its_process_fails_alone_after_three_tries(self) -> None:
        rows = [{**ROWS[0], "id": "deadly", "outputs": "csv gltf"}, *ROWS[1:6]]
        with killing(self.out, lambda folder, _: (folder / "deadly").exists()) as killed:
            found = self.run_rows(rows, jobs=2)
        self.assertEqual((found.counts, found.lost, len(killed)), ({"failed": 1, "done": 5}, MOST_TRIES, MOST_TRIES))
        self.assertIn("ended with signal 9, 3 times", (self.out / "results.csv").read_text())
        self.assertFalse((self.out / "drafts").exists())
        self.assertEqual(self.run_rows(rows).counts, {"done": 6})  # what went wrong unexpectedly is tried again

    def test_what_a_worker_cannot_use_ends_the_run(self) -> None:
        corpus = self.folder / "no corpus.sqlite"
        corpus.write_bytes(b"nothing")
        with self.assertRaisesRegex((ValueError, RuntimeError), "no corpus.sqlite"):
            self.run_rows(ROWS[:4], jobs=2, corpus=corpus)
        with self.assertRaisesRegex(ValueError, "number of jobs is 0"):
            self.run_rows(ROWS, jobs=0)
        with mock.patch("reachcast.batch.jobs._command", return_value=["sh", "-c", "echo no display >&2; exit 3"]), \
                self.assertRaisesRegex(JobsFailed, "exit status 3.*no display"):
            self.run_rows(ROWS, jobs=2)

    def test_a_process_that_does_not_listen_is_no_end_of_this_one(self) -> None:
        deaf = "exec <&-; echo; echo reachcast-batch-worker; exit 4"
        with mock.patch("reachcast.batch.jobs._command", return_value=["sh", "-c", deaf]), \
                self.assertRaisesRegex(JobsFailed, "exit status 4"):
            self.run_rows(ROWS, jobs=2)

    def test_collecting_makes_nothing_and_says_what_is_missing_or_out_of_date(self) -> None:
        self.assertEqual(self.run_rows(ROWS[:4], part=(1, 2), collect=False).counts, {"done": 2})
        self.assertFalse((self.out / "results.csv").exists())
        table = self.folder / "tasks.jsonl"
        table.write_text("".join(json.dumps(row) + "\n" for row in ({**ROWS[0], "load": 3}, *ROWS[1:4])))
        self.assertEqual(collect_batch(table, self.out), {"missing": 3, "done": 1})
        self.assertIn("what is there is of another row", (self.out / "results.csv").read_text())
        self.assertEqual(self.finished(), 2)
        self.assertEqual(run_batch(table, self.out, say=self.said.append).counts, {"done": 4})

    def test_whatever_a_task_raises_it_fails_alone(self) -> None:
        write = unit_work.write_outputs
        for error in (KeyError("left"), MemoryError(), ZeroDivisionError("by zero"), RuntimeError("Error: no")):
            def raising(asked, folder, error=error):  # type: ignore[no-untyped-def]
                if asked.unit.id == "r1":
                    (folder / "half").write_text("half")
                    raise error
                return write(asked, folder)
            with self.subTest(error=repr(error)), mock.patch.object(unit_work, "write_outputs", raising):
                self.assertEqual(self.run_rows(ROWS[:3]).counts, {"done": 2, "failed": 1})
                reason = json.loads((self.out / "tasks" / "r1" / "result.json").read_text())["reason"]
                self.assertIn("no" if isinstance(error, RuntimeError) else type(error).__name__, reason)
                self.assertEqual(os.listdir(self.out / "tasks" / "r1"), ["result.json"])


if __name__ == "__main__":
    unittest.main()
