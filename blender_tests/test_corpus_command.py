# SPDX-License-Identifier: GPL-3.0-or-later
"""`python3 -m reachcast_corpus`, run as a user runs it, without Blender."""
from __future__ import annotations

import os
import shutil
import sqlite3
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

PROJECT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(PROJECT / "addon" / "reachcast"))
rc = pytest.importorskip("reachcast_core")

SHIPPED = PROJECT / "addon" / "reachcast" / "data" / "simulated.sqlite"
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(PROJECT / "addon" / "reachcast")}
#: Metres: files hold six digits.
EXPORTED_M = 2e-5


def run(*arguments: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(["/usr/bin/python3", "-m", "reachcast_corpus", *map(str, arguments)], env=ENVIRONMENT,
                          capture_output=True, text=True, timeout=120, check=False)


def small_corpus(path: Path, ids: range, source: str = "") -> Path:
    """Motions of the shipped corpus, as if they had come from a file."""
    with rc.Corpus.open(str(SHIPPED)) as shipped, rc.Corpus.create(str(path)) as corpus:
        codes = shipped.load(list(ids))
        if source:
            stored = corpus.add_source(source, f"sha256:{source}", 12, [], [("reach, frames 1 to 5", "a foot steps")],
                                       note="metres", settings="{}")
            corpus.remove([])
            assert stored.motions == 0 and stored.rejections == [("reach, frames 1 to 5", "a foot steps")]
        corpus.add(codes)
    return path


def test_list_show_and_stats_name_every_motion(tmp_path: Path) -> None:
    corpus = small_corpus(tmp_path / "a.sqlite", range(1, 9), "lift.bvh")
    listed = run("list", corpus)
    assert listed.returncode == 0 and len(listed.stdout.splitlines()) == 9
    assert "paper/p1" in listed.stdout and "(mirror image)" in listed.stdout
    assert all(" transfer " in line for line in run("list", corpus, "--phase", "transfer").stdout.splitlines()[1:])
    shown = run("show", corpus)
    assert "file 1: lift.bvh, 12 bytes, sha256:lift.bvh" in shown.stdout
    assert "rejected reach, frames 1 to 5: a foot steps" in shown.stdout
    detail = run("show", corpus, 3).stdout
    with rc.Corpus.open(str(corpus)) as opened:
        motion = opened.motions()[2]
    assert motion.origin in detail and f"{motion.duration:.3f} s" in detail
    assert "8 motions (4 of them mirror images), 1 people" in run("stats", corpus).stdout


def test_check_finds_what_was_meddled_with(tmp_path: Path) -> None:
    corpus = small_corpus(tmp_path / "a.sqlite", range(1, 5))
    assert run("check", corpus).returncode == 0
    with sqlite3.connect(corpus) as database:
        database.execute("UPDATE codes SET data = x'00' WHERE motion = 2")
    found = run("check", corpus)
    assert found.returncode == 1 and "motion 2 has 1 bytes of coefficients" in found.stdout


def test_merging_adds_what_is_new_and_twice_nothing(tmp_path: Path) -> None:
    one, two = small_corpus(tmp_path / "a.sqlite", range(1, 7)), small_corpus(tmp_path / "b.sqlite", range(5, 11), "x.bvh")
    assert run("merge", tmp_path / "all.sqlite", one, two).returncode == 0
    again = run("merge", tmp_path / "all.sqlite", two, one)
    assert f"{two}: 0 motions added" in again.stdout and f"{one}: 0 motions added" in again.stdout
    with rc.Corpus.open(str(tmp_path / "all.sqlite")) as merged, rc.Corpus.open(str(SHIPPED)) as shipped:
        assert len(merged) == 10 and [source.path for source in merged.sources()] == ["x.bvh"]
        originals = {(code.origin, code.mirrored, code.phase): code for code in shipped.load(list(range(1, 11)))}
        for code in merged.load([motion.id for motion in merged.motions()]):
            original = originals[code.origin, code.mirrored, code.phase]
            assert np.array_equal(code.coefficients, original.coefficients)


def test_forgotten_motions_are_gone_and_unknown_ones_named(tmp_path: Path) -> None:
    corpus = small_corpus(tmp_path / "a.sqlite", range(1, 7))
    assert "2 motions forgotten, 4 left" in run("forget", corpus, 2, 3).stdout
    unknown = run("forget", corpus, 2)
    assert unknown.returncode == 1 and "has no motion 2" in unknown.stderr
    with rc.Corpus.open(str(corpus)) as opened:
        assert [motion.id for motion in opened.motions()] == [1, 4, 5, 6]


@pytest.mark.parametrize("form", ["bvh", "csv"])
def test_exported_motions_come_back(tmp_path: Path, form: str) -> None:
    ids = (1, 2, 4001, 9001)
    done = run("export", SHIPPED, *ids, "--out", tmp_path, "--format", form, "--rate", 30)
    assert done.returncode == 0, done.stderr
    with rc.Corpus.open(str(SHIPPED)) as shipped:
        motions = {motion.id: motion for motion in shipped.motions()}
        for motion_id in ids:
            (path,) = tmp_path.glob(f"{motion_id:06d}_*.{form}")
            body = rc.canonical(rc.read_motion(str(path)))
            expected = rc.replay(shipped, motion_id, len(body))
            assert abs((len(body) - 1) / body.rate - motions[motion_id].duration) < 1e-4
            apart = np.linalg.norm(body.positions - expected, axis=2).max(axis=0)
            # both inner ends of the collar bones are the suprasternale of what is read
            off = {rc.JOINTS[joint]: apart[joint] for joint in np.flatnonzero(apart > EXPORTED_M)}
            assert not set(off) - {"left_clavicle", "right_clavicle"}, off


def test_what_cannot_be_done_is_one_sentence(tmp_path: Path) -> None:
    missing = run("list", tmp_path / "none.sqlite")
    assert missing.returncode == 1 and missing.stderr.count("\n") == 1 and "does not exist" in missing.stderr
    text = tmp_path / "text.sqlite"
    text.write_text("no database" * 200)
    assert "is not an SQLite file" in run("stats", text).stderr
    assert "has no motion 99999" in run("show", SHIPPED, 99999).stderr
    assert "there is no file or folder" in run("import", tmp_path / "c.sqlite", tmp_path / "nothing").stderr
    assert not (tmp_path / "c.sqlite").exists()
    assert run("export", SHIPPED, 1, "--out", tmp_path, "--rate", 0).returncode == 1


def test_a_read_only_corpus_is_read_and_not_changed(tmp_path: Path) -> None:
    corpus = shutil.copy(small_corpus(tmp_path / "a.sqlite", range(1, 5)), tmp_path / "b.sqlite")
    before = Path(corpus).read_bytes()
    os.chmod(corpus, 0o444)
    assert run("check", corpus).returncode == 0
    if os.geteuid() != 0:  # root may write to it
        assert "read-only" in run("forget", corpus, 1).stderr
        assert Path(corpus).read_bytes() == before
