# SPDX-License-Identifier: GPL-3.0-or-later
"""reachcast_core and the recordings that its tests read: in $REACHCAST_MOCAP, else in ../shared/mocap beside the project."""

import os
import sys
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parent.parent
sys.path.insert(0, os.environ.get("REACHCAST_MODULE_DIR", str(PROJECT / "addon" / "reachcast")))
rc = pytest.importorskip("reachcast_core", reason="reachcast_core is not built for this Python")

MOCAP = Path(os.environ.get("REACHCAST_MOCAP", PROJECT.parent / "shared" / "mocap"))


def need(folder):
    if not (MOCAP / folder).is_dir():
        pytest.skip(f"recordings are missing: {MOCAP / folder}")
    return MOCAP / folder


def files_in(folder, pattern):
    """For parametrize: the files, or one that skips with a message."""
    return sorted((MOCAP / folder).glob(pattern)) or [MOCAP / folder / "missing"]


def need_file(path):
    if not path.exists():
        pytest.skip(f"recordings are missing: {path}")
