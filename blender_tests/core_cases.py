# SPDX-License-Identifier: GPL-3.0-or-later
"""The native module for tests that run in Blender and without it, and what a refusal looks like."""
from __future__ import annotations

import math
import os
import sys
import unittest
from pathlib import Path
from typing import Any

import numpy as np

try:
    import bpy  # noqa: F401
    from reachcast import native
    rc = native.core()
except ImportError:
    sys.path.insert(0, os.environ.get("REACHCAST_MODULE_DIR",
                                      str(Path(__file__).resolve().parent.parent / "addon" / "reachcast")))
    import reachcast_core as rc  # noqa: F401


class Refusing(unittest.TestCase):
    def refuses(self, *words: str, call: Any) -> None:
        """`call` raises ValueError in one sentence that holds these words."""
        with self.assertRaises(ValueError) as caught:
            call()
        for word in words:
            self.assertIn(word, str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))


def with_nan(values: Any, place: tuple[int, ...]) -> np.ndarray:
    changed = np.array(values, dtype=float)
    changed[place] = math.nan
    return changed
