# SPDX-License-Identifier: GPL-3.0-or-later
"""Editing the path of the hands and drawing variants: what the evaluated scene shows of it."""
from __future__ import annotations

import unittest

import bpy
import corpora
import numpy as np
from lift_cases import LiftScene, Place, cuboid, lift_scene, rig_of
from mathutils import Vector
from mathutils.geometry import interpolate_bezier
from reachcast import path_editing
from reachcast.scene.action_writer import curves_of
from reachcast.scene.measure import sample
from reachcast.scene.path_curve import read_control
from reachcast.scene.path_session import PathSession, SessionEnded, begin_session, end_session
from reachcast.scene.read_rig import read_rig
from reachcast.scene.spread_tube import tube_rings
from reachcast.scene.variants import VariantsResult, predict_variants
from reachcast.rigs.joints import INDEX

FOLLOWS_M = 1e-3   #: how near the hands keep to the curve
PLACE = Place(1.0, 60, 0.55, facing=True)
FEET = [INDEX[f"{word}_{joint}"] for word in ("left", "right") for joint in ("ankle", "ball")]


def curve_points(item: bpy.types.Object) -> np.ndarray:
    """The curve as Blender draws it, finely."""
    first, last = item.data.splines[0].bezier_points
    points = interpolate_bezier(first.co, first.handle_right, last.handle_left, last.co, 4000)
    return np.array([item.matrix_world @ point for point in points])


