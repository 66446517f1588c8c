# SPDX-License-Identifier: GPL-3.0-or-later
"""`predict_motion` and its button: what is written, what is left alone, what is refused. Uses a stand-in predictor."""
from __future__ import annotations

import math
import time

import bpy
import fake_core
import numpy as np
from lift_cases import cuboid
from mathutils import Euler, Matrix
from reachcast.scene.action_writer import Channel, curves_of, write_action
from reachcast.scene.measure import sample
from reachcast.scene.read_rig import read_rig
from reachcast.scene.read_task import BOX_MASS, GRIP_DISTANCE, HANDLE_HEIGHT, read_box, read_lift
from rig_cases import RIGS
from scene_cases import LANDING_TOLERANCE, Scene


class Lift(Scene):
    def test_lands_and_holds_in_the_evaluated_scene(self) -> None:
        places = {"as made": Matrix(), "moved and turned": Matrix.Translation((5, 2, 1)) @ Matrix.Rotation(2.5, 4, "Z")}
        for rig_name in RIGS:
            for place, around in places.items():
                with self.subTest(rig=rig_name, place=place):
                    self.furnish(around, rig_name)
                    measures = self.measured(self.predict())
                    self.assertLess(measures.landing_m, LANDING_TOLERANCE)
                    self.assertLess(measures.grasp_m, LANDING_TOLERANCE)
                    self.assertLess(measures.held_m, LANDING_TOLERANCE)
                    self.assertLess(measures.left_foot_m, LANDING_TOLERANCE)
                    self.assertLess(measures.stretch, 1e-5)
                    self.assertGreaterEqual(measures.least_elbow_deg, 0.0)
                    self.assertLess(measures.forearm_twist_deg, 90.0)

    def test_the_same_motion_in_the_world_at_any_scale_of_the_object(self) -> None:
        """A rig whose data is 100 times too large, in an object of scale 0.01, moves like the plain one."""
        self.furnish()
        skeleton = read_rig(self.rig)
        result = self.predict()
        frames = range(result.first_frame, result.frames["end"] + 1, 6)
        plain = sample(self.rig, skeleton, frames).joints
        self.rig.animation_data_clear()
        for bone in self.rig.pose.bones:
            bone.matrix_basis = Matrix()
        self.rig.data.transform(Matrix.Scale(100.0, 4))
        self.rig.scale = (0.01,) * 3
        self.predict()
        scaled = sample(self.rig, read_rig(self.rig), frames).joints
        np.testing.assert_allclose(scaled, plain, atol=2e-5)

    def test_events_are_scene_frames_on_the_action(self) -> None:
        self.furnish()
        result = self.predict(start_frame=31)
        action = bpy.data.actions[result.action]
        self.assertEqual(list(result.frames), ["grasp", "lift_off", "placed", "release", "end"])
        self.assertEqual({event: action[event] for event in result.frames}, dict(result.frames))
        self.assertEqual(result.frames["grasp"], 31)
        self.assertEqual(tuple(action.frame_range), (31.0, float(result.frames["end"])))
        self.assertEqual(self.rig.animation_data.action, action)
        self.assertIn("Shelf", action.name)

    def test_frame_rate_is_the_scene_s(self) -> None:
        self.furnish()
        bpy.context.scene.render.fps, bpy.context.scene.render.fps_base = 60, 2.0
        self.assertEqual(self.predict(start_frame=0).frames["end"], round(30 * fake_core.SECONDS) - 1)

    def test_box_that_is_parented_and_has_its_origin_elsewhere(self) -> None:
        self.furnish()
        parent = self.empty("Pallet", Matrix(), (0.4, 0.2, 0.1))
        parent.rotation_euler.z, parent.scale = 0.6, (0.5, 0.5, 0.5)
        self.box.parent = parent
        self.box.data.transform(Matrix.Translation((0.03, -0.05, -0.12)))
        bpy.context.view_layer.update()
        self.box.matrix_world = self.home.matrix_world
        bpy.context.view_layer.update()
        for mode in ("QUATERNION", "ZYX", "AXIS_ANGLE"):
            with self.subTest(mode=mode):
                self.box.rotation_mode = mode
                measures = self.measured(self.predict())
                self.assertLess(max(measures.landing_m, measures.held_m), LANDING_TOLERANCE)

    def test_box_starts_where_it_stands_without_a_home_and_keeps_its_side(self) -> None:
        self.furnish()
        before = np.array(self.box.matrix_world)
        result = self.predict(home=None)
        bpy.context.scene.frame_set(result.first_frame)
        np.testing.assert_allclose(np.array(self.box.matrix_world), before, atol=1e-6)

    def test_home_in_front_of_the_body_without_home_and_box(self) -> None:
        self.furnish()
        lift = read_lift(read_rig(self.rig), self.shelf, None, None)
        waist = read_rig(self.rig).to_body(read_rig(self.rig).joint("l5s1"))
        self.assertAlmostEqual(lift.home[2] + lift.box.handle_height, waist[2], places=6)
        self.assertGreater(lift.home[1], 0.2)
        self.assertIsNone(self.predict(home=None, box=None).box_action)

    def test_yaws_are_seen_from_the_body(self) -> None:
        self.furnish(Matrix.Rotation(1.0, 4, "Z"))
        for degrees, seen in ((0, 0), (30, 30), (80, 80), (120, -60), (180, 0), (270, 90)):
            self.shelf.rotation_euler = Euler((0.0, 0.0, 1.0 + math.radians(degrees)))
            bpy.context.view_layer.update()
            lift = read_lift(read_rig(self.rig), self.shelf, self.home, self.box)
            self.assertAlmostEqual(math.degrees(lift.target_yaw), seen, places=3)

    def test_box_properties(self) -> None:
        box = cuboid("Crate", (0.5, 0.3, 0.2))
        box[HANDLE_HEIGHT], box[BOX_MASS], box[GRIP_DISTANCE] = 0.15, 12, 0.52
        box.modifiers.new("Row", "ARRAY").count = 3  # along x: counted, as it is seen
        bpy.context.view_layer.update()
        shape = read_box(box)
        np.testing.assert_allclose((shape.width, shape.depth, shape.height, shape.handle_height, shape.mass,
                                    shape.grip_distance), (1.5, 0.3, 0.2, 0.15, 12.0, 0.52), atol=1e-6)


