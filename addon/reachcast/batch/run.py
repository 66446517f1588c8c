# SPDX-License-Identifier: GPL-3.0-or-later
"""`run_batch`: a table becomes a folder of results, as far as it is not one already."""
from __future__ import annotations

import os
import time
from collections import Counter
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

import bpy

from .. import native
from ..corpora import default_corpus, opened_corpus
from ..reachcast_corpus.recordings import checksum_of
from .gallery import write_gallery
from .jobs import Order, run_jobs
from .progress import Progress
from .stage import Stage, person_of
from .store import Store
from .table import BadRow, read_table, units_in
from .tasks import Unit
from .unit_work import work

VERSION = 2   #: of what the same task is turned into; a new one makes every task be done again


@dataclass(frozen=True)
class BatchResult:
    counts: dict[str, int]      #: rows of results.csv, or of the part that was done, by status
    worked: int                 #: units worked on in this run; the others were there already
    seconds: dict[str, float]   #: spent on predict and write, of all processes together, and the whole
    lost: int                   #: processes that died while they worked, each replaced by another


def run_batch(table: Path | str, out: Path | str, *, corpus: Path | str | None = None, part: tuple[int, int] = (1, 1),
              jobs: int = 1, collect: bool = True, say: Callable[[str], None] = print) -> BatchResult:
    """Does every task of `table` that `out` does not hold yet, and writes `out`/results.csv and its gallery.

    A task that cannot be done is a row with its reason; one that went wrong unexpectedly is tried again by the next
    run. part=(i, n) does the i-th of n parts only, as several machines would. jobs: so many processes of this Blender
    with the scene as it is now; 1 is this one alone. ValueError for a table, folder or corpus that cannot be used;
    DiskFull when the disk is full; JobsFailed when other processes cannot be had.
    """
    began = time.perf_counter()
    if jobs < 1:
        raise ValueError(f"The number of jobs is {jobs}; it must be 1 or more")
    units, path = units_in(read_table(Path(table))), _corpus(corpus)
    world = _world(path)
    store = Store(Path(out))
    try:
        mine = _part(units, part)
        orders = [(unit, unit.checksum(world)) for unit in mine if isinstance(unit, Unit)]
        left = _by_person([order for order in orders if not store.is_done(*order)])
        say(f"{len(left)} of {len(orders)} motions are to be made")
        progress, lost = Progress(len(left), say), 0
        if jobs > 1 and left:
            lost = run_jobs(left, store, path, jobs, progress)
        elif left:
            with closing(Stage(opened_corpus(native.core(), path))) as stage:
                for unit, checksum in left:
                    progress.add(work(store, stage, unit, checksum))
        counts = _collect(store, units, world) if collect else _counts(store.rows(mine, world))
    except OSError as error:
        store.refuse_full(error)
        raise
    finally:
        store.close()
    return BatchResult(counts, len(left), {"predict": 0.0, "write": 0.0, **progress.seconds,
                                           "whole": time.perf_counter() - began}, lost)


def collect_batch(table: Path | str, out: Path | str, *, corpus: Path | str | None = None) -> dict[str, int]:
    """Makes no motion: `out`/results.csv and the gallery of what is there, and how many rows there are by status."""
    units, world = units_in(read_table(Path(table))), _world(_corpus(corpus))
    store = Store(Path(out))
    try:
        return _collect(store, units, world)
    except OSError as error:
        store.refuse_full(error)
        raise
    finally:
        store.close()


def _collect(store: Store, units: Sequence[Unit | BadRow], world: str) -> dict[str, int]:
    rows = store.rows(units, world)
    store.write_results(rows)
    write_gallery(store.out)
    return _counts(rows)


def _counts(rows: Sequence[dict[str, object]]) -> dict[str, int]:
    return dict(Counter(str(row["status"]) for row in rows))


def _corpus(given: Path | str | None) -> str:
    path = Path(given) if given else default_corpus()
    if path is None:
        raise ValueError("No corpus is given and none ships with this build of the add-on; choose a corpus file")
    return os.fspath(path.absolute())


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


def _by_person(orders: Sequence[Order]) -> list[Order]:
    """The tasks of a person together, else in the table's order."""
    first: dict[object, int] = {}
    for unit, _ in orders:
        first.setdefault(person_of(unit.task), len(first))
    return sorted(orders, key=lambda order: first[person_of(order[0].task)])