class Editing(unittest.TestCase):
    def begin(self, rig: str = "mannequin", phases: tuple[str, ...] = ("transfer",), **options: object) -> PathSession:
        self.scene: LiftScene = lift_scene(rig_of(rig, 1.72))
        self.scene.arrange(PLACE, "floor")
        return begin_session(self.scene.rig, self.scene.shelf, home=self.scene.home, box=self.scene.box, start_frame=1,
                             corpus=corpora.recorded_corpus(), phases=phases, **options)  # type: ignore[arg-type]

    def hands(self, session: PathSession, number: int = 0) -> tuple[np.ndarray, np.ndarray]:
        """(F, 3) the middle between the grips in a phase, and (F, 4, 3) the feet, from the evaluated bones."""
        events = session.result.frames
        names = list(events)
        first, last = ((events["lift_off"], events["placed"]) if "lift_off" in names else (1, events[names[0]]))
        seen = sample(self.scene.rig, read_rig(self.scene.rig), range(first, last + 1))
        return seen.joints[:, [INDEX["left_grip"], INDEX["right_grip"]]].mean(axis=1), seen.joints[:, FEET]

    def assert_follows(self, session: PathSession) -> np.ndarray:
        hands, feet = self.hands(session)
        drawn = curve_points(bpy.data.objects[session.curves[0]])
        off = np.linalg.norm(hands[:, None] - drawn[None], axis=2).min(axis=1)
        self.assertLess(off.max(), FOLLOWS_M)
        np.testing.assert_allclose(feet, np.broadcast_to(feet[0], feet.shape), atol=1e-3)
        return hands

    def test_hands_follow_the_curve_before_and_after_its_handles_move(self) -> None:
        for rig in ("mannequin", "metarig"):
            with self.subTest(rig=rig):
                session = self.begin(rig)
                before = self.assert_follows(session)
                curve = bpy.data.objects[session.curves[0]]
                curve.data.splines[0].bezier_points[0].handle_right += Vector((0.10, 0.0, 0.15))
                curve.data.splines[0].bezier_points[1].handle_left += Vector((0.0, 0.08, 0.10))
                self.assertTrue(session.update())
                after = self.assert_follows(session)
                self.assertGreater(np.abs(after - before).max(), 0.03)
                self.assertFalse(session.update(), "nothing has moved since")
                end_session(session)

    def test_handles_can_be_moved_in_edit_mode(self) -> None:
        session = self.begin()
        curve = bpy.data.objects[session.curves[0]]
        bpy.context.view_layer.objects.active = curve
        bpy.ops.object.mode_set(mode="EDIT")
        curve.data.splines[0].bezier_points[1].handle_left += Vector((0.0, 0.0, 0.12))
        self.assertTrue(session.update())
        bpy.ops.object.mode_set(mode="OBJECT")
        self.assertFalse(session.update())
        self.assert_follows(session)

    def test_an_end_of_the_curve_takes_the_shelf_with_it_and_the_shelf_the_curve(self) -> None:
        session = self.begin()
        curve, shelf = bpy.data.objects[session.curves[0]], self.scene.shelf
        way = Vector((-0.06, 0.04, 0.11))
        was = shelf.matrix_world.translation.copy()
        point = curve.data.splines[0].bezier_points[1]
        point.co, point.handle_left = point.co + way, point.handle_left + way
        self.assertTrue(session.update())
        self.assertLess((shelf.matrix_world.translation - was - way).length, 1e-5)
        self.assert_follows(session)
        inner, end = read_control(curve)[2:]
        shelf.location.z -= 0.2
        self.assertTrue(session.update())
        np.testing.assert_allclose(read_control(curve)[2:], [inner - [0, 0, 0.2], end - [0, 0, 0.2]], atol=1e-5)
        self.assert_follows(session)
        bpy.context.scene.frame_set(session.result.frames["placed"])
        placed = self.scene.box.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world.translation
        self.assertLess((placed - shelf.matrix_world.translation).length, 1e-3)

    def test_a_live_motion_follows_the_shelf_and_the_home(self) -> None:
        session = self.begin(live=True)
        self.assertFalse(session.curves)
        self.assertFalse(session.update())
        frames = set()
        for shelf, home in ((0.0, 0.0), (-0.4, 0.0), (0.25, 0.3), (-0.1, 0.1)):
            self.scene.shelf.location.z = PLACE.height + shelf
            self.scene.home.location.z = home
            session.update()
            events = session.result.frames
            frames.add(events["end"])
            seen = sample(self.scene.rig, read_rig(self.scene.rig), range(1, events["end"] + 1), self.scene.box)
            for event, item in (("placed", self.scene.shelf), ("grasp", self.scene.home)):
                off = seen.box_origins[events[event] - 1] - np.array(item.matrix_world.translation)
                self.assertLess(np.linalg.norm(off), 1e-3)
            hands = seen.joints[:, [INDEX["left_grip"], INDEX["right_grip"]]].mean(axis=1)
            held = slice(events["grasp"] - 1, events["release"])
            self.assertLess(np.linalg.norm(hands - seen.box_origins - [0, 0, 0.12], axis=1)[held].max(), 1e-3)
            self.assertLess(np.abs(seen.joints[:, FEET] - seen.joints[0, FEET]).max(), 1e-3)
        self.assertGreater(len(frames), 1, "how long it takes is predicted anew")
        self.assertEqual(len(bpy.data.actions), 2)

    def test_a_place_out_of_reach_is_refused_and_the_motion_stays(self) -> None:
        session = self.begin()
        before = self.assert_follows(session)
        self.scene.shelf.location.z += 2.0
        with self.assertRaisesRegex(ValueError, "out of reach"):
            session.update()
        np.testing.assert_array_equal(self.hands(session)[0], before)
        self.assertFalse(session.update(), "it is said once")
        self.scene.shelf.location.z -= 2.0
        self.assertTrue(session.update())
        self.assert_follows(session)

    def test_nothing_is_overwritten_and_an_edited_path_is_taken_up_again(self) -> None:
        session = self.begin()
        curve = bpy.data.objects[session.curves[0]]
        curve.data.splines[0].bezier_points[0].handle_right += Vector((0.12, 0.0, 0.1))
        session.update()
        edited, control = session.result.action, read_control(curve)
        end_session(session)
        self.assertNotIn("Hand Path Transfer", bpy.data.objects)
        bpy.context.scene.frame_set(1)
        again = begin_session(self.scene.rig, self.scene.shelf, home=self.scene.home, box=self.scene.box, start_frame=1,
                              corpus=corpora.recorded_corpus())
        self.assertNotEqual(again.result.action, edited)
        self.assertIn(edited, bpy.data.actions)
        np.testing.assert_allclose(read_control(bpy.data.objects[again.curves[0]]), control, atol=1e-5)

    def test_all_phases_have_curves_that_meet_at_the_box(self) -> None:
        session = self.begin(phases=("reach", "transfer", "return"), edited=(0, 1, 2))
        control = {number: read_control(bpy.data.objects[name]) for number, name in session.curves.items()}
        np.testing.assert_allclose(control[0][3], control[1][0], atol=1e-5)
        np.testing.assert_allclose(control[1][3], control[2][0], atol=1e-5)
        self.assertEqual([way for _, way in session.result.ways], ["given"] * 3)
        reach = bpy.data.objects[session.curves[0]]
        point = reach.data.splines[0].bezier_points[1]
        point.co.z += 0.05
        self.assertTrue(session.update())
        np.testing.assert_allclose(read_control(bpy.data.objects[session.curves[1]])[0], control[1][0] + [0, 0, 0.05],
                                   atol=1e-5)

    def test_ends_when_what_it_needs_is_gone_and_refuses_what_is_no_path_any_more(self) -> None:
        session = self.begin()
        curve = bpy.data.objects[session.curves[0]]
        curve.data.splines[0].bezier_points.add(1)
        with self.assertRaisesRegex(ValueError, "must stay one Bezier curve"):
            session.update()
        bpy.data.objects.remove(curve)
        with self.assertRaises(SessionEnded):
            session.update()

    def test_phases_that_are_not_there_are_refused(self) -> None:
        with self.assertRaisesRegex(ValueError, r"\[1\]; give numbers from 0 to 0"):
            self.begin(edited=(1,))
        self.assertFalse(bpy.data.actions)

    def test_the_button_starts_and_ends_a_session(self) -> None:
        self.begin()
        settings = bpy.context.scene.reachcast
        settings.rig, settings.shelf, settings.home, settings.box = (self.scene.rig, self.scene.shelf, self.scene.home,
                                                                     self.scene.box)
        settings.corpus = str(corpora.recorded_corpus())
        self.assertEqual(bpy.ops.reachcast.edit_hand_path(), {"FINISHED"})
        self.assertIsNotNone(path_editing.active())
        self.assertEqual(bpy.context.object.type, "CURVE")
        self.assertEqual(bpy.ops.reachcast.finish_hand_path(), {"FINISHED"})
        self.assertIsNone(path_editing.active())
        self.assertFalse(bpy.ops.reachcast.finish_hand_path.poll())

    def test_hands_come_to_the_shelf_from_where_they_are_asked_to(self) -> None:
        for approach, axis in (("above", (0.0, 0.0, 1.0)), ("front", None)):
            session = self.begin(approach=approach)
            rig = self.scene.rig.matrix_world.translation
            hands, _ = self.hands(session)
            from_where = hands[-4] - hands[-1]
            expected = np.array(axis) if axis else np.array([*(np.array(rig)[:2] - hands[-1][:2]), 0.0])
            cosine = from_where @ expected / np.linalg.norm(from_where) / np.linalg.norm(expected)
            self.assertGreater(cosine, 0.9, approach)
            end_session(session)


