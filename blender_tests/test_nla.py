# SPDX-License-Identifier: GPL-3.0-or-later
"""New Actions on NLA strips: they play what the Actions play, the next prediction lies above them, nothing is lost."""
from __future__ import annotations

import bpy
import numpy as np
from mathutils import Matrix
from reachcast.scene.action_writer import curves_of
from reachcast.scene.action_writer import curves_of
from reachcast.scene.measure import Samples, sample
from reachcast.scene.nla_strips import predicted_action, put_on_strips
from reachcast.scene.predict_action import PredictionResult
from reachcast.scene.read_rig import read_rig
from reachcast.scene.several_targets import predict_to_targets
from scene_cases import Scene

#: Metres: single precision at a few metres from the origin.
SAME_M = 2e-6


class Strips(Scene):
    def setUp(self) -> None:
        super().setUp()
        self.furnish()

    def seen(self, result: PredictionResult, before: int = 0, after: int = 0) -> Samples:
        frames = range(result.first_frame - before, result.frames["end"] + 1 + after)
        return sample(self.rig, read_rig(self.rig), frames, self.box)

    def assert_same(self, left: Samples, right: Samples, rows: slice = slice(None)) -> None:
        self.assertLess(np.abs(left.joints[rows] - right.joints[rows]).max(), SAME_M)
        self.assertLess(np.abs(left.box_origins[rows] - right.box_origins[rows]).max(), SAME_M)
        self.assertLess(np.abs(left.box_axes[rows] - right.box_axes[rows]).max(), SAME_M)

    def test_a_strip_plays_what_the_action_plays(self) -> None:
        for rig_name in ("mannequin", "metarig"):
            with self.subTest(rig=rig_name):
                self.furnish(Matrix.Rotation(0.4, 4, "Z"), rig_name)
                result = self.predict(start_frame=11)
                as_action = self.seen(result, 5, 20)
                self.assertGreater(np.ptp(as_action.box_origins, axis=0).max(), 0.1)
                self.assertEqual(put_on_strips([result], self.rig, self.box), [result.action, result.box_action])
                self.assertIsNone(self.rig.animation_data.action)
                self.assertIsNone(self.box.animation_data.action)
                self.assertEqual(predicted_action(self.rig).name, result.action)
                self.assert_same(self.seen(result, 5, 20), as_action)

    def test_a_later_prediction_plays_after_the_first(self) -> None:
        first = self.predict(start_frame=1)
        alone = self.seen(first)
        put_on_strips([first], self.rig, self.box)
        bpy.context.scene.frame_set(1)
        self.home.location.x += 0.05
        second = self.predict(start_frame=first.frames["end"] + 30)
        active = self.seen(second, after=10)
        put_on_strips([second], self.rig, self.box)
        self.assert_same(self.seen(second, after=10), active)
        self.assert_same(self.seen(first), alone)
        self.assertEqual(predicted_action(self.rig).name, second.action)

    def test_the_same_task_again_adds_a_track_and_keeps_the_first(self) -> None:
        names = []
        for _ in range(3):
            names += put_on_strips([self.predict(start_frame=1)], self.rig, self.box)
        tracks = [track for owner in (self.rig, self.box) for track in owner.animation_data.nla_tracks]
        self.assertEqual(len(set(names)), 6)
        self.assertEqual([len(track.strips) for track in tracks], [1] * 6)
        self.assertEqual({track.strips[0].action.name for track in tracks}, set(names))

    def test_the_users_action_and_tracks_stay(self) -> None:
        self.rig["lamp"] = 0.0
        self.rig.keyframe_insert('["lamp"]', frame=1)
        own = self.rig.animation_data.action
        mine = self.rig.animation_data.nla_tracks.new()
        mine.strips.new("lamp", 1, own)
        put_on_strips([self.predict()], self.rig, self.box)
        self.assertEqual(self.rig.animation_data.nla_tracks[0].strips[0].action, own)
        self.assertEqual(len(list(curves_of(own))), 1)

    def test_of_several_targets_the_first_plays(self) -> None:
        other = self.empty("Other", Matrix(), (0.1, *self.shelf.location.yz))
        found = predict_to_targets(self.rig, [self.shelf, other], corpus=self.corpus, home=self.home, box=self.box)
        active = self.seen(found.results[0])
        put_on_strips(found.results, self.rig, self.box)
        self.assertEqual([track.mute for track in self.rig.animation_data.nla_tracks], [False, True])
        self.assert_same(self.seen(found.results[0]), active)

    def test_an_edited_action_that_moves_the_rig_is_still_refused(self) -> None:
        result = self.predict()
        self.rig.keyframe_insert("location", frame=1)
        put_on_strips([result], self.rig, self.box)
        self.refused("NLA strip", result.action)

    def test_nla_that_is_switched_off_is_an_error_and_the_action_stays(self) -> None:
        result = self.predict()
        self.box.animation_data.use_nla = False
        with self.assertRaisesRegex(ValueError, "NLA of 'Box' is switched off"):
            put_on_strips([result], self.rig, self.box)
        self.assertEqual(self.rig.animation_data.action.name, result.action)
        self.assertFalse(self.rig.animation_data.nla_tracks)

    def test_the_button_puts_them_there_when_asked(self) -> None:
        settings = bpy.context.scene.reachcast
        settings.rig, settings.shelf, settings.home, settings.box = self.rig, self.shelf, self.home, self.box
        settings.corpus, settings.strips = self.corpus, True
        for count in (1, 2):
            self.assertEqual(bpy.ops.reachcast.predict_motion(), {"FINISHED"})
            self.assertEqual(len(self.rig.animation_data.nla_tracks), count)
            self.assertEqual(len(self.box.animation_data.nla_tracks), count)
        self.assertIsNone(self.rig.animation_data.action)
