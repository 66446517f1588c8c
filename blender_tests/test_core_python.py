# SPDX-License-Identifier: GPL-3.0-or-later
"""reachcast_core from Python: people, recordings, corpora and predictions give what the design promises, and refuse in
words.

Runs in Blender with the other tests, and alone:  /usr/bin/python3 blender_tests/test_core_python.py
"""
from __future__ import annotations

import math
import tempfile
import unittest
from pathlib import Path
from typing import Any

import numpy as np
from core_cases import Refusing, rc, with_nan

EXACT_M = 1e-6  #: of links and grips


class People(Refusing):
    def test_lengths_come_back_from_the_body(self) -> None:
        lengths = {name: value * 1.05 for name, value in rc.Body.from_stature(1.7, sex="female").lengths.items()}
        self.assertEqual(set(lengths), set(rc.SEGMENTS))
        body = rc.Body(lengths, stature=1.7)
        for name, value in lengths.items():
            self.assertAlmostEqual(body.lengths[name], value, places=9, msg=name)
        again = rc.Body.from_posture(body.posture, 1.7)
        np.testing.assert_array_equal(again.posture, body.posture)

    def test_a_body_stands_in_its_own_frame(self) -> None:
        for stature in (1.3, 1.72, 2.1):
            posture = dict(zip(rc.JOINTS, rc.Body.from_stature(stature).posture))
            np.testing.assert_allclose((posture["left_ankle"] + posture["right_ankle"])[:2], 0.0, atol=1e-12)
            self.assertGreater(posture["right_hip"][0], 0.0)
            self.assertGreater(posture["right_ball"][1], posture["right_ankle"][1])
            self.assertLess(posture["nasion"][2], stature)

    def test_bad_arguments_are_named(self) -> None:
        self.refuses("stature", call=lambda: rc.Subject(math.nan))
        self.refuses("stature", "17", call=lambda: rc.Subject(17.0))
        self.refuses("sex", call=lambda: rc.Subject(1.7, sex="x"))
        self.refuses("age", call=lambda: rc.Subject(1.7, age=-1))
        self.refuses("mass", call=lambda: rc.Subject(1.7, mass=0))
        self.refuses("stature", call=lambda: rc.Body.from_stature(math.nan))
        self.refuses("forearm", call=lambda: rc.Body({"forearm": -0.2}, stature=1.7))
        self.refuses("wing", call=lambda: rc.Body({"wing": 0.2}, stature=1.7))
        posture = rc.Body.from_stature(1.7).posture
        self.refuses("posture", "(26, 3)", call=lambda: rc.Body.from_posture(posture[1:], 1.7))
        self.refuses("posture", call=lambda: rc.Body.from_posture(with_nan(posture, (3, 0)), 1.7))
        self.refuses("home", call=lambda: rc.Task([0, math.nan, 0], [0, 0.4, 1]))
        self.refuses("target", call=lambda: rc.Task([0, 0.4, 0], [0, 0.4]))
        self.refuses("width", call=lambda: rc.Box(width=-0.3))
        self.refuses("handle_height", call=lambda: rc.Box(height=0.2, handle_height=0.3))
        self.refuses("home_yaw", call=lambda: rc.Task([0, 0.4, 0], [0, 0.4, 1], home_yaw=math.nan))