class Writing(Scene):
    def test_nothing_is_overwritten(self) -> None:
        self.furnish()
        first = self.predict()
        curves = keys_of(bpy.data.actions[first.action])
        second = self.predict(start_frame=100)
        self.assertNotEqual(first.action, second.action)
        self.assertEqual(keys_of(bpy.data.actions[first.action]), curves)
        self.assertTrue(bpy.data.actions[first.action].use_fake_user)

    def test_only_the_mapped_bones_and_those_above_are_keyed_and_no_bone_is_scaled(self) -> None:
        self.furnish(rig_name="metarig")
        action = bpy.data.actions[self.predict().action]
        skeleton = read_rig(self.rig)
        keyed = {curve.data_path.split('"')[1] for curve in curves_of(action)}
        self.assertEqual(keyed, {skeleton.bones.names[bone] for bone in skeleton.keyed})
        self.assertFalse([curve.data_path for curve in curves_of(action) if curve.data_path.endswith("scale")])
        self.rig.pose.bones["upper_arm.L"].scale = (1.0, 1.3, 1.0)
        action = bpy.data.actions[self.predict().action]
        scales = [curve for curve in curves_of(action) if curve.data_path.endswith("scale")]
        self.assertEqual([[tuple(key.co)[1] for key in curve.keyframe_points] for curve in scales], [[1.0]] * 3)

    def test_a_pose_that_was_there_does_not_leak_into_the_motion(self) -> None:
        self.furnish()
        self.rig.pose.bones["upper_arm.L"].scale = (1.0, 1.3, 1.0)
        self.rig.pose.bones["shoulder.R"].location = (0.1, 0.0, 0.0)
        self.rig.pose.bones["spine"].rotation_quaternion = (0.9, 0.3, 0.0, 0.0)
        measures = self.measured(self.predict())
        self.assertLess(max(measures.held_m, measures.stretch), LANDING_TOLERANCE)

    def test_keys_are_linear_and_stand_on_frames(self) -> None:
        self.furnish()
        for curve in curves_of(bpy.data.actions[self.predict().action]):
            self.assertEqual({key.interpolation for key in curve.keyframe_points}, {"LINEAR"})
            self.assertEqual([key.co.x % 1.0 for key in curve.keyframe_points], [0.0] * len(curve.keyframe_points))

    def test_bulk_writing_is_fast(self) -> None:
        """20 bones of 4 channels over 250 frames; a key at a time takes seconds."""
        owner = self.empty("Owner", Matrix(), (0.0, 0.0, 0.0))
        channels = [Channel(f'["value{index}"]', np.random.default_rng(index).normal(size=(250, 4)), "Values")
                    for index in range(20)]
        began = time.perf_counter()
        action = write_action(owner, "fast", channels, 1)
        self.assertLess(time.perf_counter() - began, 0.25)
        self.assertEqual(sum(len(curve.keyframe_points) for curve in curves_of(action)), 20_000)

    def test_undo_leaves_nothing(self) -> None:
        self.furnish()
        settings = bpy.context.scene.reachcast
        settings.rig, settings.shelf, settings.home, settings.box = self.rig, self.shelf, self.home, self.box
        settings.corpus = self.corpus
        bpy.ops.ed.undo_push(message="before")
        self.assertEqual(bpy.ops.reachcast.predict_motion(), {"FINISHED"})
        self.assertEqual(len(bpy.data.actions), 2)
        bpy.ops.ed.undo_push(message="after")
        bpy.ops.ed.undo()
        self.assertEqual(len(bpy.data.actions), 0)
        rig = bpy.data.objects["Worker"]
        self.assertTrue(rig.animation_data is None or rig.animation_data.action is None)


