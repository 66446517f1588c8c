# SPDX-License-Identifier: GPL-3.0-or-later
"""What prediction reads of a corpus: where motions begin and end, and the coefficients of its neighbours alone."""
from __future__ import annotations

import sqlite3
import sys
from pathlib import Path

import numpy as np
import pytest

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "addon" / "reachcast")]
import large_corpora  # noqa: E402
import reachcast_core as rc  # noqa: E402

COUNT = 30_000
DAMAGED = b"\xff\xff\xff"  #: no end to a number: whoever reads it fails


def predicted(path: Path, phase: str = "transfer") -> rc.Motion:
    task = rc.Task([0.0, 0.42, 0.1], [0.1, 0.42, 1.0], rc.Box(0.35, 0.30, 0.25, 0.12))
    return rc.predict(rc.Corpus.open(path), rc.Subject(1.72), task, rc.Body.from_stature(1.72), phases=[phase])


@pytest.fixture(scope="module")
def large(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("large") / "c.sqlite"
    large_corpora.write_repeated(path, COUNT)
    return path


def test_a_repeated_corpus_is_one(large: Path) -> None:
    corpus = rc.Corpus.open(large)
    assert len(corpus) >= COUNT
    assert corpus.check() == []


@pytest.mark.parametrize("phase", ["transfer", "retrieve", "reach", "return"])
def test_prediction_reads_only_the_coefficients_of_its_neighbours(large: Path, tmp_path: Path, phase: str) -> None:
    whole = predicted(large, phase)
    near = {neighbour.id for neighbour in whole.neighbours}
    path = tmp_path / "c.sqlite"
    path.write_bytes(large.read_bytes())
    with sqlite3.connect(path) as file:
        kept = near | {original for key in near for original, in
                       file.execute("SELECT original FROM codes WHERE motion = ? AND original NOT NULL", (key,))}
        file.execute("UPDATE codes SET data = ?", (DAMAGED,))
        with sqlite3.connect(large) as intact:
            for key in kept:
                file.execute("UPDATE codes SET data = ? WHERE motion = ?",
                             (*intact.execute("SELECT data FROM codes WHERE motion = ?", (key,)).fetchone(), key))
    np.testing.assert_array_equal(predicted(path, phase).positions, whole.positions)
    with pytest.raises(RuntimeError, match="damaged"):
        rc.Corpus.open(path).load([key for key in range(1, COUNT) if key not in kept][:1])
