# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects are read where they are, also where Blender does not evaluate them: hidden ones, and other scenes'."""
from __future__ import annotations

from collections.abc import Callable

import bpy
import numpy as np
from mathutils import Euler, Matrix, Vector
from reachcast.scene.measure import measure_lift, sample
from reachcast.scene.predict_action import PredictionResult
from reachcast.scene.read_rig import read_rig
from reachcast.scene.read_task import read_box
from reachcast.scene.transforms import world_matrix
from scene_cases import LANDING_TOLERANCE, Scene

Owner = bpy.types.Object
MOVED = Vector((0.02, 0.01, 0.03))


def collection_of(item: Owner) -> bpy.types.Collection:
    """A collection of its own for `item`, below the scene's."""
    own = bpy.data.collections.new(f"of {item.name}")
    bpy.context.scene.collection.children.link(own)
    for other in item.users_collection:
        other.objects.unlink(item)
    own.objects.link(item)
    return own


def exclude(item: Owner) -> None:
    bpy.context.view_layer.layer_collection.children[collection_of(item).name].exclude = True


WAYS: dict[str, Callable[[Owner], object]] = {
    "eye": lambda item: item.hide_set(True),
    "screen": lambda item: setattr(item, "hide_viewport", True),
    "excluded": exclude,
    "collection's screen": lambda item: setattr(collection_of(item), "hide_viewport", True),
    "in no scene": lambda item: [other.objects.unlink(item) for other in item.users_collection],
}


class Hidden(Scene):
    def test_objects_moved_after_they_were_hidden(self) -> None:
        for way, hide in WAYS.items():
            for which in ("shelf", "home", "rig", "box"):
                with self.subTest(way=way, which=which):
                    self.furnish()
                    item = getattr(self, which)
                    hide(item)
                    bpy.context.view_layer.update()
                    item.location += MOVED
                    np.testing.assert_allclose(world_matrix(item)[:3, 3], item.location, atol=1e-6)

    def test_box_lands_on_a_hidden_shelf(self) -> None:
        for way, hide in WAYS.items():
            with self.subTest(way=way):
                self.furnish()
                hide(self.shelf)
                bpy.context.view_layer.update()
                self.shelf.location += MOVED
                result = self.predict()
                bpy.context.scene.frame_set(result.frames["release"])
                self.assertLess((self.box.matrix_world.translation - self.shelf.location).length, LANDING_TOLERANCE)

    def test_hidden_rig_and_box_lift_right_once_shown(self) -> None:
        self.furnish()
        for item in (self.rig, self.box):
            item.hide_viewport = True
        bpy.context.view_layer.update()
        for item in (self.rig, self.box, self.home, self.shelf):
            item.location += MOVED
        result = self.predict()
        with self.assertRaisesRegex(ValueError, "is hidden"):
            self.measured(result)
        for item in (self.rig, self.box):
            item.hide_viewport = False
        measures = self.measured(result)
        self.assertLess(max(measures.landing_m, measures.held_m), LANDING_TOLERANCE)

    def test_children_of_hidden_parents(self) -> None:
        parent, middle, child = (self.empty(name, Matrix(), (0.0, 0.0, 0.0)) for name in ("Cart", "Bed", "Spot"))
        middle.parent, child.parent = parent, middle
        middle.matrix_parent_inverse = Matrix.LocRotScale((0.1, 0.2, 0.3), Euler((0.1, 0.2, 0.3)), (2.0, 2.0, 2.0))
        child.delta_location = (0.0, 0.0, 0.5)

        def move() -> None:
            parent.rotation_euler, parent.location = (0.3, -0.4, 2.0), (1.0, 2.0, 3.0)
            middle.scale, child.location, child.rotation_euler = (0.5, 0.5, 0.5), (0.1, 0.0, 0.7), (0.0, 1.0, 0.0)
        for item in (parent, middle, child):
            item.hide_viewport = True
        bpy.context.view_layer.update()
        move()
        composed = world_matrix(child)
        for item in (parent, middle, child):
            item.hide_viewport = False
        np.testing.assert_allclose(composed, world_matrix(child), atol=1e-6)

    def test_hidden_objects_that_something_else_moves(self) -> None:
        def follow(item: Owner) -> None:
            item.constraints.new("COPY_LOCATION").target = self.home

        def drive(item: Owner) -> None:
            item.driver_add("location", 0).driver.expression = "frame * 0.01"

        for change, words in ((follow, ("Shelf", "constraint 'Copy Location'")), (drive, ("Shelf", "driver"))):
            with self.subTest(words=words):
                self.furnish()
                change(self.shelf)
                self.shelf.hide_viewport = True
                bpy.context.view_layer.update()
                self.refused(self.shelf.name, words[1], "hidden")


class OtherScene(Scene):
    def furnish_other(self) -> bpy.types.Scene:
        """Everything in a scene that no window shows, and moved there without an update."""
        self.furnish()
        other = bpy.data.scenes.new("Other")
        other.render.fps = 60
        for item in (self.rig, *self.rig.children_recursive, self.shelf, self.home, self.box):
            for collection in item.users_collection:
                collection.objects.unlink(item)
            other.collection.objects.link(item)
        for item in (self.rig, self.shelf, self.home, self.box):
            item.location += Vector((5.0, 0.0, 0.0))
        return other

    def measured_in(self, scene: bpy.types.Scene, result: PredictionResult) -> dict[str, float]:
        layer = scene.view_layers[0]
        skeleton = read_rig(self.rig, layer=layer)
        samples = sample(self.rig, skeleton, range(result.first_frame, result.frames["end"] + 1), self.box, scene)
        return measure_lift(samples, skeleton, dict(result.frames), scene.render.fps, read_box(self.box, layer),
                            world_matrix(self.shelf, layer)[:3, 3]).as_dict()

    def test_lift_in_a_scene_that_is_not_shown(self) -> None:
        other = self.furnish_other()
        shown = bpy.context.scene.frame_current
        measures = self.measured_in(other, self.predict(scene=other))
        for name in ("landing_m", "grasp_m", "held_m", "left_foot_m"):
            self.assertLess(measures[name], LANDING_TOLERANCE, name)
        self.assertGreater(measures["fastest_rad_s"], 0.1)
        self.assertEqual(bpy.context.scene.frame_current, shown)

    def test_measures_come_from_the_scene_that_is_asked_for(self) -> None:
        """The same objects in both scenes, at different frames: only the other one moves."""
        self.furnish()
        other = bpy.data.scenes.new("Other")
        for item in (self.rig, self.shelf, self.home, self.box):
            other.collection.objects.link(item)
        result = self.predict(scene=other, start_frame=1)
        measures = self.measured_in(other, result)
        self.assertLess(max(measures["landing_m"], measures["held_m"]), LANDING_TOLERANCE)
        self.assertGreater(measures["fastest_rad_s"], 0.1)