class Refused(Scene):
    def setUp(self) -> None:
        super().setUp()
        self.furnish()

    def test_out_of_reach(self) -> None:
        self.shelf.location.y = -3.0
        self.refused("cm", "shoulder")

    def test_shelf_that_is_not_a_number_or_not_there(self) -> None:
        self.shelf.location.z = math.nan
        self.refused("Shelf", "not a number")
        self.shelf = None
        self.refused("shelf")

    def test_boxes(self) -> None:
        self.box.scale = (0.0, 1.0, 1.0)
        self.refused("Box", "scale", "above zero")
        self.box.scale = (40.0, 1.0, 1.0)
        self.refused("Box", "width", "14.4")
        self.box.scale.x, self.box[HANDLE_HEIGHT] = 1.0, 0.9
        self.refused("Box", HANDLE_HEIGHT, "0.9", "0.24")

    def test_box_without_vertices(self) -> None:
        self.box.data = bpy.data.meshes.new("Nothing")
        self.refused("Box", "no vertices")

    def test_box_that_already_stands_on_the_shelf(self) -> None:
        """The button, pressed again at the end of a lift."""
        self.predict(home=None)
        bpy.context.scene.frame_set(bpy.data.actions["Worker to Shelf"]["end"])
        self.refused("Box 'Box' already stands on 'Shelf'", "home", home=None)

    def test_things_that_are_no_objects_or_no_more(self) -> None:
        gone = self.empty("Gone", Matrix(), (0.0, 0.0, 0.0))
        bpy.data.objects.remove(gone)
        for name in ("home", "box"):
            self.refused(f"The {name} must be", "5", **{name: 5})
            self.refused(f"The {name} has been removed", **{name: gone})
        self.refused("The corpus must be a path", "5", corpus=5)

    def test_actions_that_cannot_be_replaced(self) -> None:
        self.predict()
        self.rig.animation_data.action_blend_type = "ADD"
        self.refused("Worker", "add")
        self.rig.animation_data.action_blend_type = "REPLACE"
        self.box.constraints.new("LIMIT_LOCATION")
        self.refused("Box", "constraint 'Limit Location'")

    def test_the_button_reports_the_same_sentence(self) -> None:
        settings = bpy.context.scene.reachcast
        settings.rig, settings.shelf, settings.box, settings.corpus = self.rig, self.shelf, self.box, self.corpus
        self.shelf.location.y = -3.0
        before = self.everything()
        with self.assertRaisesRegex(RuntimeError, "beyond the reach"):
            bpy.ops.reachcast.predict_motion()
        self.assertIn("beyond the reach", bpy.context.window_manager.reachcast_problem)
        self.assertEqual(self.everything(), before)
        self.shelf.location.y = -0.4
        bpy.ops.reachcast.predict_motion()
        self.assertEqual(bpy.context.window_manager.reachcast_problem, "")


def keys_of(action: bpy.types.Action) -> list[tuple[object, ...]]:
    return [(curve.data_path, curve.array_index, [tuple(key.co) for key in curve.keyframe_points])
            for curve in curves_of(action)]
