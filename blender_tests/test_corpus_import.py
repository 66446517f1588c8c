# SPDX-License-Identifier: GPL-3.0-or-later
"""Recordings become a corpus: whole files or nothing, whatever happens meanwhile. Outside Blender."""
from __future__ import annotations

import csv
import math
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(PROJECT / "addon" / "reachcast"))
rc = pytest.importorskip("reachcast_core")

from reachcast_corpus import exporting  # noqa: E402

SHIPPED = PROJECT / "addon" / "reachcast" / "data" / "simulated.sqlite"
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(PROJECT / "addon" / "reachcast")}
COMMAND = ["/usr/bin/python3", "-m", "reachcast_corpus"]
KILLS = 50
RECORDINGS = 40


def run(*arguments: object, **options: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run([*COMMAND, *map(str, arguments)], env=ENVIRONMENT, capture_output=True, text=True,
                          timeout=120, check=False, **options)


def chosen_motions(shipped: object) -> list[object]:
    """Motions that are long and wide enough to be kept: see the limits of find_reaches."""
    long = [motion for motion in shipped.motions()
            if motion.duration > 0.5 and math.dist(motion.home, motion.target) > 0.3]
    return long[:3 * RECORDINGS:3]


@pytest.fixture(scope="module")
def recordings(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of tables of joint centres, written from the shipped corpus, and labels.csv, which names their phases."""
    folder = tmp_path_factory.mktemp("recordings")
    rows = []
    with rc.Corpus.open(str(SHIPPED)) as shipped:
        for motion in chosen_motions(shipped):
            path = exporting.export_motion(rc, shipped, motion, folder, "csv", 60.0)
            frames = sum(1 for _ in open(path)) - 1
            rows.append([path.name, motion.phase, 0, frames - 1, f"{motion.subject.stature:.3f}", motion.subject.sex])
    with open(folder.parent / "labels.csv", "w", newline="") as file:
        csv.writer(file).writerows([["file", "phase", "first", "last", "stature_m", "sex"], *rows])
    return folder


def import_arguments(corpus: Path, recordings: Path) -> list[object]:
    return ["import", corpus, recordings, "--labels", recordings.parent / "labels.csv"]


def contents(corpus: Path) -> dict[str, list[tuple[object, ...]]]:
    """Checksum of each file -> what came from it."""
    with rc.Corpus.open(str(corpus)) as opened:
        assert opened.check() == []
        motions = {motion.id: motion for motion in opened.motions()}
        return {source.checksum: [(motions[i].origin, motions[i].phase, motions[i].mirrored, motions[i].duration)
                                  for i in opened.motions_of(source.id)] for source in opened.sources()}


@pytest.fixture(scope="module")
def complete(recordings: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    corpus = tmp_path_factory.mktemp("complete") / "all.sqlite"
    done = run(*import_arguments(corpus, recordings))
    assert done.returncode == 0, done.stdout + done.stderr
    return corpus


def test_labelled_phases_come_in_with_their_people(recordings: Path, complete: Path) -> None:
    with rc.Corpus.open(str(complete)) as corpus, rc.Corpus.open(str(SHIPPED)) as shipped:
        originals = chosen_motions(shipped)
        assert len(corpus) == 2 * len(originals) and corpus.meta["kind"] == "recorded"
        kept = [motion for motion in corpus.motions() if not motion.mirrored]
        for original, motion in zip(originals, kept):
            assert motion.phase == original.phase and motion.subject.sex == original.subject.sex
            assert abs(motion.subject.stature - original.subject.stature) < 1e-3
            assert abs(motion.duration - original.duration) < 1e-3
            # hips that turn turn the body frame; lengths stay
            assert abs(math.dist(motion.home, motion.target) - math.dist(original.home, original.target)) < 0.002


def test_the_same_files_again_change_nothing(recordings: Path, complete: Path) -> None:
    before = complete.read_bytes()
    again = run(*import_arguments(complete, recordings))
    assert f"0 files imported, {RECORDINGS} there already" in again.stdout
    assert complete.read_bytes() == before


def test_other_settings_replace_what_a_file_gave(recordings: Path, complete: Path, tmp_path: Path) -> None:
    corpus = Path(shutil.copy(complete, tmp_path / "a.sqlite"))
    done = run(*import_arguments(corpus, recordings), "--no-mirror")
    assert f"{RECORDINGS} files imported" in done.stdout
    with rc.Corpus.open(str(corpus)) as opened:
        assert len(opened) == RECORDINGS and not any(motion.mirrored for motion in opened.motions())


def test_a_killed_import_leaves_whole_files_and_goes_on(recordings: Path, complete: Path, tmp_path: Path) -> None:
    corpus, whole, dice = tmp_path / "killed.sqlite", contents(complete), random.Random(50)
    took = time.perf_counter()
    run(*import_arguments(tmp_path / "timed.sqlite", recordings))
    took = time.perf_counter() - took
    cut_short = 0
    for _ in range(KILLS):
        process = subprocess.Popen([*COMMAND, *map(str, import_arguments(corpus, recordings))], env=ENVIRONMENT,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(dice.uniform(0.0, took))
        process.send_signal(signal.SIGKILL)
        cut_short += process.wait() == -signal.SIGKILL
        if not corpus.exists():
            continue  # killed before there was a corpus
        with rc.Corpus.open_for_writing(str(corpus)):
            pass  # which repairs what was left half written
        found = contents(corpus)
        assert all(whole[checksum] == motions for checksum, motions in found.items())
        if len(found) == len(whole):
            corpus.unlink()
    assert cut_short > KILLS // 4
    done = run(*import_arguments(corpus, recordings))
    assert done.returncode == 0, done.stderr
    assert contents(corpus) == whole


def test_two_readers_beside_a_writer_see_whole_files(recordings: Path, complete: Path, tmp_path: Path) -> None:
    corpus, whole = tmp_path / "shared.sqlite", contents(complete)
    rc.Corpus.create(str(corpus)).close()
    writer = subprocess.Popen([*COMMAND, *map(str, import_arguments(corpus, recordings))], env=ENVIRONMENT,
                              stdout=subprocess.DEVNULL)
    readers = [rc.Corpus.open(str(corpus)) for _ in range(2)]
    seen = set()
    while writer.poll() is None:
        for reader in readers:
            for source in reader.sources():
                assert source.motions == len(whole[source.checksum])
            seen.add(len(reader.motions()))
    assert writer.returncode == 0
    assert all(len(reader.motions()) == 2 * RECORDINGS for reader in readers)
    assert all(count % 2 == 0 for count in seen)


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[list[str]]:
    """The beginning of a command line that runs with a disk of 400 kB at tmp_path/disk, which goes with it."""
    disk = tmp_path / "disk"
    disk.mkdir()
    prefix = ["unshare", "--mount", "sh", "-c", f'mount -t tmpfs -o size=400k none "{disk}" && exec "$@"', "sh"]
    if subprocess.run([*prefix, "true"], capture_output=True, check=False).returncode:
        pytest.skip("mounting a small disk needs root")
    yield prefix


def test_a_full_disk_stops_the_import_and_keeps_what_was_finished(small_disk: list[str], recordings: Path,
                                                                  tmp_path: Path) -> None:
    corpus, kept = tmp_path / "disk" / "a.sqlite", tmp_path / "kept.sqlite"
    script = (f'"$@" ; status=$?; cp "{corpus}" "{kept}"; ls "{corpus.parent}"; exit $status')
    done = subprocess.run([*small_disk, "sh", "-c", script, "sh", *COMMAND, *map(str, import_arguments(corpus, recordings))],
                          env=ENVIRONMENT, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "the disk is full" in done.stderr and done.stderr.count("\n") == 1
    assert done.stdout.splitlines()[-1] == "a.sqlite"  # and no journal beside it
    found = contents(kept)
    assert 0 < len(found) < RECORDINGS and sum(map(len, found.values())) == 2 * len(found)


def test_labels_of_files_that_are_not_there_are_a_mistake(recordings: Path, tmp_path: Path) -> None:
    table = tmp_path / "labels.csv"
    table.write_text("file,phase,first,last\nnobody.csv,reach,0,9\n")
    done = run("import", tmp_path / "a.sqlite", recordings, "--labels", table)
    assert done.returncode == 1 and "'nobody.csv'" in done.stderr


def test_unreadable_files_are_listed_and_do_not_stop_the_others(recordings: Path, tmp_path: Path) -> None:
    folder = tmp_path / "mixed"
    folder.mkdir()
    (folder / "broken.bvh").write_text("HIERARCHY\nROOT")
    for path in sorted(recordings.glob("*.csv"))[:2]:
        shutil.copy(path, folder)
    done = run("import", tmp_path / "a.sqlite", folder, "--stature", 1.7)
    assert done.returncode == 0 and "1 unreadable" in done.stdout and "broken.bvh" in done.stdout
    with rc.Corpus.open(str(tmp_path / "a.sqlite")) as corpus:
        assert len(corpus.sources()) == 3
    assert run("import", tmp_path / "b.sqlite", folder / "broken.bvh").returncode == 1
