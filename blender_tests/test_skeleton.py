# SPDX-License-Identifier: GPL-3.0-or-later
"""What a rig at rest is read as, and the sentences that refuse one."""
from __future__ import annotations

import math
import unittest
from collections.abc import Callable

import bpy
import numpy as np
from mathutils import Vector
from reachcast.rigs import bone_map, rig_presets
from reachcast.rigs.joints import SIDES
from reachcast.scene.read_rig import read_rig
from rig_cases import RIGS, edit_bones, mannequin, metarig, move_tail


class Hands(unittest.TestCase):
    def test_front_and_back_lie_on_the_line_through_the_grip(self) -> None:
        """As in the native module: front, grip and back from the fingers to the wrist, the grip midway."""
        for rig_name, make in RIGS.items():
            skeleton = read_rig(make())
            for _, word in SIDES:
                with self.subTest(rig=rig_name, side=word):
                    wrist, back, grip, front = (skeleton.joint(f"{word}_{name}")
                                                for name in ("wrist", "hand_back", "grip", "hand_front"))
                    np.testing.assert_allclose(0.5 * (front + back), grip, atol=1e-9)
                    np.testing.assert_allclose(np.cross(front - wrist, grip - wrist), 0.0, atol=1e-9)
                    lengths = [float(np.linalg.norm(place - wrist)) for place in (back, grip, front)]
                    self.assertEqual(lengths, sorted(lengths))


