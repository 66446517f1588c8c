# SPDX-License-Identifier: GPL-3.0-or-later
"""The same task by people of other sizes, and one person's motions to several places, in the evaluated scene."""
from __future__ import annotations

import os
import unittest

import bpy
import corpora
import numpy as np
from lift_cases import BOX_SIZE, LiftScene, Place, empty, lift_scene, rig_of
from mathutils import Matrix
from reachcast.people import FAMILY, Person, stature_at
from reachcast.rigs.joints import INDEX
from reachcast.scene.family import predict_family
from reachcast.scene.measure import foot_slip, sample
from reachcast.scene.read_rig import read_rig
from reachcast.scene.publish import MARKED
from reachcast.scene.several_targets import predict_to_targets

PROMISED_M = 1e-3
TURNED = Matrix.Translation((2.0, -1.0, 0.0)) @ Matrix.Rotation(0.7, 4, "Z")


class Several(unittest.TestCase):
    def setUp(self) -> None:
        self.corpus = os.fspath(corpora.recorded_corpus())
        self.scene = lift_scene(rig_of("mannequin", 1.72))
        self.scene.rig.matrix_world = TURNED
        self.scene.arrange(Place(1.1, 0, 0.5, True), "waist", TURNED)

    def task(self) -> dict[str, object]:
        scene = self.scene
        return {"rig": scene.rig, "corpus": self.corpus, "home": scene.home, "box": scene.box, "start_frame": 1}


class People(unittest.TestCase):
    def test_percentiles_are_the_published_ones(self) -> None:
        """Gordon et al. 1989 print, from the survey itself: women 152.78, 162.72, 173.73 cm; men 164.69, 175.49,
        186.65 cm. The normal distribution is within half a centimetre."""
        for sex, printed in (("female", (1.5278, 1.6272, 1.7373)), ("male", (1.6469, 1.7549, 1.8665))):
            for percentile, stature in zip((5, 50, 95), printed):
                self.assertAlmostEqual(stature_at(sex, percentile), stature, delta=0.005)

    def test_bad_people_are_refused(self) -> None:
        for arguments, words in ((("any", 5), "sex is 'any'"), (("male", 0), "percentile is 0"),
                                 (("male", 100), "percentile is 100"), (("male", float("nan")), "percentile is nan")):
            with self.assertRaisesRegex(ValueError, words):
                stature_at(*arguments)

    def test_names(self) -> None:
        self.assertEqual([str(Person("male", number)) for number in (1, 2.5, 3, 11, 22, 95)],
                         [f"{number} percentile man" for number in ("1st", "2.5th", "3rd", "11th", "22nd", "95th")])


class Family(Several):
    def family(self, **options: object):  # type: ignore[no-untyped-def]
        return predict_family(shelf=self.scene.shelf, **{**self.task(), **options})

    def test_everybody_lands_beside_the_others(self) -> None:
        found = self.family(spacing=1.5)
        self.assertEqual([person for person, _ in found.results], list(FAMILY))
        self.assertFalse(found.failed)
        right = read_rig(self.scene.rig).axes[0]
        boxes = {item.animation_data.action.name: item for item in bpy.data.collections[found.collection].objects
                 if item.type == "MESH" and item.animation_data}
        for number, (person, result) in enumerate(found.results, 1):
            with self.subTest(person=str(person)):
                worker = bpy.data.objects[result.rig]
                skeleton = read_rig(worker)
                self.assertAlmostEqual(skeleton.height, person.stature, delta=0.01)
                offset = 1.5 * number * right
                samples = sample(worker, skeleton, range(1, result.frames["end"] + 1), boxes[result.box_action])
                landed = samples.box_origins[result.frames["placed"] - 1]
                self.assertLess(np.linalg.norm(landed - offset - self.scene.shelf.matrix_world.translation), PROMISED_M)
                hands = samples.joints[:, [INDEX["left_grip"], INDEX["right_grip"]]].mean(axis=1)
                held = slice(result.frames["grasp"] - 1, result.frames["release"])
                up = [0.0, 0.0, 0.5 * BOX_SIZE[2]]
                self.assertLess(np.linalg.norm(hands - samples.box_origins - up, axis=1)[held].max(), PROMISED_M)
                self.assertLess(max(foot_slip(samples, "left"), foot_slip(samples, "right")), PROMISED_M)
                self.assertLess(np.linalg.norm(skeleton.axes[1] - read_rig(self.scene.rig).axes[1]), 1e-5)

    def test_who_cannot_reach_leaves_nothing_behind(self) -> None:
        self.scene.shelf.matrix_world = TURNED @ Place(1.95, 0, 0.5, True).matrix()
        before = {kind: len(getattr(bpy.data, kind)) for kind in ("objects", "meshes", "armatures")}
        found = self.family()
        self.assertTrue(found.failed and found.results, "a shelf that only tall people reach")
        self.assertLess(max(person.stature for person, _ in found.failed),
                        max(person.stature for person, _ in found.results))
        self.assertTrue(all("out of reach" in reason for _, reason in found.failed))
        segments = len([child for child in self.scene.rig.children if child.type == "MESH"])
        made = len(found.results)
        self.assertEqual(len(bpy.data.armatures) - before["armatures"], made)
        self.assertEqual(len(bpy.data.objects) - before["objects"], made * (segments + 3))  # rig, box, hold
        self.assertEqual(len(bpy.data.meshes) - before["meshes"], made * segments)

    def test_nobody_is_an_error_that_names_one(self) -> None:
        self.scene.shelf.matrix_world = TURNED @ Place(3.0, 0, 0.5, True).matrix()
        collections = len(bpy.data.collections)
        with self.assertRaisesRegex(ValueError, "Nobody of the family .* 5th percentile woman: .*out of reach"):
            self.family()
        self.assertEqual(len(bpy.data.collections), collections)
        self.assertFalse(bpy.data.actions)

    def test_bad_options(self) -> None:
        for options, words in (({"members": ()}, "no members"), ({"spacing": -1.0}, "spacing of the family is -1")):
            with self.assertRaisesRegex(ValueError, words):
                self.family(**options)


