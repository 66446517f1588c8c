# SPDX-License-Identifier: GPL-3.0-or-later
"""Corpora stay open between predictions: the native core then keeps what it has read until the file changes."""
from __future__ import annotations

import functools
import os
from pathlib import Path
from types import ModuleType

DATA_FOLDER = Path(__file__).parent / "data"
_MOST_OPEN = 4


def default_corpus() -> Path | None:
    """The corpus that ships with the add-on, when there is one."""
    return next((path for path in sorted(DATA_FOLDER.glob("*")) if path.suffix in {".rcdb", ".sqlite", ".db"}), None)


def opened_corpus(core: ModuleType, path: str) -> object:
    """The corpus at `path`, opened for reading. ValueError or RuntimeError of reachcast_core when it is none.

    A file that another one has replaced since, or that was removed and made again, is opened anew.
    """
    try:
        status = os.stat(path)
    except OSError:
        return core.Corpus.open(path)  # which says what is wrong with the path
    return _opened(core, os.path.abspath(path), status.st_dev, status.st_ino)


def close_all() -> None:
    _opened.cache_clear()


@functools.lru_cache(maxsize=_MOST_OPEN)
def _opened(core: ModuleType, path: str, _device: int, _file: int) -> object:
    return core.Corpus.open(path)
