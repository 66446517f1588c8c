# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever would override the keys of rig and box is named before anything is written; what would not is let be."""
from __future__ import annotations

from collections.abc import Callable

import bpy
from lift_cases import cuboid
from mathutils import Matrix
from scene_cases import LANDING_TOLERANCE, Scene

Owner = bpy.types.Object


def animate(owner: Owner, path: str = "location") -> bpy.types.Action:
    owner.keyframe_insert(path, frame=1)
    owner.keyframe_insert(path, frame=60)
    return owner.animation_data.action


def drive(owner: Owner, path: str = "location") -> None:
    owner.driver_add(path, 0).driver.expression = "frame * 0.01"


def push_down(owner: Owner, path: str = "location") -> bpy.types.NlaTrack:
    """An Action on `path` as a live strip in a track named Old."""
    action = animate(owner, path)
    track = owner.animation_data.nla_tracks.new()
    track.name = "Old"
    track.strips.new("walk", 1, action).name = "walk"
    owner.animation_data.action = None
    return track


def solo(owner: Owner) -> None:
    push_down(owner, "hide_render").is_solo = True


def make_rigid(owner: Owner) -> None:
    with bpy.context.temp_override(scene=bpy.context.scene, object=owner):
        if bpy.context.scene.rigidbody_world is None:
            bpy.ops.rigidbody.world_add()
        bpy.ops.rigidbody.object_add()


def constrain(owner: Owner) -> None:
    owner.constraints.new("LIMIT_LOCATION")


OF_OWNERS: dict[str, tuple[Callable[[Owner], object], tuple[str, ...]]] = {
    "constraint": (constrain, ("constraint 'Limit Location'", "mute")),
    "driver": (drive, ("driver on its location",)),
    "driver of a delta": (lambda owner: drive(owner, "delta_location"), ("driver on its delta_location",)),
    "driver of a turn": (lambda owner: drive(owner, "rotation_euler"), ("driver on its rotation_euler",)),
    "strip": (push_down, ("NLA strip 'walk'", "Old")),
    "solo": (solo, ("NLA track 'Old'", "solo")),
}
OF_PARENTS: dict[str, tuple[Callable[[Owner], object], tuple[str, ...]]] = {
    **OF_OWNERS, "action": (animate, ("Action 'CartAction'",)),
}
del OF_PARENTS["solo"]  # a solo track of a parent matters only for what it moves


class Overriding(Scene):
    def refused_after(self, which: str, change: Callable[[Owner], object], *words: str) -> None:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.ops.preferences.addon_enable(module="reachcast")
        self.furnish()
        change(getattr(self, which))
        self.refused(*words)

    def hang(self, owner: Owner) -> Owner:
        """`owner` two generations below the Empty that is returned, where it was."""
        cart, bed = (self.empty(name, Matrix(), (0.1, 0.2, 0.0)) for name in ("Cart", "Bed"))
        bed.parent, owner.parent = cart, bed
        bpy.context.view_layer.update()
        owner.matrix_parent_inverse = bed.matrix_world.inverted()
        bpy.context.view_layer.update()
        return cart

    def test_on_rig_and_box(self) -> None:
        for which, name in (("rig", "Rig 'Worker'"), ("box", "Box 'Box'")):
            for case, (change, words) in OF_OWNERS.items():
                with self.subTest(which=which, case=case):
                    self.refused_after(which, change, name, *words)

    def test_above_rig_and_box(self) -> None:
        for which, name in (("rig", "Rig 'Worker'"), ("box", "Box 'Box'")):
            for case, (change, words) in OF_PARENTS.items():
                with self.subTest(which=which, case=case):
                    self.refused_after(which, lambda owner, change=change: change(self.hang(owner)), name, "'Cart'",
                                       "Alt P", *words)

    def test_bones(self) -> None:
        bone = 'pose.bones["forearm.L"].rotation_quaternion'
        self.refused_after("rig", lambda rig: push_down(rig, bone), "Worker", "NLA strip 'walk'")

    def test_rigid_body(self) -> None:
        self.refused_after("box", make_rigid, "Box 'Box'", "rigid body", "passive")
        self.box.rigid_body.kinematic = True
        self.predict()

    def test_box_and_rig_on_each_other(self) -> None:
        self.refused_after("box", lambda box: setattr(box, "parent", self.rig), "Box 'Box'", "'Worker'", "Alt P")
        self.refused_after("rig", lambda rig: setattr(rig, "parent", self.box), "Rig 'Worker'", "'Box'", "Alt P")

    def test_box_on_a_bone_or_a_vertex(self) -> None:
        def on_bone(box: Owner) -> None:
            data = bpy.data.armatures.new("Crane")
            crane = bpy.data.objects.new("Crane", data)
            bpy.context.collection.objects.link(crane)
            bpy.context.view_layer.objects.active = crane
            bpy.ops.object.mode_set(mode="EDIT")
            data.edit_bones.new("arm").tail = (0.0, 0.0, 1.0)
            bpy.ops.object.mode_set(mode="OBJECT")
            box.parent, box.parent_type, box.parent_bone = crane, "BONE", "arm"
            bpy.context.view_layer.update()
            box.matrix_world = self.home.matrix_world
            animate(crane, 'pose.bones["arm"].location')

        def on_vertex(box: Owner) -> None:
            box.parent, box.parent_type = cuboid("Cart", (0.1, 0.1, 0.1)), "VERTEX"

        self.refused_after("box", on_bone, "Box 'Box'", "'Crane'", "Action 'CraneAction'")
        self.refused_after("box", on_vertex, "Box 'Box'", "vertices", "'Cart'")


class Harmless(Scene):
    def lands(self) -> None:
        measures = self.measured(self.predict())
        self.assertLess(max(measures.landing_m, measures.held_m, measures.left_foot_m), LANDING_TOLERANCE)

    def test_tracks_that_are_off_or_touch_nothing_of_ours(self) -> None:
        self.furnish(rig_name="metarig")
        push_down(self.rig).mute = True
        push_down(self.box).strips[0].mute = True
        push_down(self.rig, "hide_render")
        push_down(self.rig, 'pose.bones["thumb.01.L"].rotation_quaternion')
        push_down(self.box, "hide_render")
        self.lands()

    def test_nla_that_is_switched_off(self) -> None:
        self.furnish()
        push_down(self.rig)
        self.rig.animation_data.use_nla = False
        self.lands()

    def test_muted_constraints_and_drivers(self) -> None:
        self.furnish()
        for owner in (self.rig, self.box):
            constrain(owner)
            owner.constraints[0].mute = True
            drive(owner)
            owner.animation_data.drivers[0].mute = True
        self.lands()

    def test_static_parents(self) -> None:
        self.furnish()
        for owner in (self.rig, self.box):
            parent = self.empty("Platform", Matrix(), (0.3, 0.1, 0.2))
            animate(parent, "hide_render")
            owner.parent = parent
            bpy.context.view_layer.update()
            owner.matrix_parent_inverse = parent.matrix_world.inverted()
        bpy.context.view_layer.update()
        self.lands()

    def test_the_action_that_is_replaced(self) -> None:
        self.furnish()
        animate(self.rig)
        animate(self.box)
        self.lands()
