# SPDX-License-Identifier: GPL-3.0-or-later
"""Several Blender processes make the units of one batch. What a process leaves undone when it dies, another does."""
from __future__ import annotations

import os
import pickle
import queue
import signal
import subprocess
import sys
import threading
import time
from collections import Counter, deque
from collections.abc import Mapping, Sequence
from pathlib import Path

import bpy

from .progress import Progress
from .store import Store
from .tasks import Unit
from .worker import GREETING

MOST_TRIES = 3      #: of a unit, when the process that worked on it died
MOST_CHUNK = 16     #: units of one person that a process takes at once: it has that person's rig
Order = tuple[Unit, str]   #: with its checksum
_ADDON = __package__.rpartition(".")[0]


class JobsFailed(RuntimeError):
    """One sentence: the processes could not be started or could not write."""


def run_jobs(orders: Sequence[Order], store: Store, corpus: str, count: int, progress: Progress) -> int:
    """Makes all units in `count` processes of this Blender with this scene; returns how many processes died.

    A unit whose process died MOST_TRIES times fails with that reason. DiskFull, JobsFailed end the run; what was
    finished is kept.
    """
    if not bpy.app.binary_path:
        raise JobsFailed("This Python has no Blender that could be started again; use one job")
    folder = store.own / ".jobs"  # no task's name begins with a dot; the store drops it also after kill -9
    folder.mkdir()
    scene = folder / "scene.blend"
    try:
        bpy.ops.wm.save_as_mainfile(filepath=os.fspath(scene), copy=True, check_existing=False)
    except RuntimeError as error:
        store.refuse_full(error)
        raise JobsFailed(f"The scene cannot be copied for other processes: {' '.join(str(error).split())}") from error
    return _Pool(orders, store, corpus, _command(scene.absolute()), folder).run(min(count, len(orders)), progress)


def _command(scene: Path) -> list[str]:
    """Starts a worker, with the user's settings or without as this Blender was."""
    own = sys.argv[:sys.argv.index("--")] if "--" in sys.argv else sys.argv
    here = os.fspath(Path(__file__).resolve().parents[2])
    begin = (f"import sys; sys.dont_write_bytecode = {sys.dont_write_bytecode}; sys.path.insert(0, {here!r}); "
             f"import addon_utils; addon_utils.enable({_ADDON!r}); "
             f"from {__package__}.worker import main; main()")
    return [bpy.app.binary_path, "-b", *(word for word in own if word == "--factory-startup"), os.fspath(scene),
            "--python-exit-code", "1", "--python-expr", begin]


