#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the zip that Blender installs, one for each native module that has been built in addon/reachcast.

    /usr/bin/python3 addon/make_zip.py [--out build]

The name says version, platform and Python: reachcast-0.1.0-linux-x86_64-cpython-311.zip. Blender 3.4 to 4.1 read
bl_info from it; 4.2 and later may also take it as an extension, by the blender_manifest.toml that is written from the
same facts. The same files give the same bytes.
"""
from __future__ import annotations

import argparse
import ast
import sys
import zipfile
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent / "reachcast"
MODULE = "reachcast_core"
PLATFORMS = {"linux-x86_64": ("x86_64-linux-gnu", "linux-x64"), "linux-aarch64": ("aarch64-linux-gnu", "linux-arm64")}
EPOCH = (1980, 1, 1, 0, 0, 0)  # the oldest time that a zip knows
LEFT_OUT = {"__pycache__", ".mypy_cache"}


def bl_info() -> dict[str, object]:
    """The literal in the package's __init__.py, read as Blender reads it: without running the file."""
    tree = ast.parse((PACKAGE / "__init__.py").read_text(encoding="utf-8"))
    for node in tree.body:
        if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "bl_info":
            return ast.literal_eval(node.value)
    raise ValueError(f"{PACKAGE / '__init__.py'} has no literal bl_info")


def manifest(info: dict[str, object], platform: str) -> str:
    version = ".".join(map(str, info["version"]))  # type: ignore[call-overload]
    return f'''schema_version = "1.0.0"
id = "reachcast"
version = "{version}"
name = "{info["name"]}"
tagline = "Predicts how a person carries a box to a shelf"
maintainer = "{info["author"]}"
type = "add-on"
blender_version_min = "4.2.0"
license = ["SPDX:GPL-3.0-or-later"]
platforms = ["{platform}"]
tags = ["Animation", "Rigging"]

[permissions]
files = "Read corpora of recorded motions and bone maps, write corpora"
'''


def platform_of(module: Path) -> tuple[str, str, str]:
    """(platform, Python, Blender's word for the platform) of a module's file name, reachcast_core.PYTHON-TRIPLE.so."""
    for platform, (triple, word) in PLATFORMS.items():
        if module.name.endswith(f"-{triple}.so"):
            return platform, module.name.removeprefix(f"{MODULE}.").removesuffix(f"-{triple}.so"), word
    raise ValueError(f"{module.name} is for no platform that Reachcast knows: {', '.join(PLATFORMS)}")


def files(module: Path) -> list[Path]:
    """Everything that is installed, in one order: the package with this native module and no other."""
    return sorted(path for path in PACKAGE.rglob("*") if path.is_file() and not LEFT_OUT & set(path.parts)
                  and (path == module or path.suffix not in {".so", ".pyd", ".pyc"}) and not path.name.startswith("."))


def make_zip(module: Path, folder: Path) -> Path:
    info = bl_info()
    platform, python, word = platform_of(module)
    version = ".".join(map(str, info["version"]))  # type: ignore[call-overload]
    target = folder / f"reachcast-{version}-{platform}-{python}.zip"
    unfinished = target.with_suffix(".part")
    with zipfile.ZipFile(unfinished, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        def add(name: str, data: bytes) -> None:
            entry = zipfile.ZipInfo(name, EPOCH)
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, data, zipfile.ZIP_DEFLATED, 9)

        for path in files(module):
            add(path.relative_to(PACKAGE.parent).as_posix(), path.read_bytes())
        add("reachcast/blender_manifest.toml", manifest(info, word).encode())
        add("reachcast/LICENSE", (PACKAGE.parent.parent / "LICENSE").read_bytes())
    unfinished.replace(target)
    return target


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=PACKAGE.parent.parent / "build", help="the folder (default: build)")
    folder = parser.parse_args().out
    modules = sorted(PACKAGE.glob(f"{MODULE}.*.so"))
    if not modules:
        sys.exit(f"There is no {MODULE} in {PACKAGE}: build it first (cmake --preset release && "
                 f"cmake --build --preset release).")
    folder.mkdir(parents=True, exist_ok=True)
    for module in modules:
        target = make_zip(module, folder)
        print(f"{target} ({target.stat().st_size / 1e6:.1f} MB)")


if __name__ == "__main__":
    main()
