# SPDX-License-Identifier: GPL-3.0-or-later
"""Corpora that stay open between predictions."""
from __future__ import annotations

import os
import tempfile
import unittest
from pathlib import Path

from reachcast import corpora, native


class OpenedCorpora(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(corpora.close_all)
        self.core, self.folder = native.core(), Path(folder.name)

    def made(self, name: str) -> str:
        self.core.Corpus.create(self.folder / name).close()
        return os.fspath(self.folder / name)

    def test_same_file_is_opened_once_however_it_is_named(self) -> None:
        path = self.made("a.sqlite")
        self.assertIs(corpora.opened_corpus(self.core, path), corpora.opened_corpus(self.core, path))
        self.assertIs(corpora.opened_corpus(self.core, os.path.relpath(path)), corpora.opened_corpus(self.core, path))

    def test_file_in_the_place_of_another_is_opened_anew(self) -> None:
        path, other = self.made("a.sqlite"), self.made("b.sqlite")
        first = corpora.opened_corpus(self.core, path)
        os.replace(other, path)
        self.assertIsNot(corpora.opened_corpus(self.core, path), first)

    def test_what_is_wrong_with_a_file_is_said_each_time(self) -> None:
        path = self.made("a.sqlite")
        corpora.opened_corpus(self.core, path)
        os.remove(path)
        for _ in range(2):
            with self.assertRaisesRegex(ValueError, "does not exist"):
                corpora.opened_corpus(self.core, path)
        Path(path).write_text("no corpus" * 100, encoding="ascii")
        with self.assertRaisesRegex(ValueError, "not an SQLite file"):
            corpora.opened_corpus(self.core, path)
