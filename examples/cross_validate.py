#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How well the transfers of a corpus are predicted from the others, scheme by scheme, and how much people vary.

    /usr/bin/python3 examples/cross_validate.py [CORPUS] [--leave-out motion|subject] [--schemes all|paper|FILE.json]

Each motion (or its whole subject) is left out, predicted on the proportions of the subject's stature, and compared with
what its own code gives on that body: the mean distance over time and 23 joints, in centimetres. Given are where the
hands begin and end; feet stand still. Without a corpus one is built from the recordings in $REACHCAST_MOCAP or
../shared/mocap. A FILE.json holds a list of schemes, such as [{"k": 5, "ranks": ["task", "stature"]}]; reachcast_core's
cross_validate says what a scheme can be.
"""
from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "addon" / "reachcast"))
sys.dont_write_bytecode = True

WITHIN_M = (0.05, 0.10, 0.15)  #: how near the ends of two motions are that count as the same task
DEFAULT = "ranks of task + stature, 5 triangular"  #: of predict; always printed


def parse(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("corpus", nargs="?", type=Path, help="a corpus file; built from recordings when left out")
    parser.add_argument("--leave-out", choices=("motion", "subject"), action="append",
                        help="what is not learned from; both, one after the other, when left out")
    parser.add_argument("--schemes", default="all", metavar="all|paper|FILE.json",
                        help="60, or those of the 2004 paper, or your own")
    parser.add_argument("--rows", type=int, default=12, help="how many of the best schemes to print; 0: all")
    parser.add_argument("--threads", type=int, default=0, help="0: as many as the machine has; changes no result")
    return parser.parse_args(arguments)


def built_corpus(folder: Path) -> Path:
    recordings = Path(os.environ.get("REACHCAST_MOCAP", ROOT.parent / "shared" / "mocap"))
    if not recordings.is_dir():
        sys.exit(f"Name a corpus file: there are no recordings in {recordings} to build one from.")
    path = folder / "recorded.sqlite"
    subprocess.run([sys.executable, str(ROOT / "examples" / "build_corpus.py"), "--mocap", str(recordings),
                    "--out", str(path)], check=True, stdout=subprocess.DEVNULL)
    return path


def wanted_schemes(core: Any, which: str) -> list[Any]:
    if which in ("all", "paper"):
        return core.schemes(which)
    try:
        schemes = json.loads(Path(which).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        sys.exit(f"--schemes {which}: {error}")
    if not isinstance(schemes, list) or not schemes:
        sys.exit(f"--schemes {which}: the file must hold a list of schemes")
    return schemes


def span(pair: tuple[float, float]) -> str:
    return f"{100 * pair[0]:4.1f} to {100 * pair[1]:4.1f}"


def line(row: dict[str, Any]) -> str:
    low, high = (100 * value for value in row["behind_best"])
    behind = "best".center(13) if row["best"] else f"{low:+5.1f} to {high:+4.1f}"
    return (f" {100 * row['median']:6.1f}  {span(row['interval'])}  {span(row['quartiles'])}  {behind}  "
            f"{row['failed']:6}  {row['label']}")


def print_table(rows: list[dict[str, Any]], leave_out: str, most: int) -> None:
    first = rows[0]
    print(f"left out: {leave_out}; {first['motions']} motions, resampled by {first['groups']} {leave_out}s"
          + (f"; {first['out_of_reach']} more out of reach" if first["out_of_reach"] else ""))
    print(" median  95 % interval     quartiles    behind best  failed  scheme (cm)")
    ranked = sorted(rows, key=lambda row: (not row["best"], row["median"]))
    shown = [row for place, row in enumerate(ranked) if place < (most or len(ranked)) or row["label"] == DEFAULT]
    for row in shown:
        print(line(row))
    if len(shown) < len(ranked):
        print(f" {len(ranked) - len(shown)} more, to a median of {100 * ranked[-1]['median']:.1f}")
    tied = sum(row["behind_best"][0] <= 0.0 for row in rows) - 1
    print(f" best: {json.dumps(ranked[0]['scheme'])}")
    print(f" of the {len(rows) - 1} others these motions cannot tell {tied} from it")


def print_variation(core: Any, corpus: Any, threads: int) -> None:
    print("natural variation: one person's motions with the same task, on the same measure")
    for within in WITHIN_M:
        found = core.natural_variation(corpus, within, threads=threads)
        ends = f"ends within {100 * within:2.0f} cm: {found['pairs']:3} pair(s), {found['groups']} subject(s)"
        if not found["pairs"]:
            print(f"   {ends}")
            continue
        print(f"   {ends}, median {100 * found['median']:.1f}, quartiles {span(found['quartiles'])}"
              + (f", 95 % {span(found['interval'])}" if found["groups"] > 1 else ", no interval from one subject"))


def main() -> int:
    options = parse(sys.argv[1:])
    try:
        import reachcast_core as core
    except ImportError as missing:
        sys.exit(f"{missing}. Run this with the Python that Blender runs, after building reachcast_core for it; this "
                 f"is {sys.executable}, try /usr/bin/python3.")
    schemes = wanted_schemes(core, options.schemes)
    with tempfile.TemporaryDirectory(prefix="reachcast-") as folder:
        try:
            with core.Corpus.open(options.corpus or built_corpus(Path(folder))) as corpus:
                for leave_out in options.leave_out or ("motion", "subject"):
                    rows = core.cross_validate(corpus, schemes, leave_out, threads=options.threads)
                    print_table(rows, leave_out, options.rows)
                    print()
                print_variation(core, corpus, options.threads)
        except ValueError as error:
            sys.exit(str(error))
    return 0


if __name__ == "__main__":
    sys.exit(main())
