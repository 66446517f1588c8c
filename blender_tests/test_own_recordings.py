# SPDX-License-Identifier: GPL-3.0-or-later
"""The README's road from a folder of recordings to a prediction, command by command."""
from __future__ import annotations

import json
import os
import re
import subprocess
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parent.parent
MOCAP = Path(os.environ.get("REACHCAST_MOCAP", PROJECT.parent / "shared" / "mocap"))


def commands() -> str:
    text = (PROJECT / "README.md").read_text(encoding="utf-8")
    found = re.search(r"## Your own recordings, in ten minutes.*?```sh\n(.*?)```", text, re.DOTALL)
    assert found
    return found[1]


def test_the_readme_leads_from_bvh_files_to_a_prediction(tmp_path: Path) -> None:
    if not (MOCAP / "bvh").is_dir():
        pytest.skip(f"recordings are missing: {MOCAP} (set REACHCAST_MOCAP)")
    out = tmp_path / "out"
    script = commands().replace("../shared/mocap", str(MOCAP)).replace("out/mine", str(out / "mine"))
    out.mkdir()
    done = subprocess.run(["bash", "-euo", "pipefail", "-c", script], cwd=PROJECT, capture_output=True, text=True,
                          timeout=900, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "nothing is wrong" in done.stdout and "rejected" in done.stdout
    report = json.loads((out / "mine" / "report.json").read_text(encoding="utf-8"))
    assert "iclone_002_06.bvh" in json.dumps(report)
    assert (out / "mine" / "lift.blend").stat().st_size > 0
