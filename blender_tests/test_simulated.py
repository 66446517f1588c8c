# SPDX-License-Identifier: GPL-3.0-or-later
"""The simulated corpus beside recorded people, as examples/compare_simulated.py prints it."""
from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
sys.path.insert(0, os.fspath(HERE))
import corpora  # noqa: E402


def test_every_measure_lies_within_the_recorded_spread() -> None:
    if not (corpora.MOCAP / "omomo").is_dir():
        pytest.skip(f"recordings are missing: {corpora.MOCAP} (set REACHCAST_MOCAP)")
    done = subprocess.run([sys.executable, os.fspath(HERE.parent / "examples" / "compare_simulated.py"), "--mocap",
                           os.fspath(corpora.MOCAP)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count("| yes |") == 8