class Temporary(Refusing):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory(prefix="reachcast-core-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def made_reaches(self, count: int = 3, phase: str = "transfer") -> list[Any]:
        """Statues whose arms are lifted: enough to store and to predict from."""
        reaches = []
        for number in range(count):
            stature = 1.6 + 0.1 * number
            posture, t = rc.Body.from_stature(stature).posture, np.linspace(0.0, 1.0, 25)[:, None, None]
            moving = {"grip", "front", "back", "wrist"}
            lifted = [i for i, name in enumerate(rc.JOINTS) if name.split("_")[-1] in moving]
            positions = np.repeat(posture[None], 25, axis=0)
            positions[:, lifted] += np.array([0.0, 0.35, 0.1]) + t * np.array([0.0, 0.02, 0.4 + 0.1 * number])
            clip = rc.Clip(list(rc.JOINTS), positions, 24.0, "statue")
            reaches.append(rc.cut_reach(clip, 0, 24, rc.Subject(stature), phase, f"statue {number}", floor_z=0.0))
        return reaches

    def made_corpus(self) -> Any:
        path = self.folder / "statues.sqlite"
        with rc.Corpus.create(path) as corpus:
            corpus.add_reaches(self.made_reaches())
        return rc.Corpus.open(path)


class Recordings(Temporary):
    def test_a_bvh_file_becomes_a_clip_in_metres(self) -> None:
        path = self.folder / "two.bvh"
        path.write_text("HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation "
                        "Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 50 0\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.5\n"
                        "0 100 0 0 0 0\n10 100 0 0 0 0\n", encoding="ascii")
        clip = rc.read_motion(str(path), metres_per_unit=0.01, up="y")
        self.assertEqual((clip.names[0], clip.rate, len(clip)), ("Hips", 2.0, 2))
        np.testing.assert_allclose(np.linalg.norm(np.diff(clip.positions[:, 0], axis=0)), 0.1, atol=1e-12)
        self.assertAlmostEqual(float(clip.positions[0, 0, 2]), 1.0)

    def test_a_file_that_cannot_be_read_is_named(self) -> None:
        self.refuses("none.bvh", call=lambda: rc.read_motion(str(self.folder / "none.bvh")))
        (self.folder / "cut.bvh").write_text("HIERARCHY\nROOT Hips\n{\nOFFSET 0 0\n", encoding="ascii")
        self.refuses("cut.bvh:5", "OFFSET", call=lambda: rc.read_motion(str(self.folder / "cut.bvh")))


class CorpusFile(Temporary):
    def test_motions_say_what_they_are(self) -> None:
        corpus = self.made_corpus()
        self.assertEqual(len(corpus), 6)
        first, image = corpus.motions()[:2]
        self.assertEqual((first.phase, first.origin), ("transfer", "statue 0"))
        self.assertEqual((first.mirrored, image.mirrored), (False, True))
        self.assertEqual(first.subject.stature, 1.6)
        self.assertAlmostEqual(first.duration, 1.0)
        np.testing.assert_allclose(image.target, first.target * [-1, 1, 1], atol=1e-12)
        self.assertEqual(first.target.shape, (3,))

    def test_codes_go_from_one_corpus_into_another(self) -> None:
        corpus, copy = self.made_corpus(), rc.Corpus.create(self.folder / "copy.sqlite")
        codes = corpus.load([motion.id for motion in corpus.motions()])
        self.assertEqual(len(copy.add(codes)), 6)
        for before, after in zip(codes, copy.load([motion.id for motion in copy.motions()])):
            np.testing.assert_array_equal(before.coefficients, after.coefficients)

    def test_files_that_are_no_corpus_are_refused(self) -> None:
        other = self.folder / "other.sqlite"
        self.refuses("none.sqlite", call=lambda: rc.Corpus.open(self.folder / "none.sqlite"))
        other.write_bytes(b"not a database at all, only some text that is longer than a header" * 20)
        self.refuses("other.sqlite", call=lambda: rc.Corpus.open(other))
        self.refuses("other.sqlite", call=lambda: rc.Corpus.create(other))
        self.refuses(self.folder.name, call=lambda: rc.Corpus.open(self.folder))


class Prediction(Temporary):
    def test_links_grips_and_box_are_exact(self) -> None:
        body, task = rc.Body.from_stature(1.7), rc.Task([0.0, 0.42, 0.7], [0.05, 0.42, 1.1])
        motion = rc.predict(self.made_corpus(), rc.Subject(1.7), task, body)
        frames = len(motion.times)
        self.assertEqual(motion.positions.shape, (frames, 27, 3))
        self.assertEqual((motion.box_positions.shape, motion.box_quaternions.shape), ((frames, 3), (frames, 4)))
        self.assertEqual(motion.joints, rc.JOINTS)
        at = {name: motion.positions[:, i] for i, name in enumerate(rc.JOINTS)}
        for side, sign in (("left", -0.5), ("right", 0.5)):
            for a, b in (("shoulder", "elbow"), ("elbow", "wrist"), ("wrist", "grip"), ("hip", "knee"),
                         ("knee", "ankle")):
                length = np.linalg.norm(at[f"{side}_{a}"] - at[f"{side}_{b}"], axis=1)
                self.assertLess(np.ptp(length), EXACT_M)
            held = slice(motion.events["grasp"], motion.events["release"] + 1)
            yaw = 2.0 * np.arctan2(motion.box_quaternions[:, 3], motion.box_quaternions[:, 0])
            along = np.stack([np.cos(yaw), np.sin(yaw), np.zeros(frames)], axis=1)
            handle = motion.box_positions + sign * task.object.grip_distance * along + [0, 0, task.object.handle_height]
            np.testing.assert_allclose(at[f"{side}_grip"][held], handle[held], atol=EXACT_M)
        np.testing.assert_allclose(motion.box_positions[-1], task.target, atol=EXACT_M)

    def test_the_result_says_what_it_rests_on(self) -> None:
        task = rc.Task([0, 0.42, 0.7], [0, 0.42, 1.1])
        motion = rc.predict(self.made_corpus(), rc.Subject(1.7), task, k=2, duration=1.5)
        self.assertAlmostEqual(sum(near.weight for near in motion.neighbours), 1.0)
        self.assertEqual(set(motion.neighbours[0].distances), {"target", "home", "stature"})
        self.assertIsInstance(motion.outside_data, bool)
        self.assertEqual([(phase, last - first) for phase, first, last in motion.phases], [("transfer", 1.5 * 24)])
        self.assertEqual(list(motion.events), ["grasp", "lift_off", "placed", "release", "end"])

    def test_phases_follow_one_another(self) -> None:
        task = rc.Task([0, 0.42, 0.7], [0, 0.42, 1.1])
        self.made_corpus().close()
        with rc.Corpus.open_for_writing(self.folder / "statues.sqlite") as corpus:
            reaches = self.made_reaches(phase="reach")
            corpus.add_reaches(reaches + [reach.reversed() for reach in reaches])
        corpus = rc.Corpus.open(self.folder / "statues.sqlite")
        motion = rc.predict(corpus, rc.Subject(1.7), task, k=1, phases=["reach", "transfer", "return"],
                            duration={"reach": 1.0})
        self.assertEqual([phase for phase, _, _ in motion.phases], ["reach", "transfer", "return"])
        self.assertEqual({near.phase for near in motion.neighbours}, {"reach", "transfer", "return"})
        self.assertEqual(list(motion.events), ["grasp", "lift_off", "placed", "release", "end"])
        self.assertEqual(motion.phases[0][1:], (0, 24))
        for phases, reason in ((["transfer", "reach"], "at rest"), ([], "empty"), (["lift"], "'lift'")):
            self.refuses(reason, call=lambda: rc.predict(corpus, rc.Subject(1.7), task, phases=phases))
        self.refuses("retrieve", call=lambda: rc.predict(corpus, rc.Subject(1.7), task, duration={"retrieve": 1.0}))

    def test_options_out_of_range_are_named(self) -> None:
        corpus, who, what = self.made_corpus(), rc.Subject(1.7), rc.Task([0, 0.42, 0.7], [0, 0.42, 1.1])
        self.refuses("frame_rate", call=lambda: rc.predict(corpus, who, what, frame_rate=0))
        self.refuses("frame_rate", call=lambda: rc.predict(corpus, who, what, frame_rate=math.nan))
        self.refuses("k is 0", call=lambda: rc.predict(corpus, who, what, k=0))
        self.refuses("duration", call=lambda: rc.predict(corpus, who, what, duration=-1.0))
        self.refuses("cm out of reach", call=lambda: rc.predict(corpus, who, rc.Task([0, 0.42, 0.7], [0, 0.42, 3.0])))
        self.refuses("home and target", call=lambda: rc.predict(corpus, who, rc.Task([0, 0.4, 1], [0, 0.4, 1])))
        corpus.close()
        self.refuses("closed", call=lambda: rc.predict(corpus, who, what))

    def test_an_empty_corpus_is_refused(self) -> None:
        corpus = rc.Corpus.create(self.folder / "empty.sqlite")
        self.refuses("empty.sqlite", "no motions",
                     call=lambda: rc.predict(corpus, rc.Subject(1.7), rc.Task([0, 0.42, 0.7], [0, 0.42, 1.1])))


if __name__ == "__main__":
    unittest.main()
