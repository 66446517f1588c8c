# SPDX-License-Identifier: GPL-3.0-or-later
"""Rigs of other tools: which preset knows them, and a lift on each, measured in the evaluated scene."""
from __future__ import annotations

import os
import random
import unittest

import bpy
import corpora
import numpy as np
from lift_cases import BOX_SIZE, LiftScene, Place, cuboid, empty
from mathutils import Matrix, Vector
from published_rigs import PUBLISHED, build
from reachcast.rigs.rig_presets import detect, parse_preset, preset_text
from reachcast.scene.measure import foot_slip, measure_lift, sample
from reachcast.scene.read_rig import read_rig
from reachcast.scene.read_task import read_box
from rig_cases import RIGS, edit_bones, move_tail, set_rest_arms, set_rolls

PROMISED_M = 1e-3
STRETCH = 1e-4
MOST_TWIST_DEG = 90.0
FASTEST_RAD_S = 15.0


def names_of(rig: bpy.types.Object) -> list[str]:
    return [bone.name for bone in rig.data.bones]


def without_clavicles(rig: bpy.types.Object) -> None:
    def remove(bones: bpy.types.ArmatureEditBones) -> None:
        for side in "LR":
            bones[f"upper_arm.{side}"].use_connect = False
            bones[f"upper_arm.{side}"].parent = bones[f"shoulder.{side}"].parent
            bones.remove(bones[f"shoulder.{side}"])
    edit_bones(rig, remove)


class Detection(unittest.TestCase):
    def test_every_rig_is_recognised(self) -> None:
        for name, published in PUBLISHED.items():
            with self.subTest(rig=name):
                rig = build(name)
                found = read_rig(rig)
                self.assertIn(published.preset, found.bone_map.name)
                self.assertTrue(found.has("toe.L") and found.has("toe.R"))
                self.assertAlmostEqual(found.height, 1.75, delta=0.15)
                np.testing.assert_allclose(found.axes, [[-1, 0, 0], [0, -1, 0], [0, 0, 1]], atol=1e-5)

    def test_a_missing_bone_is_named(self) -> None:
        for name in PUBLISHED:
            with self.subTest(rig=name):
                bones = names_of(build(name))
                lost = detect(bones, name).segments["forearm.R"]
                with self.assertRaises(ValueError) as caught:
                    detect([bone for bone in bones if bone != lost], name)
                self.assertIn(f"forearm.R (bone '{lost}' is missing)", str(caught.exception))

    def test_a_map_comes_back_from_its_text(self) -> None:
        for name in PUBLISHED:
            bones = names_of(build(name))
            found = detect(bones, name)
            self.assertEqual(parse_preset(preset_text(found), "again").on(bones), found)

    def test_own_presets_come_first(self) -> None:
        bones = names_of(build("mixamo"))
        own = parse_preset(preset_text(detect(bones, "mixamo")).replace("Mixamo, MotionBuilder or CMU", "Mine"), "mine")
        self.assertEqual(detect(bones, "mixamo", [own]).name, "Mine")

    def test_bad_presets(self) -> None:
        for text, words in (('{"segments": {"head": []}}', ("head", "[]")),
                            ('{"segments": {"head": 3}}', ("head", "3")),
                            ('{"segments": {"head": "x"}, "prefix": "("}', ("prefix", "(")),
                            ('{"segments": {"head": "x"}, "prefix": 2}', ("prefix", "2"))):
            with self.subTest(text=text), self.assertRaises(ValueError) as caught:
                parse_preset(text, "mine.json")
            for word in words:
                self.assertIn(word, str(caught.exception))


class Shape(unittest.TestCase):
    """Every bone renamed: the skeleton's shape gives the map that the names gave."""

    def test_the_map_is_the_preset_s(self) -> None:
        for number, name in enumerate([*PUBLISHED, *RIGS]):
            with self.subTest(rig=name):
                rig = build(name, number) if name in PUBLISHED else RIGS[name]()
                bpy.context.view_layer.update()
                bones = dict(read_rig(rig).bone_map.segments)
                if name == "daz":  # two bones lie before the toes; which of them is the ball the names alone tell
                    bones.update({f"toe.{side}": f"{side.lower()}Metatarsals" for side in "LR"})
                draw = random.Random(number)
                names = {bone.name: f"{draw.getrandbits(48):012x}" for bone in rig.data.bones}
                for bone in list(rig.data.bones):
                    bone.name = names[bone.name]
                found = read_rig(rig)
                self.assertIn("shape", found.bone_map.name)
                self.assertEqual(found.bone_map.segments, {part: names[bone] for part, bone in bones.items()})

    def test_what_is_no_person_is_refused_in_a_sentence(self) -> None:
        for lost, words in (("thigh.R", "two legs"), ("shoulder.L", "two arms")):
            with self.subTest(lost=lost):
                rig = RIGS["mannequin"]()
                edit_bones(rig, lambda bones: [bones.remove(bone) for bone in
                                               [*bones[lost].children_recursive, bones[lost]]])
                for number, bone in enumerate(list(rig.data.bones)):
                    bone.name = f"b{number}"
                with self.assertRaisesRegex(ValueError, words):
                    read_rig(rig)


