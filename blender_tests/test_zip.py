# SPDX-License-Identifier: GPL-3.0-or-later
"""The zip that users install: what is in it, and that its installed copy works in a clean user folder."""
from __future__ import annotations

import os
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
sys.path[:0] = [os.fspath(HERE), os.fspath(HERE.parent / "addon")]
import corpora  # noqa: E402
import make_zip  # noqa: E402


@pytest.fixture(scope="module")
def archive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("zip")
    command = [sys.executable, os.fspath(HERE.parent / "addon" / "make_zip.py"), "--out", os.fspath(folder)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    (found,) = folder.glob("*.zip")
    return found


def test_contents(archive: Path) -> None:
    with zipfile.ZipFile(archive) as opened:
        names = opened.namelist()
        manifest = tomllib.loads(opened.read("reachcast/blender_manifest.toml").decode())
    assert all(name.startswith("reachcast/") for name in names)
    assert len([name for name in names if name.endswith(".so")]) == 1
    assert not [name for name in names if "__pycache__" in name or name.endswith(".pyc")]
    assert "reachcast/rigs/presets/mixamo.json" in names
    assert archive.stat().st_size < 12e6
    info = make_zip.bl_info()
    assert manifest["version"] == ".".join(map(str, info["version"]))
    assert (manifest["id"], manifest["type"], manifest["license"]) == ("reachcast", "add-on", ["SPDX:GPL-3.0-or-later"])


def test_the_same_files_give_the_same_bytes(archive: Path, tmp_path: Path) -> None:
    (module,) = make_zip.PACKAGE.glob("reachcast_core.*.so")
    assert make_zip.make_zip(module, tmp_path).read_bytes() == archive.read_bytes()


def test_a_module_of_another_platform_is_named() -> None:
    with pytest.raises(ValueError, match="reachcast_core.cpython-311-riscv64-linux-gnu.so is for no platform"):
        make_zip.platform_of(Path("reachcast_core.cpython-311-riscv64-linux-gnu.so"))


def test_the_installed_copy(archive: Path, tmp_path: Path) -> None:
    corpus = [os.fspath(corpora.recorded_corpus())] if (corpora.MOCAP / "omomo").is_dir() else []
    folders = {f"BLENDER_USER_{kind}": os.fspath(tmp_path / kind.lower())
               for kind in ("SCRIPTS", "CONFIG", "DATAFILES")}
    for folder in folders.values():
        Path(folder).mkdir()
    done = subprocess.run(["blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python",
                           os.fspath(HERE / "installed_checks.py"), "--", os.fspath(archive), *corpus],
                          capture_output=True, text=True, env={**os.environ, **folders}, check=False, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "installed copy works" in done.stdout
    assert "Traceback" not in done.stdout + done.stderr