class Refusals(unittest.TestCase):
    def refused(self, rig: object, *words: str, **options: object) -> None:
        with self.assertRaises(ValueError) as caught:
            read_rig(rig, **options)  # type: ignore[arg-type]
        message = str(caught.exception)
        for word in words:
            self.assertIn(word, message)
        self.assertNotIn("\n", message)

    def test_transforms(self) -> None:
        for scale, words in (((0.0, 0.0, 0.0), ("scale", "above zero")), ((-1.0, 1.0, 1.0), ("negative",)),
                             ((1.0, 1.0, 1.2), ("unevenly", "1.2"))):
            with self.subTest(scale=scale):
                rig = mannequin()
                rig.scale = scale
                bpy.context.view_layer.update()
                self.refused(rig, rig.name, *words)
        rig = mannequin()
        rig.location.x = math.nan
        bpy.context.view_layer.update()
        self.refused(rig, rig.name, "not a number")

    def test_lying_rig(self) -> None:
        rig = mannequin()
        rig.rotation_euler.x = math.radians(90.0)
        bpy.context.view_layer.update()
        self.refused(rig, "upright", "87", "60")

    def test_not_an_armature(self) -> None:
        self.refused(None, "armature", "nothing")
        self.refused(bpy.data.objects.new("Thing", None), "armature", "Thing")

    def test_every_missing_bone_is_named(self) -> None:
        rig = mannequin()
        rig.data.bones["hand.L"].name = "paw"
        rig.data.bones["shin.R"].name = "stick"
        self.refused(rig, "hand.L", "shin.R", "Reachcast mannequin")

    def test_constraints_and_inheritance_name_their_bones(self) -> None:
        rig = mannequin()
        rig.pose.bones["forearm.L"].constraints.new("COPY_ROTATION")
        self.refused(rig, "'Copy Rotation' on forearm.L", "constraints", "mute or remove")
        rig.pose.bones["forearm.L"].constraints[0].influence = 0.0
        read_rig(rig)
        rig.pose.bones["forearm.L"].constraints[0].influence = 1.0
        rig.pose.bones["forearm.L"].constraints[0].mute = True
        read_rig(rig)
        rig.data.bones["thigh.R"].use_inherit_rotation = False
        self.refused(rig, "thigh.R", "inherit rotation")
        rig.data.bones["thigh.R"].use_inherit_rotation = True
        rig.data.bones["neck"].inherit_scale = "NONE"
        self.refused(rig, "neck", "inherit scale")

    def test_bone_maps(self) -> None:
        good = read_rig(RIGS["mannequin"]()).bone_map
        for text, words in (("{", ("not JSON",)), ("[]", ("segments",)),
                            ('{"segments": {"tail": "x"}}', ("unknown", "tail")),
                            ('{"segments": {}, "grips": {"L": {"bone": "x", "along": 2}}}', ("along", "2"))):
            with self.subTest(text=text), self.assertRaises(ValueError) as caught:
                rig_presets.parse_preset(text, "mine.json")
            for word in words:
                self.assertIn(word, str(caught.exception))
        twice = bone_map.BoneMap("twice", {**good.segments, "hand.L": good.segments["hand.R"]})
        self.refused(RIGS["mannequin"](), "both", bone_map=twice)

    def test_grip_override(self) -> None:
        rig = metarig()
        preset = rig_presets.detect([bone.name for bone in rig.data.bones], rig.name)
        palm = bone_map.BoneMap("palm", preset.segments, {"L": bone_map.GripPlace("palm.02.L", 0.5)})
        bone = rig.data.bones["palm.02.L"]
        np.testing.assert_allclose(read_rig(rig, palm).joint("left_grip"),
                                   0.5 * (bone.head_local + bone.tail_local), atol=1e-6)
        wrong = bone_map.BoneMap("wrong", preset.segments, {"L": bone_map.GripPlace("spine")})
        self.refused(rig, "grip.L", "spine", bone_map=wrong)

    def test_exchanged_legs_arms_and_both(self) -> None:
        for rig_name, make in RIGS.items():
            for chains, words in ((("thigh",), ("thigh.L", "thigh.R", "foot.L")), (("shoulder",), ("shoulder.L",)),
                                  (("thigh", "shoulder"), ("thigh.L", "foot.R"))):
                with self.subTest(rig=rig_name, chains=chains):
                    rig = make()
                    for chain in chains:
                        exchange_sides(rig, chain)
                    self.refused(rig, rig.name, "look exchanged", *words)

    def test_feet_that_point_backwards(self) -> None:
        for rig_name, make in RIGS.items():
            with self.subTest(rig=rig_name):
                rig = make()
                edit_bones(rig, lambda bones: [turn_back(bones[f"foot.{side}"]) for side in "LR"])
                self.refused(rig, "foot.L", "do not both point forward", "exchanged")

    def test_feet_on_tiptoe_are_no_mistake(self) -> None:
        rig = mannequin()
        tiptoe = Vector((0.0, -0.01, -0.12))
        edit_bones(rig, lambda bones: [move_tail(bones[f"foot.{side}"], tiptoe) for side in "LR"])
        read_rig(rig)

    def test_joints_in_a_line(self) -> None:
        def spine_between_hips(bones: bpy.types.ArmatureEditBones) -> None:
            bones["spine"].use_connect = False
            bones["spine"].head = 0.5 * (bones["thigh.L"].head + bones["thigh.R"].head)

        def neck_before_clavicle(bones: bpy.types.ArmatureEditBones) -> None:
            bones["neck"].use_connect = False
            bones["neck"].head = 0.5 * (bones["spine"].head + bones["shoulder.R"].head)

        for change, words in ((spine_between_hips, ("thigh.L", "thigh.R", "spine", "pelvis")),
                              (neck_before_clavicle, ("spine", "neck", "shoulder.R", "chest"))):
            with self.subTest(change=change.__name__):
                rig = mannequin()
                edit_bones(rig, change)
                self.refused(rig, "on one line", *words)


def exchange_sides(rig: bpy.types.Object, chain: str) -> None:
    """Swaps .L and .R in the names of two chains of bones."""
    bones: Callable[[str], list[bpy.types.Bone]] = lambda side: [  # noqa: E731
        rig.data.bones[f"{chain}.{side}"], *rig.data.bones[f"{chain}.{side}"].children_recursive]
    left, right = bones("L"), bones("R")
    names = {bone: f"{bone.name[:-1]}{'R' if bone.name.endswith('L') else 'L'}" for bone in left + right}
    for bone in names:
        bone.name = f"tmp {bone.name}"
    for bone, name in names.items():
        bone.name = name


def turn_back(bone: bpy.types.EditBone) -> None:
    along = bone.tail - bone.head
    move_tail(bone, Vector((along.x, -along.y, along.z)))
