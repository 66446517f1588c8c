# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line of a batch."""
from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from .jobs import JobsFailed
from .run import collect_batch, run_batch
from .store import DiskFull
from .tasks import ENGINES, OUTPUTS, PHASES

COLUMNS_HELP = f"""columns of the table (all but target may be missing or empty; JSON Lines has the same names as keys):
  id         names the result's folder; row-00001, ... where it is empty
  rig        an armature of the scene; empty: a mannequin at the origin that faces +y (x to its right, z up)
  stature    metres        sex  female or male        age  years        mass  of the person, kg
  home       where the box starts: 'x y z', 'x y z degrees' or an object's name; empty: at waist height in front
  target     where the middle of the box's base ends, likewise; without degrees the box faces the worker's feet
  object     a mesh's name, or width x depth x height in metres (0.35x0.30x0.25 where empty)
  load       mass of the object, kg
  phases     any of {', '.join(PHASES)}, separated by blanks (transfer where empty)
  variants   so many motions drawn from seeds seed, seed + 1, ...; 0 or empty: the mean motion
  outputs    any of {', '.join(OUTPUTS)}, separated by blanks (csv where empty); png: every frame, mp4: a film,
             sheet: one picture of the key moments
  engine     of the pictures: {', '.join(ENGINES)} (EEVEE where empty)
  camera     one of the scene; empty: one that sees the whole motion, with floor and light if the scene has no camera
  resolution of the pictures, width x height (640x480 where empty)
  frame_step every so many frames is drawn (1 where empty)
"""


def main(arguments: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(
        prog="batch.py", formatter_class=argparse.RawDescriptionHelpFormatter, epilog=COLUMNS_HELP,
        description="Does every task of a table, and writes DIR/tasks/ID/ for each, DIR/results.csv for all and the "
                    "gallery DIR/index.html. A second start does what is not done yet or has changed. Exit status 1: "
                    "some motions are missing or failed.")
    parser.add_argument("table", type=Path, help="tasks.csv or tasks.jsonl")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder of the results")
    parser.add_argument("--corpus", type=Path, help="motions to learn from; without it the corpus that ships")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="so many Blender processes at once")
    some = parser.add_mutually_exclusive_group()
    some.add_argument("--part", metavar="I/N", help="do the I-th of N parts; no results.csv and no gallery")
    some.add_argument("--collect", action="store_true", help="only results.csv and the gallery of what is there")
    options = parser.parse_args(list(arguments))
    try:
        counts = _collect(options) if options.collect else _work(options)
    except (ValueError, DiskFull, JobsFailed) as error:
        print(f"batch: {error}.", file=sys.stderr, flush=True)
        return 2
    return 1 if set(counts) & {"failed", "missing"} else 0


def _collect(options: argparse.Namespace) -> dict[str, int]:
    counts = collect_batch(options.table, options.out, corpus=options.corpus)
    print(_said(counts), flush=True)
    return counts


def _work(options: argparse.Namespace) -> dict[str, int]:
    found = run_batch(options.table, options.out, corpus=options.corpus, part=_part(options.part or "1/1"),
                      jobs=options.jobs, collect=not options.part, say=lambda line: print(line, flush=True))
    if found.lost:
        print(f"{found.lost} processes ended unexpectedly; others took their place", flush=True)
    rate = found.worked / max(found.seconds["whole"], 1e-9)
    print(f"{_said(found.counts)}; {found.worked} made now in {found.seconds['whole']:.1f} s ({rate:.0f} a second): "
          f"predict {found.seconds['predict']:.1f} s, write {found.seconds['write']:.1f} s", flush=True)
    return found.counts


def _said(counts: dict[str, int]) -> str:
    return ", ".join(f"{count} {status}" for status, count in counts.items()) or "an empty part"


def _part(text: str) -> tuple[int, int]:
    try:
        number, count = map(int, text.split("/"))
    except ValueError:
        raise ValueError(f"--part is '{text}'; it must be like 2/8") from None
    return number, count
