# SPDX-License-Identifier: GPL-3.0-or-later
"""The error that is expected at a place: what the neighbours' own predictions were wrong by when they were left out."""
from __future__ import annotations

import math
import os
import shutil
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import bpy
import numpy as np
from reachcast import left_out, native
from reachcast.corpora import default_corpus
from reachcast.left_out import LeftOut, compute, expected_error, known
from reachcast.scene.predict_action import TRANSFERS, WEIGHTS, predict_motion
from rig_cases import mannequin

PATIENCE_S = 60.0


class ExpectedError(unittest.TestCase):
    def setUp(self) -> None:
        self.path = os.fspath(default_corpus())
        self.addCleanup(left_out.forget)

    def test_it_is_what_the_cross_validation_takes_the_median_of(self) -> None:
        core, found = native.core(), compute(self.path)
        with core.Corpus.open(self.path) as corpus:
            transfers = [motion for motion in corpus.motions() if motion.phase == "transfer" and motion.hands == "both"]
            row = core.cross_validate(corpus, [{}], "subject")[0]
        originals = [found.errors[motion.id] for motion in transfers if not motion.mirrored]
        self.assertEqual(found.what, "people")
        self.assertAlmostEqual(float(np.median(originals)), row["median"], places=12)
        by_origin = {motion.origin: found.errors[motion.id] for motion in transfers if not motion.mirrored}
        for motion in transfers:
            self.assertEqual(found.errors[motion.id], by_origin[motion.origin])

    def test_it_is_the_weighted_mean_over_neighbours_that_are_known(self) -> None:
        found = LeftOut({1: 0.02, 2: 0.08, 3: math.inf}, "people")
        self.assertAlmostEqual(expected_error({1: 3.0, 2: 1.0, 3: 5.0, 4: 9.0}, found), 0.035)
        self.assertIsNone(expected_error({3: 1.0, 4: 1.0}, found))
        self.assertIsNone(expected_error({}, found))

    def test_blender_quits_in_peace_while_the_thread_is_at_work(self) -> None:
        code = (f"import sys, time; sys.path.insert(0, {os.fspath(Path(left_out.__file__).parents[1])!r}); "
                f"import addon_utils; addon_utils.enable('reachcast'); from reachcast import left_out; "
                f"print('known:', left_out.known({self.path!r})); time.sleep(0.2)")
        done = subprocess.run([bpy.app.binary_path, "-b", "--factory-startup", "--python-exit-code", "1", "--python-expr",
                               code], capture_output=True, text=True, check=False, timeout=120)
        self.assertIn("known: None", done.stdout)  # it was at work
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_an_action_says_what_it_rests_on(self) -> None:
        rig, shelf = mannequin(), bpy.data.objects.new("Shelf", None)
        shelf.location = (0.1, -0.42, 1.1)
        bpy.context.collection.objects.link(shelf)
        bpy.context.view_layer.update()
        result = predict_motion(rig, shelf, phases=("reach", "transfer", "return"))
        action = bpy.data.actions[result.action]
        neighbours = dict(zip(action[TRANSFERS], action[WEIGHTS]))
        self.assertEqual(neighbours, {near.id: near.weight for near in result.neighbours if near.phase == "transfer"})
        self.assertEqual(os.path.realpath(action["reachcast_corpus"]), os.path.realpath(self.path))
        self.assertTrue(0.005 < expected_error(neighbours, compute(self.path)) < 0.3)

    def wait_for(self, path: str) -> LeftOut:
        began = time.perf_counter()
        while (found := known(path)) is None:
            self.assertLess(time.perf_counter() - began, PATIENCE_S)
            time.sleep(0.05)
        return found

    def test_it_is_computed_beside_and_anew_when_the_file_changes(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            copy = str(Path(folder) / "copy.sqlite")
            shutil.copy(self.path, copy)
            self.assertIsNone(known(copy))
            first = self.wait_for(copy)
            self.assertIs(known(copy), first)
            with native.core().Corpus.open_for_writing(copy) as corpus:
                corpus.remove([motion.id for motion in corpus.motions() if motion.phase == "transfer"][:40])
            self.assertIsNone(known(copy))
            self.assertLess(len(self.wait_for(copy).errors), len(first.errors))

    def test_a_file_that_is_no_corpus_says_why(self) -> None:
        found = self.wait_for(__file__)
        self.assertFalse(found.errors)
        self.assertIn("not an SQLite file", found.why)
        self.assertIsNone(known("/nowhere.sqlite"))
