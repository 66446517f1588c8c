# SPDX-License-Identifier: GPL-3.0-or-later
"""Schemes from Python: what predict and cross_validate take, what they give, and what they refuse in words.

Runs in Blender with the other tests, and alone:  /usr/bin/python3 blender_tests/test_statistics.py
"""
from __future__ import annotations

import math
import tempfile
import unittest
from pathlib import Path
from typing import Any

import numpy as np
from core_cases import Refusing, rc

TASK = ([0, 0.42, 0.7], [0, 0.42, 1.1])


def lifts() -> list[Any]:
    """Statues of three people whose arms are lifted, each a little farther."""
    reaches = []
    for number in range(9):
        stature = (1.6, 1.7, 1.8)[number % 3]
        posture, t = rc.Body.from_stature(stature).posture, np.linspace(0.0, 1.0, 25)[:, None, None]
        moving = {"grip", "front", "back", "wrist"}
        lifted = [i for i, name in enumerate(rc.JOINTS) if name.split("_")[-1] in moving]
        positions = np.repeat(posture[None], 25, axis=0)
        positions[:, lifted] += np.array([0.0, 0.35, 0.1]) + t * np.array([0.0, 0.02, 0.4 + 0.03 * number])
        clip = rc.Clip(list(rc.JOINTS), positions, 24.0, "statue")
        subject = rc.Subject(stature, sex="female", age=20 + stature)
        reaches.append(rc.cut_reach(clip, 0, 24, subject, "transfer", f"statue {number}", floor_z=0.0))
    return reaches


