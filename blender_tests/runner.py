# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the tests inside Blender and ends in one line: N passed, N failed, N skipped.

    blender -b --factory-startup --python-exit-code 1 --python blender_tests/runner.py -- [pattern]

`pattern` selects tests whose dotted name contains it. Files that open a window (test_*_window.py) or that need
pytest are not run here. Every test begins from a clean factory scene with the add-on enabled.
"""
from __future__ import annotations

import os
import sys
import time
import unittest
from collections.abc import Iterator
from pathlib import Path

import addon_utils
import bpy

HERE = Path(__file__).resolve().parent
ADDON = "reachcast"
NOT_HERE = "_window.py"  #: how the names of files end that open a window


class CleanSceneResult(unittest.TestResult):
    """Prints each test as it ends; gives every test a factory scene."""

    passed = 0

    def startTest(self, test: unittest.TestCase) -> None:
        self._began = time.perf_counter()
        clean_scene()
        super().startTest(test)

    def addSuccess(self, test: unittest.TestCase) -> None:
        self.passed += 1
        self._line("ok", test)

    def addSkip(self, test: unittest.TestCase, reason: str) -> None:
        super().addSkip(test, reason)
        self._line("skip", test, reason)

    def addFailure(self, test: unittest.TestCase, err: tuple) -> None:  # type: ignore[type-arg]
        super().addFailure(test, err)
        self._line("FAIL", test, self.failures[-1][1])

    def addError(self, test: unittest.TestCase, err: tuple) -> None:  # type: ignore[type-arg]
        super().addError(test, err)
        self._line("ERROR", test, self.errors[-1][1])

    def addSubTest(self, test: unittest.TestCase, subtest: unittest.TestCase,
                   err: tuple | None) -> None:  # type: ignore[type-arg]
        super().addSubTest(test, subtest, err)
        if err is not None:
            self._line("FAIL", subtest, self._exc_info_to_string(err, test))

    def _line(self, word: str, test: unittest.TestCase, note: str = "") -> None:
        seconds = time.perf_counter() - getattr(self, "_began", time.perf_counter())
        print(f"{word:5} {test.id()} ({seconds:.2f} s)" + (f"\n      {note.strip()}" if note else ""), flush=True)


def clean_scene() -> None:
    """Blender's factory scene, emptied, with the add-on enabled anew."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if addon_utils.enable(ADDON) is None:
        raise SystemExit(f"The add-on '{ADDON}' could not be enabled")


def needs_pytest(path: Path) -> bool:
    return any(line.startswith(("import pytest", "from pytest")) for line in
               path.read_text(encoding="utf-8").splitlines())


def tests_in(suite: unittest.TestSuite) -> Iterator[unittest.TestCase]:
    for item in suite:
        if isinstance(item, unittest.TestSuite):
            yield from tests_in(item)
        else:
            yield item


def main() -> int:
    pattern = (sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])[:1]
    sys.dont_write_bytecode = True
    sys.path[:0] = [os.fspath(HERE.parent / "addon"), os.fspath(HERE)]
    names = [path.stem for path in sorted(HERE.glob("test_*.py"))
             if not path.name.endswith(NOT_HERE) and not needs_pytest(path)]
    suite = unittest.defaultTestLoader.loadTestsFromNames(names)
    chosen = [test for test in tests_in(suite) if not pattern or pattern[0] in test.id()]
    result = CleanSceneResult()
    unittest.TestSuite(chosen).run(result)
    failed = len(result.failures) + len(result.errors)
    print(f"{result.passed} passed, {failed} failed, {len(result.skipped)} skipped", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