class Variants(unittest.TestCase):
    def draw(self, **options: object) -> VariantsResult:
        self.scene = lift_scene(rig_of("mannequin", 1.72))
        self.scene.arrange(PLACE, "floor")
        bpy.context.scene.frame_set(1)
        return predict_variants(self.scene.rig, self.scene.shelf, home=self.scene.home, box=self.scene.box,
                                corpus=corpora.recorded_corpus(), **options)  # type: ignore[arg-type]

    def hands(self, rig: bpy.types.Object, result) -> np.ndarray:  # type: ignore[no-untyped-def]
        seen = sample(rig, read_rig(rig), range(result.frames["lift_off"], result.frames["placed"] + 1))
        return seen.joints[:, [INDEX["left_grip"], INDEX["right_grip"]]].mean(axis=1)

    def test_each_is_an_action_that_lands_on_the_shelf_by_another_way(self) -> None:
        found = self.draw(count=3, seed=5)
        self.assertEqual(found.seeds + tuple(seed for seed, _ in found.failed), (5, 6, 7))
        paths = []
        for result in found.results:
            self.scene.rig.animation_data.action = bpy.data.actions[result.action]
            self.scene.box.animation_data.action = bpy.data.actions[result.box_action]
            paths.append(self.hands(self.scene.rig, result))
            placed = self.scene.box.evaluated_get(bpy.context.evaluated_depsgraph_get())
            bpy.context.scene.frame_set(result.frames["placed"])
            placed = self.scene.box.evaluated_get(bpy.context.evaluated_depsgraph_get())
            self.assertLess((placed.matrix_world.translation - self.scene.shelf.matrix_world.translation).length, 1e-3)
        middles = [path[len(path) // 2] for path in paths]
        self.assertGreater(np.linalg.norm(middles[0] - middles[1]), 0.005)

    def test_the_same_seed_gives_the_same_keys(self) -> None:
        def keys() -> list[np.ndarray]:
            found = self.draw(count=2, seed=11, tube=False)
            action = bpy.data.actions[found.results[1].action]
            return [np.array([point.co[1] for point in curve.keyframe_points]) for curve in curves_of(action)]
        for one, other in zip(keys(), keys()):
            np.testing.assert_array_equal(one, other)

    def test_ghosts_stand_beside_each_other_and_do_their_own_motion(self) -> None:
        found = self.draw(count=2, seed=3, ghosts=True, spacing=1.5)
        self.assertIsNone(self.scene.rig.animation_data and self.scene.rig.animation_data.action)
        skeleton = read_rig(self.scene.rig)
        for number, result in enumerate(found.results, 1):
            ghost = bpy.data.objects[result.rig]
            offset = np.array(ghost.matrix_world.translation - self.scene.rig.matrix_world.translation)
            np.testing.assert_allclose(offset, 1.5 * number * skeleton.axes[0], atol=1e-6)
            hands = self.hands(ghost, result)
            box = next(item for item in bpy.data.collections[found.collection].objects
                       if item.animation_data and item.animation_data.action.name == result.box_action)
            bpy.context.scene.frame_set(result.frames["placed"])
            shown = box.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world.translation
            self.assertLess(np.linalg.norm(np.array(shown) + [0, 0, 0.12] - hands[-1]), 1e-3)

    def test_the_tube_is_two_standard_deviations_wide(self) -> None:
        """Points drawn about a straight line with known deviations across it."""
        random = np.random.default_rng(3)
        line = np.linspace([0, 0, 0], [0, 0, 1.0], 9)
        paths = line + random.normal(size=(20000, 1, 3)) * [0.03, 0.01, 0.0]
        rings = tube_rings(paths)
        size = rings.max(axis=1) - rings.min(axis=1)
        np.testing.assert_allclose(size[:, 0], 2 * 2 * 0.03, rtol=0.03)
        np.testing.assert_allclose(size[:, 1], 2 * 2 * 0.01, rtol=0.03)

    def test_the_tube_lies_about_the_paths(self) -> None:
        found = self.draw(count=2, seed=1)
        tube = bpy.data.objects[found.tube]
        corners = np.array([tube.matrix_world @ vertex.co for vertex in tube.data.vertices])
        for result in found.results:
            self.scene.rig.animation_data.action = bpy.data.actions[result.action]
            hands = self.hands(self.scene.rig, result)
            self.assertTrue(np.all(hands > corners.min(axis=0) - 0.1) and np.all(hands < corners.max(axis=0) + 0.1))
        for end in (hands[0], hands[-1]):
            self.assertLess(np.linalg.norm(corners - end, axis=1).min(), 0.01, "where all paths meet it is thin")

    def test_bad_numbers_are_refused_before_anything_is_written(self) -> None:
        for options, words in (({"count": 0}, "number of variants is 0"), ({"seed": -1}, "seed is -1"),
                               ({"amount": 3.0}, "amount of the variation is 3"), ({"spacing": -1.0}, "spacing")):
            with self.assertRaisesRegex(ValueError, words):
                self.draw(**options)
            self.assertFalse(bpy.data.actions)