class Lifts(unittest.TestCase):
    """Any bone rolls, objects scaled by a hundredth and lying on their backs: the hands are where they must be."""

    def test_hands_feet_and_lengths(self) -> None:
        corpus = os.fspath(corpora.recorded_corpus())
        for number, name in enumerate(PUBLISHED):
            with self.subTest(rig=name):
                bpy.ops.wm.read_factory_settings(use_empty=True)
                bpy.ops.preferences.addon_enable(module="reachcast")
                scene = LiftScene(build(name, number), empty("Shelf", Matrix()), empty("Home", Matrix()),
                                  cuboid("Box", BOX_SIZE))
                scene.arrange(Place(1.1, 20, 0.45, True), "waist")
                result = scene.predict(corpus, start_frame=1)
                self.check_by_sight(scene, result.frames)
                self.check_by_measure(scene, result.frames)

    def test_missing_toes_hands_that_point_elsewhere_and_rest_arms(self) -> None:
        changes = {"no toes": lambda rig: edit_bones(rig, lambda bones: [bones.remove(bones[f"toe.{s}"]) for s in "LR"]),
                   "hands aside": lambda rig: edit_bones(rig, lambda bones: [move_tail(bones[f"hand.{s}"], Vector(
                       (0.03 if s == "L" else -0.03, -0.06, -0.05))) for s in "LR"]),
                   "no clavicles": without_clavicles,
                   "arms down": lambda rig: set_rest_arms(rig, 3.0), "A": lambda rig: set_rest_arms(rig, 45.0),
                   "T": lambda rig: set_rest_arms(rig, 90.0)}
        for number, (what, change) in enumerate(changes.items()):
            for name in RIGS:
                with self.subTest(change=what, rig=name):
                    bpy.ops.wm.read_factory_settings(use_empty=True)
                    bpy.ops.preferences.addon_enable(module="reachcast")
                    rig = RIGS[name]()
                    if what == "no toes" and name == "metarig":
                        edit_bones(rig, lambda bones: [bones.remove(bones[f"heel.02.{s}"]) for s in "LR"])
                    change(rig)
                    set_rolls(rig, np.random.default_rng(number).uniform(-3.1, 3.1, 23))
                    rig.scale = (0.01,) * 3
                    rig.data.transform(Matrix.Scale(100.0, 4))
                    bpy.context.view_layer.update()
                    scene = LiftScene(rig, empty("Shelf", Matrix()), empty("Home", Matrix()), cuboid("Box", BOX_SIZE))
                    scene.arrange(Place(1.1, 20, 0.45, True), "waist")
                    self.check_by_measure(scene, scene.predict(None, start_frame=1).frames)

    def check_by_measure(self, scene: LiftScene, events: dict[str, int]) -> None:
        skeleton = read_rig(scene.rig)
        samples = sample(scene.rig, skeleton, range(1, events["end"] + 1), scene.box)
        measures = measure_lift(samples, skeleton, dict(events), bpy.context.scene.render.fps, read_box(scene.box),
                                np.array(scene.shelf.matrix_world.translation))
        for name in ("landing_m", "grasp_m", "held_m", "left_foot_m"):
            self.assertLess(getattr(measures, name), PROMISED_M, name)
        self.assertLess(foot_slip(samples, "right"), PROMISED_M)
        self.assertLess(measures.stretch, STRETCH)
        self.assertGreaterEqual(min(measures.least_elbow_deg, measures.least_knee_deg), 0.0)
        self.assertLess(measures.forearm_twist_deg, MOST_TWIST_DEG)
        self.assertLess(measures.fastest_rad_s, FASTEST_RAD_S)

    def check_by_sight(self, scene: LiftScene, events: dict[str, int]) -> None:
        skeleton = read_rig(scene.rig)
        segments = skeleton.bone_map.segments
        ankles = []
        for frame in range(1, events["end"] + 1):
            bpy.context.scene.frame_set(frame)
            graph = bpy.context.evaluated_depsgraph_get()
            rig, box = scene.rig.evaluated_get(graph), scene.box.evaluated_get(graph)
            world, bones = rig.matrix_world, rig.pose.bones
            for bone in bones:
                self.assertAlmostEqual(bone.length / bone.bone.length, 1.0, delta=STRETCH)
            ankles.append([world @ bones[segments[f"foot.{side}"]].head for side in "LR"])
            if events["grasp"] <= frame <= events["release"]:
                middle = sum((np.array(world @ bones[segments[f"hand.{side}"]].tail) for side in "LR"), np.zeros(3)) / 2
                handle = np.array(box.matrix_world @ Matrix.Translation((0, 0, 0.5 * BOX_SIZE[2])).translation)
                self.assertLess(np.abs(middle - handle).max(), PROMISED_M, f"frame {frame}")
        self.assertLess(np.ptp(np.array(ankles), axis=0).max(), PROMISED_M)
        bpy.context.scene.frame_set(events["release"])
        landed = scene.box.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world.translation
        self.assertLess((landed - scene.shelf.matrix_world.translation).length, PROMISED_M)


if __name__ == "__main__":
    unittest.main()