class Targets(Several):
    def shelves(self, *heights: float) -> list[bpy.types.Object]:
        return [empty(f"Shelf {height}", TURNED @ Place(height, 0, 0.5, True).matrix()) for height in heights]

    def test_one_action_for_each_shelf(self) -> None:
        shelves = self.shelves(0.5, 0.9, 1.3)
        found = predict_to_targets(shelves=shelves, **self.task())
        self.assertEqual(len({result.action for result in found.results}), 3)
        self.assertEqual(self.scene.rig.animation_data.action.name, found.results[0].action)
        for shelf, result in zip(shelves, found.results):
            self.scene.rig.animation_data.action = bpy.data.actions[result.action]
            self.scene.box.animation_data.action = bpy.data.actions[result.box_action]
            samples = sample(self.scene.rig, read_rig(self.scene.rig), [result.frames["placed"]], self.scene.box)
            self.assertLess(np.linalg.norm(samples.box_origins[0] - shelf.matrix_world.translation), PROMISED_M)
            self.assertTrue(bpy.data.actions[result.action].use_fake_user)

    def test_a_place_out_of_reach_is_named_and_the_others_done(self) -> None:
        found = predict_to_targets(shelves=self.shelves(3.0, 0.9), **self.task())
        self.assertEqual([name for name, _ in found.failed], ["Shelf 3.0"])
        self.assertEqual(len(found.results), 1)

    def test_none_at_all(self) -> None:
        with self.assertRaisesRegex(ValueError, "No targets"):
            predict_to_targets(shelves=[], **self.task())
        with self.assertRaisesRegex(ValueError, "No target can be served; 'Shelf 3.0'"):
            predict_to_targets(shelves=self.shelves(3.0), **self.task())
        self.assertFalse(bpy.data.actions)


class Buttons(Several):
    def setUp(self) -> None:
        super().setUp()
        settings = bpy.context.scene.reachcast
        settings.rig, settings.shelf, settings.home, settings.box = (
            self.scene.rig, self.scene.shelf, self.scene.home, self.scene.box)
        settings.corpus = self.corpus

    def test_family(self) -> None:
        self.assertEqual(bpy.ops.reachcast.predict_family(spacing=1.0), {"FINISHED"})
        self.assertEqual(len([item for item in bpy.data.objects if item.type == "ARMATURE"]), 1 + len(FAMILY))

    def test_markers_stand_at_the_events_and_give_way_to_new_ones(self) -> None:
        scene = bpy.context.scene
        scene.timeline_markers.new("mine", frame=3)
        for first in (1, 31):
            scene.frame_set(first)
            self.assertEqual(bpy.ops.reachcast.predict_motion(), {"FINISHED"})
            action = self.scene.rig.animation_data.action
            wanted = {f"Worker: {event.replace('_', ' ')}": action[event] for event in MARKED}
            self.assertEqual({marker.name: marker.frame for marker in scene.timeline_markers}, {"mine": 3, **wanted})
            self.assertEqual({f"Worker: {marker.name}": marker.frame for marker in action.pose_markers}, wanted)
            self.assertGreaterEqual(min(wanted.values()), first)
        scene.reachcast.markers = False
        scene.frame_set(1)
        self.assertEqual(bpy.ops.reachcast.predict_motion(), {"FINISHED"})
        self.assertFalse(self.scene.rig.animation_data.action.pose_markers)

    def test_assets(self) -> None:
        self.assertEqual(bpy.ops.reachcast.predict_motion(), {"FINISHED"})
        self.assertIsNone(self.scene.rig.animation_data.action.asset_data)
        bpy.context.scene.reachcast.assets = True
        self.assertEqual(bpy.ops.reachcast.predict_motion(), {"FINISHED"})
        for item in (self.scene.rig, self.scene.box):
            data = item.animation_data.action.asset_data
            self.assertIn("Predicted by Reachcast from", data.description)
            self.assertEqual([tag.name for tag in data.tags], ["transfer"])

    def test_targets_need_no_shelf_but_a_selection(self) -> None:
        bpy.context.scene.reachcast.shelf = None
        bpy.ops.object.select_all(action="DESELECT")
        self.assertFalse(bpy.ops.reachcast.predict_targets.poll())
        for height in (0.6, 1.2):
            empty(f"To {height}", TURNED @ Place(height, 0, 0.5, True).matrix()).select_set(True)
        self.assertEqual(bpy.ops.reachcast.predict_targets(), {"FINISHED"})
        self.assertEqual(len([action for action in bpy.data.actions if action.name.startswith("Worker to To")]), 2)

    def test_percentile_needs_a_sex(self) -> None:
        self.assertFalse(bpy.ops.reachcast.choose_percentile.poll())
        bpy.context.scene.reachcast.sex = "FEMALE"
        self.assertEqual(bpy.ops.reachcast.choose_percentile(percentile=95.0), {"FINISHED"})
        self.assertAlmostEqual(bpy.context.scene.reachcast.stature, stature_at("female", 95), places=5)


if __name__ == "__main__":
    unittest.main()
