# SPDX-License-Identifier: GPL-3.0-or-later
"""A batch on a disk that is really full, killed again and again, and long: nothing is lost and nothing grows."""
from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parent.parent
BATCH = ("blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python", PROJECT / "examples" / "batch.py",
         "--")
KILLS = int(os.environ.get("REACHCAST_KILLS", "3"))
TASKS = int(os.environ.get("REACHCAST_TASKS", "1500"))   #: of the test of memory; 10000 is what is promised
MEASURED_AFTER = 1000 if TASKS > 1000 else TASKS // 2    #: tasks, once everything is loaded
MOST_GROWTH_KB = 4096                                    #: an allocator's page here and there
SMALL_DISK_KB = 900


def write_table(path: Path, count: int, **more: object) -> Path:
    with path.open("w") as file:
        for number in range(count):
            file.write(json.dumps({"id": f"t{number:05d}", "stature": 1.6 + 0.1 * (number % 3), "home": "0 0.42 0.1",
                                   "target": f"{0.3 * number / count:.5f} 0.45 {0.8 + 0.01 * (number % 40):g}", **more})
                       + "\n")
    return path


def batch(table: Path, out: Path, *more: object, prefix: tuple[str, ...] = ()) -> subprocess.CompletedProcess[str]:
    return subprocess.run([*prefix, *map(str, (*BATCH, table, "--out", out, *more))], capture_output=True, text=True,
                          check=False)


def contents(out: Path) -> dict[str, bytes]:
    return {os.fspath(path.relative_to(out)): path.read_bytes() for path in sorted(out.rglob("*")) if path.is_file()}


def made_now(done: subprocess.CompletedProcess[str]) -> int:
    return int(done.stdout.split(" made now")[0].split("; ")[-1])


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[tuple[str, ...]]:
    """The beginning of a command line that runs with a small disk at tmp_path/disk, which goes with it."""
    disk = tmp_path / "disk"
    disk.mkdir()
    prefix = ("unshare", "--mount", "sh", "-c",
              f'mount -t tmpfs -o size={SMALL_DISK_KB}k none "{disk}" && exec "$@"', "sh")
    if subprocess.run([*prefix, "true"], capture_output=True, check=False).returncode:
        pytest.skip("mounting a small disk needs root")
    yield prefix


@pytest.mark.parametrize("outputs", ["csv bvh", "action"])
def test_a_full_disk_stops_the_run_and_a_start_with_room_completes_it(small_disk: tuple[str, ...], tmp_path: Path,
                                                                      outputs: str) -> None:
    table = write_table(tmp_path / "tasks.jsonl", 40, outputs=outputs)
    whole, kept = tmp_path / "whole", tmp_path / "kept"
    assert batch(table, whole).returncode == 0
    script = f'"$@"; status=$?; cp -r "{tmp_path}/disk/out" "{kept}"; exit $status'
    done = batch(table, tmp_path / "disk" / "out", prefix=(*small_disk, "sh", "-c", script, "sh"))
    assert done.returncode == 2
    assert "is full" in done.stderr and "what was finished is kept" in done.stderr and "Traceback" not in done.stderr
    finished = sorted(os.listdir(kept / "tasks"))
    assert 0 < len(finished) < 40 and not (kept / "drafts").exists()
    expected = contents(whole)
    same = [name for name in contents(kept) if not name.endswith(".blend")]  # a .blend has addresses of memory in it
    assert all(expected[name] == (kept / name).read_bytes() for name in same)
    again = batch(table, kept)
    assert (again.returncode, made_now(again)) == (0, 40 - len(finished))
    found = contents(kept)
    assert found.keys() == expected.keys()
    assert all(found[name] == expected[name] for name in found if not name.endswith(".blend"))


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_run_that_is_killed_again_and_again_comes_to_the_same_end(tmp_path: Path, jobs: int) -> None:
    """kill -9 of all its processes, or of the first alone, at random moments: while Blender starts, between tasks,
    inside a task, at the end."""
    table = write_table(tmp_path / "tasks.jsonl", 200, outputs="csv")
    whole, out = tmp_path / "whole", tmp_path / "out"
    assert batch(table, whole).returncode == 0
    expected, draw = contents(whole), random.Random(jobs)
    before, groups = 0, set()
    for kill in range(KILLS):
        process = subprocess.Popen([*map(str, (*BATCH, table, "--out", out, "--jobs", jobs))], start_new_session=True,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        if kill % 3:  # else while it starts
            while process.poll() is None and finished(out) <= before:
                time.sleep(0.002)
        time.sleep(draw.uniform(0.0, 0.3))
        if jobs > 1 and kill % 2:
            process.kill()  # the next start meets workers that come to the end of what they do
        else:
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        groups.add(process.pid)
        before = finished(out)
        assert all(expected[name] == data for name, data in contents(out).items() if name.startswith("tasks"))
    for group in groups:
        wait_for_end(group)
    before = finished(out)
    last = batch(table, out, "--jobs", jobs)
    assert (last.returncode, made_now(last)) == (0, 200 - before)
    assert contents(out) == expected
    assert not (out / "drafts").exists()


def wait_for_end(group: int) -> None:
    """Of all processes of a group."""
    ends = time.monotonic() + 60.0
    while time.monotonic() < ends:
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return
        time.sleep(0.05)
    raise TimeoutError(f"Processes of group {group} are still there 60 s after the first was killed")


def finished(out: Path) -> int:
    return len(os.listdir(out / "tasks")) if (out / "tasks").exists() else 0


def test_only_a_changed_row_is_done_again(tmp_path: Path) -> None:
    table, out = write_table(tmp_path / "tasks.jsonl", 30, outputs="csv"), tmp_path / "out"
    assert batch(table, out).returncode == 0
    inodes = {entry.name: entry.inode() for entry in os.scandir(out / "tasks")}
    lines = table.read_text().splitlines()
    changed = {**json.loads(lines[4]), "target": "0.1 0.5 1.1"}
    table.write_text("\n".join([*lines[:4], json.dumps(changed), *lines[5:]]) + "\n")
    done = batch(table, out)
    assert (done.returncode, made_now(done)) == (0, 1)
    assert [entry.name for entry in os.scandir(out / "tasks") if entry.inode() != inodes[entry.name]] == [changed["id"]]
    fresh = tmp_path / "fresh"
    assert batch(table, fresh).returncode == 0
    assert contents(out) == contents(fresh)


@pytest.mark.parametrize(("outputs", "count"), [("csv", TASKS), ("action", TASKS // 4)])
def test_memory_does_not_grow(tmp_path: Path, outputs: str, count: int) -> None:
    table, out = write_table(tmp_path / "tasks.jsonl", count, outputs=outputs), tmp_path / "out"
    process = subprocess.Popen([*map(str, (*BATCH, table, "--out", out))], stdout=subprocess.DEVNULL)
    after, early, last = min(MEASURED_AFTER, count // 2), 0, 0
    while process.poll() is None:
        size = resident_kb(process.pid)
        done = finished(out)
        if done >= after and not early:
            early = size
        if early and done < count:
            last = size or last  # the moment after the last task belongs to results.csv
        time.sleep(0.05)
    print(f"{outputs}: {early / 1024:.1f} MB after {after} tasks, {last / 1024:.1f} MB after {count}", file=sys.stderr)
    assert process.returncode == 0 and finished(out) == count
    assert last - early < MOST_GROWTH_KB


def resident_kb(process: int) -> int:
    try:
        lines = Path(f"/proc/{process}/status").read_text().splitlines()
    except OSError:
        return 0
    return next((int(line.split()[1]) for line in lines if line.startswith("VmRSS")), 0)
