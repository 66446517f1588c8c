# SPDX-License-Identifier: GPL-3.0-or-later
"""The command that averages random motions on random bodies, with fewer of them; and that it sees a broken body."""
from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "examples"))
import check_bodies  # noqa: E402
from check_bodies import rc  # noqa: E402


def test_no_body_breaks() -> None:
    done = subprocess.run(["/usr/bin/python3", str(ROOT / "examples" / "check_bodies.py"), "--cases", "600"],
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    predicted = int(done.stdout.split("cases: ")[1].split()[0])
    assert predicted > 400


class Bent:
    """A motion with some of it changed."""

    def __init__(self, motion: rc.Motion, **changed: object) -> None:
        self.motion, self.changed = motion, changed

    def __getattr__(self, name: str) -> object:
        return self.changed.get(name, getattr(self.motion, name))


@pytest.mark.parametrize(("joint", "seen"), [("left_wrist", "links"), ("right_grip", "grips"), ("left_ball", "feet")])
def test_a_millimetre_is_seen(joint: str, seen: str) -> None:
    pick, body = np.random.default_rng(1), rc.Body.from_stature(1.75)
    task = check_bodies.random_task(pick)
    motion = rc.predict(rc.Corpus.open(check_bodies.SHIPPED), rc.Subject(1.75), task, body, frame_rate=6.0)
    assert check_bodies.measure(motion, task, body)[seen] < check_bodies.EXACT_M
    positions = np.array(motion.positions)
    positions[3, check_bodies.AT[joint]] += [0.0, 0.001, 0.0]
    assert check_bodies.measure(Bent(motion, positions=positions), task, body)[seen] > check_bodies.EXACT_M


def test_a_straight_elbow_is_seen() -> None:
    pick, body = np.random.default_rng(1), rc.Body.from_stature(1.75)
    task = check_bodies.random_task(pick)
    motion = rc.predict(rc.Corpus.open(check_bodies.SHIPPED), rc.Subject(1.75), task, body, frame_rate=6.0)
    positions = np.array(motion.positions)
    shoulder, wrist = (positions[:, check_bodies.AT[f"left_{name}"]] for name in ("shoulder", "wrist"))
    positions[:, check_bodies.AT["left_elbow"]] = 0.5 * (shoulder + wrist)
    assert check_bodies.measure(Bent(motion, positions=positions), task, body)["elbows beyond"] > 0.1