class _Pool:
    """The units that are left, and a thread for every process. Only `run` speaks to `progress` and `store`."""

    def __init__(self, orders: Sequence[Order], store: Store, corpus: str, command: list[str], logs: Path) -> None:
        self._left, self._lock = deque(orders), threading.Lock()
        self._store, self._corpus, self._command, self._logs = store, corpus, command, logs
        self._news: queue.SimpleQueue[tuple[str, object]] = queue.SimpleQueue()
        self._processes: set[subprocess.Popen[bytes]] = set()
        self._stopped = False

    def run(self, count: int, progress: Progress) -> int:
        threads = [threading.Thread(target=self._serve, args=(slot, count), daemon=True) for slot in range(count)]
        tries: Counter[str] = Counter()
        lost = barren = 0   # processes that died; those since one last made a unit
        for thread in threads:
            thread.start()
        try:
            while progress.done < progress.count:
                kind, news = self._news.get()
                if kind == "made":
                    barren = 0
                    progress.add(news)  # type: ignore[arg-type]
                elif kind == "ends":
                    raise news  # type: ignore[misc]
                else:
                    lost, barren = lost + 1, barren + 1
                    undone, how, last = news  # type: ignore[misc]
                    progress.note(f"a process ended unexpectedly ({how}); {len(undone)} motions go to another")
                    if barren > MOST_TRIES * count:
                        raise JobsFailed(f"{barren} processes ended ({how}) without making a motion; "
                                         f"the last said: {last}")
                    self._again(undone, how, tries, progress)
        finally:
            self._stop(threads)
        return lost

    def _again(self, undone: list[Order], how: str, tries: Counter[str], progress: Progress) -> None:
        """The first of `undone` was being worked on: it may be what kills processes."""
        self._store.drop_orphans()
        for number, (unit, checksum) in enumerate(undone):
            if self._store.is_done(unit, checksum):
                progress.add({})
                continue
            tries[unit.id] += number == 0
            if tries[unit.id] < MOST_TRIES:
                with self._lock:
                    self._left.append((unit, checksum))
            else:
                self._store.finish(unit, self._store.draft(unit), {
                    "checksum": checksum, "status": "failed",
                    "reason": f"The process that worked on it ended with {how}, {MOST_TRIES} times"})
                progress.add({})

    def _serve(self, slot: int, count: int) -> None:
        """One process after the other, until nothing is left to be done by anyone."""
        log = self._logs / f"{slot}.log"
        # Blender 4.3 leaves this signal as it is: it would end when it speaks to a process that has just died.
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGPIPE})
        try:
            while not self._stopped:
                self._one_process(log, count)
        except Exception as error:  # noqa: BLE001  it ends the run, which else would wait for this thread
            self._news.put(("ends", error))

    def _one_process(self, log: Path, count: int) -> None:
        with log.open("wb") as errors:
            process = subprocess.Popen(self._command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=errors)
        with self._lock:
            self._processes.add(process)
        undone: list[Order] = []
        try:
            _greet(process, self._store.out, self._corpus)
            while not self._stopped:
                undone = undone or self._chunk(count)
                if undone:
                    self._news.put(("made", _ask(process, undone[0])))
                    undone.pop(0)
                else:
                    time.sleep(0.05)  # another process may die and leave its units
        except (EOFError, BrokenPipeError, pickle.UnpicklingError):
            if not self._stopped:
                self._news.put(("died", (undone, _ended(process), _last_line(log))))
        finally:
            with self._lock:
                self._processes.discard(process)
            _close(process)

    def _chunk(self, count: int) -> list[Order]:
        with self._lock:
            size = max(1, min(MOST_CHUNK, len(self._left) // (4 * count)))
            return [self._left.popleft() for _ in range(min(size, len(self._left)))]

    def _stop(self, threads: Sequence[threading.Thread]) -> None:
        self._stopped = True
        with self._lock:
            for process in self._processes:
                process.terminate()
        for thread in threads:
            thread.join()
        self._store.drop_orphans()


def _greet(process: subprocess.Popen[bytes], out: Path, corpus: str) -> None:
    for line in process.stdout:  # type: ignore[union-attr]
        if line.strip() == GREETING.strip():
            break
    _ask(process, (os.fspath(out), corpus))


def _ask(process: subprocess.Popen[bytes], order: object) -> Mapping[str, float]:
    pickle.dump(order, process.stdin)  # type: ignore[arg-type]
    process.stdin.flush()  # type: ignore[union-attr]
    reply = pickle.load(process.stdout)  # type: ignore[arg-type]
    if isinstance(reply, Exception):
        raise reply  # it ends the whole run
    return reply


def _close(process: subprocess.Popen[bytes]) -> None:
    for stream in (process.stdin, process.stdout):
        try:
            stream.close()  # type: ignore[union-attr]
        except OSError:
            pass  # what was not sent is for a process that is no more
    process.wait()


def _ended(process: subprocess.Popen[bytes]) -> str:
    """What has stopped to answer is killed when it does not end by itself."""
    try:
        status = process.wait(10.0)
    except subprocess.TimeoutExpired:
        process.kill()
        status = process.wait()
    return f"signal {-status}" if status < 0 else f"exit status {status}"


def _last_line(log: Path) -> str:
    lines = log.read_text(encoding="utf-8", errors="replace").split("\n")
    return next((line.strip() for line in reversed(lines) if line.strip()), "nothing")
