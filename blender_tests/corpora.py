# SPDX-License-Identifier: GPL-3.0-or-later
"""Corpora to test on, made fresh in a temporary folder once per run: the recorded lifts, and many variations of them.

As a command, outside Blender, it writes the large corpus:  /usr/bin/python3 blender_tests/corpora.py OUT [COUNT]
"""
from __future__ import annotations

import atexit
import functools
import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

PROJECT = Path(__file__).resolve().parent.parent
MOCAP = Path(os.environ.get("REACHCAST_MOCAP", PROJECT.parent / "shared" / "mocap"))
PYTHON = "/usr/bin/python3"  #: the one that Debian's Blender runs
LARGE = 3000                 #: motions, mirror images included
SEED = 20040


@functools.cache
def folder() -> Path:
    """A temporary folder that goes with the process."""
    path = Path(tempfile.mkdtemp(prefix="reachcast-corpora-"))
    atexit.register(shutil.rmtree, path, ignore_errors=True)
    return path


def require_recordings() -> None:
    """Skips the test when there are no recordings to build from."""
    if not any((MOCAP / name).is_dir() for name in ("omomo", "lieblich_lifting")):
        raise unittest.SkipTest(f"recordings are missing: {MOCAP} (set REACHCAST_MOCAP)")


@functools.cache
def recorded_corpus() -> Path:
    """The corpus that examples/build_corpus.py makes of the recordings."""
    require_recordings()
    path = folder() / "recorded.sqlite"
    _run(PROJECT / "examples" / "build_corpus.py", "--mocap", MOCAP, "--out", path)
    return path


@functools.cache
def large_corpus(count: int = LARGE) -> Path:
    """`count` motions: variations of the recorded transfers."""
    require_recordings()
    path = folder() / f"large_{count}.sqlite"
    _run(Path(__file__), path, count)
    return path


@functools.cache
def empty_corpus() -> Path:
    path = folder() / "empty.sqlite"
    code = "import sys, reachcast_core; reachcast_core.Corpus.create(sys.argv[1])"
    _python("-c", code, path)
    return path


def _run(script: Path, *arguments: object) -> None:
    _python(os.fspath(script), *arguments)


def _python(*arguments: object) -> None:
    """In a process of its own: what it imports does not meet Blender's modules."""
    search = {**os.environ, "PYTHONPATH": os.fspath(PROJECT / "addon" / "reachcast")}
    done = subprocess.run([PYTHON, "-B", *map(str, arguments)], capture_output=True, text=True, env=search, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, arguments))} failed:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")


# ---------------------------------------------------------------- only in the process that writes the large corpus


def builder() -> ModuleType:
    """examples/build_corpus.py as a module."""
    spec = importlib.util.spec_from_file_location("build_corpus", PROJECT / "examples" / "build_corpus.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["build_corpus"] = module
    spec.loader.exec_module(module)
    return module


def recorded_transfers() -> list[Any]:
    """Reaches, in the order of the recordings."""
    build = builder()
    readers = {"omomo": build.omomo_phases, "lieblich_lifting": build.lieblich_phases}
    found = [case.reach for name, phases in readers.items() if (MOCAP / name).is_dir() for case in phases(MOCAP / name)]
    return [reach for reach in found if reach is not None and reach.phase == "transfer"]


def varied(reaches: list[Any], count: int) -> Iterator[Any]:
    """`count` reaches: the recorded ones by larger and smaller, broader and narrower, quicker and slower people."""
    import numpy as np
    import reachcast_core as rc
    random = np.random.default_rng(SEED)
    for number in range(count):
        reach = reaches[number % len(reaches)]
        size = random.uniform(0.9, 1.1)
        stretch = size * random.uniform(0.97, 1.03, 3)
        rate = (len(reach) - 1) / reach.duration * random.uniform(0.8, 1.25)
        clip = rc.Clip(list(rc.JOINTS), reach.positions * stretch, rate, f"variation {number}")
        subject = rc.Subject(reach.subject.stature * size, sex=reach.subject.sex)
        origin = f"{reach.origin}, variation {number}"
        yield rc.cut_reach(clip, 0, len(reach) - 1, subject, "transfer", origin, floor_z=0.0)


def write_large(path: str, count: int) -> None:
    import reachcast_core as rc
    corpus = rc.Corpus.create(path)
    corpus.add_reaches(list(varied(recorded_transfers(), (count + 1) // 2)), mirror=True)
    corpus.set_meta("kind", "varied")


if __name__ == "__main__":
    write_large(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else LARGE)
