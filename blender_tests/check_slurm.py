# SPDX-License-Identifier: GPL-3.0-or-later
"""A batch on a real Slurm of two nodes, one of which is killed midway, against the same batch on a single machine.

    /usr/bin/python3 blender_tests/check_slurm.py [TASKS]

Starts and stops munged, slurmctld and both slurmd itself. Ends in one line: N passed, N failed, N skipped.
"""
from __future__ import annotations

import hashlib
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from small_cluster import SmallCluster, missing_daemons

PROJECT = Path(__file__).resolve().parent.parent
TASKS = 500
CHUNKS = 8
NODES = ("alpha", "beta")
MOST_S = 300.0    #: for the batch on the cluster


class Checks:
    """Counts what holds."""

    passed = failed = 0

    def check(self, what: str, holds: bool, said: object = "") -> None:
        self.passed, self.failed = self.passed + holds, self.failed + (not holds)
        print(f"ok    {what}" if holds else f"FAIL  {what}\n      {said}", flush=True)


def write_table(path: Path, count: int) -> None:
    """Tasks of four people; a few that cannot be done and one row that cannot be read."""
    with path.open("w") as file:
        file.write("id,stature,home,target,outputs\n")
        for number in range(count):
            target = "0 3 1" if number % 100 == 50 else f"{0.0005 * number:.4f} 0.45 {0.8 + 0.01 * (number % 40):g}"
            stature = "tall" if number == 7 else f"{1.55 + 0.1 * (number * 4 // count):g}"
            file.write(f"t{number:04d},{stature},0 0.42 0.1,{target},csv\n")


def alone(table: Path, out: Path) -> int:
    return subprocess.run(["blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python",
                           PROJECT / "examples" / "batch.py", "--", table, "--out", out],
                          stdout=subprocess.DEVNULL, check=False).returncode


def checksums(out: Path) -> dict[str, str]:
    """Of all results, by path below `out`; the logs are no results."""
    return {os.fspath(path.relative_to(out)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(out.rglob("*")) if path.is_file() and "slurm" not in path.relative_to(out).parts}


class Seen:
    """Which folder each task had when it was first there: a task that is done again gets a new one."""

    def __init__(self, out: Path) -> None:
        self.tasks, self.first, self.again = out / "tasks", {}, set()  # type: ignore[var-annotated]

    def look(self) -> int:
        """How many are finished now."""
        if self.tasks.exists():
            for entry in os.scandir(self.tasks):
                made = entry.inode(), entry.stat().st_ctime_ns
                if self.first.setdefault(entry.name, made)[0] != made[0]:
                    self.again.add(entry.name)
        return len(self.first)


def run_on(cluster: SmallCluster, table: Path, out: Path, count: int, checks: Checks) -> None:
    seen = Seen(out)
    submitted = time.monotonic()
    print(cluster.run("bash", PROJECT / "examples" / "batch_slurm.sh", table, "--out", out, "--chunks", CHUNKS), end="")
    cluster.wait_for(lambda: is_working(out, "alpha"), MOST_S, "chunk that alpha is in the middle of")
    failed = kill_blender(cluster, "alpha")
    print(f"the Blender of chunk {failed} is killed")
    cluster.wait_for(lambda: seen.look() > count // 4, MOST_S, "quarter of the tasks")
    cluster.wait_for(lambda: is_working(out, "beta"), MOST_S, "chunk that beta is in the middle of")
    cluster.kill_node("beta")
    killed, done = time.monotonic(), seen.look()
    print(f"beta is killed {killed - submitted:.0f} s after the start, with {done} of {count} tasks finished")
    checks.check("the node is killed midway", done < count, done)
    cluster.wait_for(lambda: (seen.look(), (out / "index.html").exists())[1], MOST_S, "results")
    cluster.wait_for(lambda: not cluster.run("squeue", "-h"), 60.0, "empty queue")
    print(f"the results are there {time.monotonic() - submitted:.0f} s after the start")
    checks.check("Slurm saw that the node was lost", cluster.states()["beta"].startswith("down"), cluster.states())
    logs = {path.stem: path.read_text() for path in (out / "slurm").glob("[0-9]*.log")}
    checks.check("the chunk whose Blender was killed was started again", "start 2" in logs[failed], logs[failed])
    lost = [chunk for chunk, log in logs.items() if "on beta" in log and "start 2" in log.split("on beta")[-1]]
    checks.check("the lost node's chunk was started again", bool(lost), logs)
    seen.look()
    checks.check("no task was done twice", not seen.again, sorted(seen.again))


def kill_blender(cluster: SmallCluster, node: str) -> str:
    """kill -9; returns the number of the chunk that it worked on."""
    for process, variables in cluster.processes().items():
        if variables.get("SLURMD_NODENAME") == node and Path(f"/proc/{process}/comm").read_text().strip() == "blender":
            os.kill(process, signal.SIGKILL)
            return variables["SLURM_ARRAY_TASK_ID"]
    raise RuntimeError(f"No Blender works on {node}")


def is_working(out: Path, node: str) -> bool:
    """Whether a chunk on this node has begun to make motions and has not come to its end."""
    for log in (out / "slurm").glob("[0-9]*.log"):
        text = log.read_text()
        if f"on {node}, start" in text and "are to be made" in text and "made now" not in text:
            return True
    return False


def compare(folder: Path, count: int, checks: Checks) -> None:
    table = folder / "tasks.csv"
    write_table(table, count)
    began = time.monotonic()
    status = alone(table, folder / "alone")
    print(f"one process makes {count} tasks in {time.monotonic() - began:.0f} s")
    checks.check("a single machine does the table", status == 0, status)
    with SmallCluster(folder / "cluster", NODES) as cluster:
        run_on(cluster, table, folder / "out", count, checks)
    checks.check("nothing of Slurm is left running", not cluster.processes(), cluster.processes())
    one, other = checksums(folder / "alone"), checksums(folder / "out")
    checks.check("every task is there", len(list((folder / "out" / "tasks").iterdir())) == count - 1)
    checks.check("all files are those of the single machine", one == other,
                 sorted(name for name in one.keys() | other.keys() if one.get(name) != other.get(name))[:10])


def main(arguments: list[str]) -> int:
    checks, count = Checks(), int(arguments[0]) if arguments else TASKS
    if missing := missing_daemons():
        print(f"skip  {', '.join(missing)} missing (Debian: apt-get install slurm-wlm)\n0 passed, 0 failed, 1 skipped")
        return 0
    with tempfile.TemporaryDirectory(prefix="reachcast-slurm-") as folder:
        try:
            compare(Path(folder), count, checks)
        except (RuntimeError, TimeoutError) as error:
            checks.check("the batch comes to its end", False, error)
            for log in sorted(Path(folder).rglob("*.log")):
                print(f"--- {log.name}\n{log.read_text(errors='replace')[-1500:]}")
    print(f"{checks.passed} passed, {checks.failed} failed, 0 skipped")
    return 1 if checks.failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
