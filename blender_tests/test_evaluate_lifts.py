# SPDX-License-Identifier: GPL-3.0-or-later
"""The command that sets predictions beside recorded lifts, on one lift of each set."""
from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
MOCAP = Path(os.environ.get("REACHCAST_MOCAP", ROOT.parent / "shared" / "mocap"))
FURTHEST_CM = 60.0  #: a prediction of another person's lift; a frame that is mixed up is metres off


def run(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(["blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python",
                           str(ROOT / "examples" / "evaluate_lifts.py"), "--", *arguments],
                          capture_output=True, text=True, timeout=900)


@pytest.mark.skipif(not (MOCAP / "omomo").is_dir(), reason=f"recordings are missing: {MOCAP}")
def test_every_method_has_an_error_on_every_set() -> None:
    done = run("--mocap", str(MOCAP), "--most", "1")
    assert done.returncode == 0, done.stderr
    rows = [line.strip("| ").split(" | ") for line in done.stdout.splitlines() if line.startswith("| ")]
    assert [re.sub(r" \(1 lifts.*", "", head) for head in rows[0][-3:]] == ["OMOMO", "Lieblich", "Becanovic"]
    assert len(rows) == 13
    for method, *cells in rows[1:]:
        for cell in cells:
            assert 0.0 < float(cell.split()[0]) < FURTHEST_CM, (method, cells)


def test_missing_recordings_are_named(tmp_path: Path) -> None:
    done = run("--mocap", str(tmp_path))
    assert done.returncode != 0
    assert f"There are no recordings in {tmp_path}" in done.stderr
