# SPDX-License-Identifier: GPL-3.0-or-later
"""A corpus of a million motions: how long opening and predicting take, against reading all of it.

    /usr/bin/python3 blender_tests/bench_large_corpus.py [MOTIONS]

Writes 1.2 GB into the folder for temporary files and takes them away.
"""
from __future__ import annotations

import resource
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path[:0] = [str(HERE), str(HERE.parent / "addon" / "reachcast")]
import large_corpora  # noqa: E402
import reachcast_core as rc  # noqa: E402

MOST_OPEN_S = 1.0  #: the issue's own
SAMPLE = 10_000    #: motions that are read to tell how long all would take
RUNS = 20


def seconds(task: Callable[[], object]) -> float:
    began = time.perf_counter()
    task()
    return time.perf_counter() - began


def memory_mb() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


def main(count: int) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "large.sqlite"
        large_corpora.write_repeated(path, count)
        before = memory_mb()
        opening = statistics.median(seconds(lambda: rc.Corpus.open(path)) for _ in range(RUNS))
        corpus = rc.Corpus.open(path)
        body, subject = rc.Body.from_stature(1.72), rc.Subject(1.72)

        def predict(number: int) -> None:
            task = rc.Task([0.0, 0.42, 0.0], [0.1, 0.42, 0.6 + 0.02 * number], rc.Box(0.35, 0.30, 0.25, 0.12))
            rc.predict(corpus, subject, task, body)

        first = seconds(lambda: predict(0))
        then = statistics.median(seconds(lambda number=number: predict(number)) for number in range(1, RUNS))
        used = memory_mb() - before
        some = corpus.motions()[:SAMPLE]
        part = seconds(lambda: corpus.load([motion.id for motion in some]))
        everything = part * len(corpus) / len(some)
        print(f"{len(corpus)} motions, {path.stat().st_size / 1e6:.0f} MB: opened in {1000 * opening:.1f} ms, "
              f"first prediction {first:.2f} s, then {1000 * then:.1f} ms each; {used:.0f} MB of memory", flush=True)
        print(f"reading the codes of all would take {everything:.0f} s (as {len(some)} of them do); first prediction to "
              f"that: ratio {first / everything:.3f}", flush=True)
        if opening > MOST_OPEN_S:
            sys.exit(f"opening must take at most {MOST_OPEN_S:g} s")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000)