class Statistics(Refusing):
    corpus: Any
    folder: tempfile.TemporaryDirectory[str]

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = tempfile.TemporaryDirectory(prefix="reachcast-statistics-")
        with rc.Corpus.create(Path(cls.folder.name) / "statues.sqlite") as corpus:
            corpus.add_reaches(lifts())
        cls.corpus = rc.Corpus.open(Path(cls.folder.name) / "statues.sqlite")

    @classmethod
    def tearDownClass(cls) -> None:
        cls.corpus.close()
        cls.folder.cleanup()

    def predicted(self, **options: Any) -> Any:
        return rc.predict(self.corpus, rc.Subject(1.7), rc.Task(*TASK), **options)

    def test_a_table_has_a_row_for_every_scheme_and_one_is_best(self) -> None:
        schemes = [{"k": 1}, {"k": 3, "weights": "uniform"}, {"distances": {"task": 0.3, "stature": None}},
                   {"k": 8, "smoother": "kernel", "bandwidth": 0.4}, {"smoother": "linear", "ridge": 1.0, "sets": 1}]
        for leave_out, groups in (("motion", 9), ("subject", 3)):
            rows = rc.cross_validate(self.corpus, schemes, leave_out)
            self.assertEqual([row["k"] for row in rows], [1, 3, 5, 8, 5])
            self.assertEqual(sum(row["best"] for row in rows), 1)
            best = min(rows, key=lambda row: row["median"])
            for row in rows:
                self.assertEqual((row["motions"], row["out_of_reach"], row["failed"]), (9, 0, 0))
                self.assertEqual(row["groups"], groups)
                self.assertTrue(row["interval"][0] <= row["median"] <= row["interval"][1])
                self.assertTrue(row["quartiles"][0] <= row["median"] <= row["quartiles"][1])
                self.assertEqual(row["best"], row is best)
                again = rc.cross_validate(self.corpus, [row["scheme"]], leave_out, threads=1)[0]
                self.assertEqual((again["median"], again["interval"]), (row["median"], row["interval"]), row["label"])

    def test_the_seed_changes_the_interval_alone(self) -> None:
        a, b, c = (rc.cross_validate(self.corpus, [{}], seed=seed)[0] for seed in (1, 1, 2))
        self.assertEqual(a, b)
        self.assertEqual(a["median"], c["median"])

    def test_listed_schemes_are_schemes(self) -> None:
        self.assertEqual(len(rc.schemes("all")), 60)
        for scheme in rc.schemes("paper"):
            self.assertIn(scheme, rc.schemes("all"))
        rows = rc.cross_validate(self.corpus, rc.schemes("all"))
        self.assertEqual([row["scheme"] for row in rows], rc.schemes("all"))

    def test_predict_takes_a_scheme(self) -> None:
        np.testing.assert_array_equal(self.predicted(k=5).positions, self.predicted().positions)
        np.testing.assert_array_equal(self.predicted(scheme={}).positions, self.predicted().positions)
        np.testing.assert_array_equal(self.predicted(k=2, scheme={"weights": "uniform"}).positions,
                                      self.predicted(scheme={"k": 2, "weights": "uniform"}).positions)
        self.assertEqual([near.weight for near in self.predicted(k=1).neighbours], [1.0])
        self.assertFalse(any(near.mirrored for near in self.predicted(scheme={"mirrored": False}).neighbours))
        uniform = self.predicted(scheme={"k": 4, "weights": "uniform", "sets": 1}).neighbours
        self.assertEqual([near.weight for near in uniform], [0.25] * 4)
        line = self.predicted(scheme={"k": 9, "smoother": "linear"}).neighbours
        self.assertAlmostEqual(sum(near.weight for near in line), 1.0)

    def test_a_scheme_of_durations_needs_a_duration(self) -> None:
        scheme = {"ranks": ["task", "stature", "duration"]}
        self.refuses("duration", call=lambda: self.predicted(scheme=scheme))
        _, first, last = self.predicted(scheme=scheme, duration=1.5, frame_rate=20).phases[0]
        self.assertEqual(last - first, 30)

    def test_natural_variation_is_of_one_persons_like_tasks(self) -> None:
        found = rc.natural_variation(self.corpus, 0.10)  # of each three lifts, 9 cm apart, two pairs
        self.assertEqual((found["pairs"], found["groups"]), (6, 3))
        self.assertGreater(found["median"], 0.0)
        self.assertIsNone(rc.natural_variation(self.corpus, 0.01)["median"])
        self.refuses("within", call=lambda: rc.natural_variation(self.corpus, math.nan))

    def test_mistakes_in_schemes_are_named(self) -> None:
        for scheme, words in (({"neighbours": 5}, ["neighbours", "ranks or distances"]), ({"k": 0}, ["k is 0"]),
                              ({"k": 2.5}, ["k is 2.5"]), ({"k": True}, ["k is True"]), ({"k": 10**30}, ["k is 1000"]),
                              ({"ranks": ["task", "height"]}, ["'height'", "'stature'"]),
                              ({"ranks": ["task", "task"]}, ["'task'", "once"]), ({"ranks": []}, ["compares nothing"]),
                              ({"ranks": "task"}, ["ranks is 'task'"]), ({"ranks": [5]}, ["5"]),
                              ({"ranks": ["task"], "distances": ["task"]}, ["ranks", "distances"]),
                              ({"distances": {"task": -1}}, ["scale of task", "-1"]),
                              ({"weights": "gauss"}, ["'gauss'", "'triangular'"]),
                              ({"smoother": "spline"}, ["'spline'", "'kernel'"]), ({"mirrored": 1}, ["mirrored is 1"]),
                              ({"sets": 3}, ["sets is 3"]), ({"bandwidth": 0.5}, ["bandwidth", "'kernel'"]),
                              ({"smoother": "kernel", "bandwidth": math.nan}, ["bandwidth is nan"]),
                              ({"smoother": "kernel", "bandwidth": 0}, ["bandwidth is 0"]),
                              ({"smoother": "kernel", "weights": "uniform"}, ["weights", "'mean'"]),
                              ({"smoother": "kernel", "ridge": 0.1}, ["ridge", "'linear'"]), ({1: 2}, ["a key is 1"]),
                              (5, ["a scheme is 5"])):
            self.refuses(*words, call=lambda: rc.cross_validate(self.corpus, [scheme]))
            self.refuses(*words, call=lambda: self.predicted(scheme=scheme))

    def test_other_mistakes_are_named(self) -> None:
        self.refuses("leave_out is 'person'", call=lambda: rc.cross_validate(self.corpus, [{}], "person"))
        self.refuses("schemes is empty", call=lambda: rc.cross_validate(self.corpus, []))
        self.refuses("'leaveout'", "leave_out", call=lambda: rc.cross_validate(self.corpus, [{}], leaveout="motion"))
        self.refuses("'framerate'", "frame_rate", call=lambda: self.predicted(framerate=30))
        self.refuses("k is 2", "k is 3", call=lambda: self.predicted(k=2, scheme={"k": 3}))
        self.refuses("k is 0", call=lambda: self.predicted(k=0))
        self.refuses("'some'", call=lambda: rc.schemes("some"))


if __name__ == "__main__":
    unittest.main()
