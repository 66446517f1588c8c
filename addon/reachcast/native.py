# SPDX-License-Identifier: GPL-3.0-or-later
"""The one place that loads `reachcast_core`. The add-on registers without it; then the panel shows `reason()`."""
from __future__ import annotations

import importlib.machinery
import importlib.util
import sys
from pathlib import Path
from types import ModuleType

MODULE = "reachcast_core"
FOLDER = Path(__file__).parent
_BUILD = "build it with: cmake --preset release && cmake --build --preset release"

_reason: str | None = None


def core() -> ModuleType:
    """The native module, loaded once per process; ValueError says in one sentence why it cannot be."""
    module = find()
    if module is None:
        raise ValueError(_reason)
    return module


def find() -> ModuleType | None:
    """The native module or None. A failed attempt is repeated next time: the file may have been built since."""
    global _reason
    if MODULE in sys.modules:
        _reason = None
        return sys.modules[MODULE]
    module, _reason = _load(FOLDER)
    return module


def reason() -> str | None:
    """Why the native module is not available; None when it is."""
    find()
    return _reason


def _load(folder: Path) -> tuple[ModuleType | None, str | None]:
    path = _file_for_this_python(folder)
    if path is None:
        return None, _missing(folder)
    spec = importlib.util.spec_from_file_location(MODULE, path)
    if spec is None or spec.loader is None:
        return None, f"{path.name} is not a Python module."
    try:
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
    except (ImportError, OSError) as error:
        return None, f"{path.name} cannot be loaded: {error}; {_BUILD}."
    sys.modules[MODULE] = module
    return module, None


def _file_for_this_python(folder: Path) -> Path | None:
    for suffix in importlib.machinery.EXTENSION_SUFFIXES:
        path = folder / f"{MODULE}{suffix}"
        if path.is_file():
            return path
    return None


def _missing(folder: Path) -> str:
    suffix = importlib.machinery.EXTENSION_SUFFIXES[0]
    others = sorted(path.name for kind in ("so", "pyd") for path in folder.glob(f"{MODULE}*.{kind}"))
    if others:
        return (f"The native module is built for another Python: found {', '.join(others)}, "
                f"this Blender needs {MODULE}{suffix}; {_BUILD}.")
    return f"The native module {MODULE}{suffix} is missing from the add-on; {_BUILD}."
