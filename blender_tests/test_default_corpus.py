# SPDX-License-Identifier: GPL-3.0-or-later
"""The corpus that ships: it says that it is simulated, and lifts from it are sound on bodies it does not hold."""
from __future__ import annotations

import unittest

import bpy
import numpy as np
from lift_cases import HEIGHTS, STATURES, Place, lift_scene, rig_of
from reachcast import native
from reachcast.corpora import default_corpus
from reachcast.scene.measure import foot_slip, measure_lift, sample
from reachcast.scene.read_rig import read_rig
from reachcast.scene.read_task import read_box

PROMISED_M = 1e-3
FASTEST_RAD_S = 15.0
MOST_TWIST_DEG = 90.0


class DefaultCorpus(unittest.TestCase):
    def test_it_says_what_it_is(self) -> None:
        core = native.core()
        corpus = core.Corpus.open(default_corpus())
        self.assertEqual(corpus.meta["kind"], "simulated")
        self.assertIn("nobody was recorded", corpus.meta["description"])
        motions = [motion for motion in corpus.motions() if motion.origin.startswith("paper/")]
        people = {motion.subject_id: motion.subject for motion in motions}
        self.assertEqual(sorted(person.sex for person in people.values()), ["female"] * 10 + ["male"] * 10)
        self.assertEqual([min(person.stature for person in people.values()),
                          max(person.stature for person in people.values())], [1.47, 1.95])
        for phase in ("transfer", "return", "reach", "retrieve"):
            for mirrored in (False, True):
                found = [motion for motion in motions if motion.phase == phase and motion.mirrored == mirrored]
                self.assertEqual(len(found), 20 * 30 * 2)

    def test_lifts_from_it(self) -> None:
        """Every shelf height, short and tall people, ahead and to the side: measured as recorded lifts are."""
        refused = []
        for stature in (STATURES[0], STATURES[-1]):
            scene = lift_scene(rig_of("mannequin", stature))
            for number, height in enumerate(HEIGHTS[:-1]):
                place = Place(height, (0, 60, -60)[number % 3], 0.45, True)
                with self.subTest(stature=stature, place=str(place)):
                    scene.arrange(place, ("floor", "waist")[number % 2])
                    try:
                        result = scene.predict(None, start_frame=1)
                    except ValueError as error:
                        refused.append(str(error))
                        continue
                    self.assertEqual(bpy.data.actions[result.action]["reachcast_corpus_kind"], "simulated")
                    self.check(scene, result.frames)
        self.assertLessEqual(len(refused), 1, refused)

    def check(self, scene, events) -> None:  # type: ignore[no-untyped-def]
        skeleton = read_rig(scene.rig)
        samples = sample(scene.rig, skeleton, range(1, events["end"] + 1), scene.box)
        measures = measure_lift(samples, skeleton, dict(events), bpy.context.scene.render.fps, read_box(scene.box),
                                np.array(scene.shelf.matrix_world.translation))
        for name in ("landing_m", "grasp_m", "held_m", "left_foot_m"):
            self.assertLess(getattr(measures, name), PROMISED_M, name)
        self.assertLess(foot_slip(samples, "right"), PROMISED_M)
        self.assertGreaterEqual(min(measures.least_elbow_deg, measures.least_knee_deg), 0.0)
        self.assertLess(measures.forearm_twist_deg, MOST_TWIST_DEG)
        self.assertLess(measures.fastest_rad_s, FASTEST_RAD_S)


if __name__ == "__main__":
    unittest.main()
