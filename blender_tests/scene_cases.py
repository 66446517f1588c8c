# SPDX-License-Identifier: GPL-3.0-or-later
"""A small scene around the stand-in predictor: what most tests of `predict_motion` begin from."""
from __future__ import annotations

import math
import os
import tempfile
import unittest

import bpy
import fake_core
import numpy as np
from lift_cases import cuboid
from mathutils import Matrix
from reachcast.scene.measure import LiftMeasures, measure_lift, sample
from reachcast.scene.predict_action import PredictionResult, predict_motion
from reachcast.scene.read_rig import read_rig
from reachcast.scene.read_task import read_box
from rig_cases import RIGS

#: Metres: a tenth of what the project promises; keys are single precision.
LANDING_TOLERANCE = 1e-4


class Scene(unittest.TestCase):
    """A rig at the origin facing -y, a box before it, a shelf within reach of the stand-in's arms."""

    def setUp(self) -> None:
        installed = fake_core.installed()
        installed.start()
        self.addCleanup(installed.stop)
        handle, self.corpus = tempfile.mkstemp(suffix=".sqlite")
        os.close(handle)
        self.addCleanup(os.remove, self.corpus)

    def furnish(self, around: Matrix = Matrix(), rig_name: str = "mannequin") -> None:
        self.rig = RIGS[rig_name]()
        self.rig.matrix_world = around @ self.rig.matrix_world
        height = self.rig.data.bones["upper_arm.L"].head_local.z
        self.shelf = self.empty("Shelf", around, (0.0, -0.38, height - 0.28))
        self.home = self.empty("Home", around, (0.0, -0.36, height - 0.48))
        self.box = cuboid("Box", (0.36, 0.28, 0.24))
        self.box.matrix_world = self.home.matrix_world
        bpy.context.view_layer.update()

    def empty(self, name: str, around: Matrix, place: tuple[float, float, float]) -> bpy.types.Object:
        item = bpy.data.objects.new(name, None)
        bpy.context.collection.objects.link(item)
        item.matrix_world = around @ Matrix.Translation(place)
        return item

    def predict(self, **options: object) -> PredictionResult:
        return predict_motion(self.rig, self.shelf, **{"corpus": self.corpus, "home": self.home, "box": self.box,
                                                       **options})  # type: ignore[arg-type]

    def measured(self, result: PredictionResult) -> LiftMeasures:
        skeleton = read_rig(self.rig)
        samples = sample(self.rig, skeleton, range(result.first_frame, result.frames["end"] + 1), self.box)
        return measure_lift(samples, skeleton, dict(result.frames), 24.0, read_box(self.box),
                            np.array(self.shelf.matrix_world.translation))

    def refused(self, *words: str, **options: object) -> None:
        """Predicting is refused in one sentence that holds these words, and nothing has changed."""
        before = self.everything()
        with self.assertRaises(ValueError) as caught:
            self.predict(**options)
        for word in words:
            self.assertIn(word, str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))
        self.assertEqual(self.everything(), before)

    def everything(self) -> dict[str, object]:
        """What a failed prediction must leave as it was."""
        bpy.context.view_layer.update()
        return {
            "actions": sorted(action.name for action in bpy.data.actions),
            "objects": {item.name: tuple(map(tuple, item.matrix_world)) for item in bpy.data.objects
                        if not any(map(math.isnan, item.location))},
            "pose": {bone.name: tuple(map(tuple, bone.matrix_basis)) for bone in self.rig.pose.bones},
            "assigned": [item.animation_data and item.animation_data.action for item in (self.rig, self.box)],
            "frame": bpy.context.scene.frame_current,
        }
