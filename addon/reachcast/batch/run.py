# SPDX-License-Identifier: GPL-3.0-or-later
"""`run_batch`: a table becomes a folder of results, as far as it is not one already."""
from __future__ import annotations

import errno
import os
import shutil
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np

from .. import native
from ..corpora import default_corpus, opened_corpus
from ..reachcast_corpus.recordings import checksum_of
from ..rigs.joints import INDEX
from ..scene.prepare import Solved, solve
from ..scene.predict_action import correction_in_words
from .gallery import write_gallery
from .outputs import Work, write_outputs
from .stage import Stage, person_of
from .store import DiskFull, Store
from .table import BadRow, read_table, units_in
from .tasks import Unit

VERSION = 1   #: of what the same task is turned into; a new one makes every task be done again
_FEET = [INDEX[f"{side}_{joint}"] for side in ("left", "right") for joint in ("ball", "ankle")]


@dataclass(frozen=True)
class BatchResult:
    counts: dict[str, int]      #: rows of results.csv by status
    worked: int                 #: units worked on in this run; the others were there already
    seconds: dict[str, float]   #: spent on predict, write and the whole


def run_batch(table: Path | str, out: Path | str, *, corpus: Path | str | None = None, part: tuple[int, int] = (1, 1),
              collect: bool = True, say: Callable[[str], None] = print) -> BatchResult:
    """Does every task of `table` that `out` does not hold yet, and writes `out`/results.csv and its gallery.

    A task that cannot be done is a row with its reason; one that went wrong unexpectedly is tried again by the next
    run. part=(i, n) does the i-th of n parts only, as several machines would. ValueError for a table, folder or corpus
    that cannot be used; DiskFull when the disk is full.
    """
    began = time.perf_counter()
    units = units_in(read_table(Path(table)))
    path = Path(corpus) if corpus else default_corpus()
    if path is None:
        raise ValueError("No corpus is given and none ships with this build of the add-on; choose a corpus file")
    world = _world(os.fspath(path))
    store = Store(Path(out))
    try:
        mine = [unit for unit in _part(units, part) if isinstance(unit, Unit)]
        left = [unit for unit in mine if not _is_done(store, unit, unit.checksum(world))]
        say(f"{len(left)} of {len(mine)} motions are to be made")
        seconds = {"predict": 0.0, "write": 0.0}
        stage = Stage(opened_corpus(native.core(), os.fspath(path)))
        for number, unit in enumerate(sorted(left, key=_by_person(left)), 1):
            _work(store, stage, unit, unit.checksum(world), seconds)
            if number % 50 == 0 or number == len(left):
                say(_progress(number, len(left), time.perf_counter() - began))
        counts = store.write_results(units) if collect else {}
        if collect:
            write_gallery(store.out)
    except OSError as error:
        store.refuse_full(error)
        raise
    finally:
        store.close()
    return BatchResult(counts, len(left), {**seconds, "whole": time.perf_counter() - began})


def _work(store: Store, stage: Stage, unit: Unit, checksum: str, seconds: dict[str, float]) -> None:
    """One unit, from its row to its folder."""
    began = time.perf_counter()
    draft, result = store.draft(unit), {"checksum": checksum}
    try:
        prepared, worker, load = stage.prepared(unit)
        solved = solve(prepared)
        predicted = time.perf_counter()
        seconds["predict"] += predicted - began
        files = write_outputs(Work(unit, prepared, worker, load, solved, stage.frame_rate), draft)
        if empty := [name for name in files if not (draft / name).stat().st_size]:
            raise OSError(errno.ENOSPC if shutil.disk_usage(draft).free == 0 else errno.EIO, f"{empty[0]} is empty")
        result.update(_facts(solved, stage.frame_rate), status="done", files=" ".join(files))
    except ValueError as error:
        predicted = time.perf_counter()
        store.refuse_full()
        _empty(draft)
        result.update(status="refused", reason=str(error))
    except (OSError, RuntimeError) as error:
        predicted = time.perf_counter()
        store.refuse_full(error if isinstance(error, OSError) else None)
        _empty(draft)
        result.update(status="failed", reason=" ".join(str(error).split()))
    store.finish(unit, draft, result)
    seconds["write"] += time.perf_counter() - predicted


def _facts(solved: Solved, rate: float) -> dict[str, object]:
    motion = solved.motion
    feet = solved.reached[:, _FEET]
    facts: dict[str, object] = {
        "foot_slip_mm": round(1000.0 * float(np.linalg.norm(feet - feet[0], axis=2).max()), 4),
        "duration_s": round((len(feet) - 1) / rate, 4),
        "durations": "; ".join(f"{phase} {(last - first) / rate:.3f}" for phase, first, last in motion.phases),
        "outside_data": "; ".join(map(str, motion.outside_reasons)) if motion.outside_data else "",
        "neighbours": " ".join(f"{near.id}:{near.weight:.3f}" for near in motion.neighbours),
        "corrections": "; ".join(map(correction_in_words, motion.corrections))}
    facts.update({f"{name}_error_mm": round(1000.0 * solved.errors[name], 4)
                  for name in ("landing", "grip") if name in solved.errors})
    return facts


def _world(corpus: str) -> str:
    """What besides its row a motion depends on."""
    scene = _digest(bpy.data.filepath) if bpy.data.filepath else ""
    rate = bpy.context.scene.render.fps / bpy.context.scene.render.fps_base
    return f"{VERSION} {_digest(corpus)} {scene} {rate:g} {bpy.app.version_string}"


def _digest(path: str) -> str:
    try:
        return checksum_of(Path(path))
    except OSError as error:
        raise ValueError(f"The file '{path}' cannot be read: {error.strerror}") from error


def _part(units: Sequence[Unit | BadRow], part: tuple[int, int]) -> Sequence[Unit | BadRow]:
    number, count = part
    if not 1 <= number <= count:
        raise ValueError(f"The part is {number}/{count}; it must be from 1/{count} to {count}/{count}")
    return units[(number - 1) * len(units) // count:number * len(units) // count]


def _is_done(store: Store, unit: Unit, checksum: str) -> bool:
    result = store.result(unit)
    return result is not None and result.get("checksum") == checksum and result.get("status") in ("done", "refused")


def _by_person(units: Sequence[Unit]) -> Callable[[Unit], int]:
    """Keeps the tasks of a person together, in the table's order."""
    order: dict[object, int] = {}
    for unit in units:
        order.setdefault(person_of(unit.task), len(order))
    return lambda unit: order[person_of(unit.task)]


def _empty(folder: Path) -> None:
    for item in list(folder.iterdir()):
        shutil.rmtree(item) if item.is_dir() else item.unlink()


def _progress(number: int, count: int, seconds: float) -> str:
    rate = number / seconds
    return f"{number} of {count}, {rate:.1f} a second, {(count - number) / rate:.0f} s left"
