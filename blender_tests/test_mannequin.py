# SPDX-License-Identifier: GPL-3.0-or-later
"""The mannequin stands as the posture says, its surfaces are closed, and a failure leaves nothing behind."""

from __future__ import annotations

import unittest
from collections import Counter
from unittest import mock

import bpy
import numpy as np
from mathutils import Quaternion, Vector

from reachcast.rigs import mannequin_shape as shape
from reachcast.scene import mannequin

JOINT_TOLERANCE = 1e-6  # metres; Blender stores bone ends as 32-bit floats
SURFACE_TOLERANCE = 2e-6  # metres; mesh vertices go through one more 32-bit transform
STATURES = (1.2, 1.47, 1.75, 1.95, 2.2)
DATA = ("objects", "meshes", "armatures", "materials")


def standing(stature: float) -> dict[str, tuple[float, float, float]]:
    """An upright posture in the body frame; fractions of stature, elbows and knees a little bent."""
    right = {
        "ball": (0.058, 0.072, 0.012), "ankle": (0.052, 0.0, 0.039), "knee": (0.051, 0.01, 0.285),
        "hip": (0.05, 0.012, 0.53), "clavicle": (0.014, 0.026, 0.815), "shoulder": (0.107, -0.004, 0.818),
        "elbow": (0.186, -0.004, 0.650), "wrist": (0.247, 0.021, 0.519), "grip": (0.270, 0.030, 0.471),
    }
    joints = {
        "l5s1": (0.0, -0.01, 0.585), "c7t1": (0.0, -0.022, 0.852), "suprasternale": (0.0, 0.03, 0.815),
        "tragion": (0.0, 0.012, 0.926), "nasion": (0.0, 0.066, 0.934),
    }
    for name, (x, y, z) in right.items():
        joints["right_" + name], joints["left_" + name] = (x, y, z), (-x, y, z)
    return {name: (x * stature, y * stature, z * stature) for name, (x, y, z) in joints.items()}


def build(stature: float = 1.75, sex: str | None = "male", name: str = "Worker") -> bpy.types.Object:
    figure = mannequin.build_mannequin(bpy.context.scene.collection, standing(stature), sex, name, stature=stature)
    bpy.context.view_layer.update()
    return figure


def segments(figure: bpy.types.Object) -> dict[str, bpy.types.Object]:
    return {child.parent_bone: child for child in figure.children}


def world_points(item: bpy.types.Object) -> np.ndarray:
    return np.array([item.matrix_world @ vertex.co for vertex in item.data.vertices])


def figure_place(joint: tuple[float, float, float]) -> Vector:
    return Vector((-joint[0], -joint[1], joint[2]))


def census() -> dict[str, set[str]]:
    return {kind: {item.name for item in getattr(bpy.data, kind)} for kind in DATA}


class SkeletonStandsAsThePosture(unittest.TestCase):
    def test_bone_ends_are_the_joint_centres(self) -> None:
        ends = {"hips": (None, "l5s1"), "spine": ("l5s1", None), "chest": (None, "c7t1"), "neck": ("c7t1", "tragion")}
        limbs = {"shoulder": ("clavicle", "shoulder"), "upper_arm": ("shoulder", "elbow"),
                 "forearm": ("elbow", "wrist"), "hand": ("wrist", "grip"), "thigh": ("hip", "knee"),
                 "shin": ("knee", "ankle"), "foot": ("ankle", "ball"), "toe": ("ball", None)}
        for side, suffix in (("left", ".L"), ("right", ".R")):
            for bone, (a, b) in limbs.items():
                ends[bone + suffix] = (f"{side}_{a}", f"{side}_{b}" if b else None)
        for stature in STATURES:
            posture, bones = standing(stature), build(stature).data.bones
            for name, joints in ends.items():
                for place, joint in zip((bones[name].head_local, bones[name].tail_local), joints):
                    if joint is not None:
                        away = (place - figure_place(posture[joint])).length
                        self.assertLess(away, JOINT_TOLERANCE, f"{name} at {joint}, stature {stature}")

    def test_hips_is_the_root_midway_between_the_hip_joints(self) -> None:
        bones = build().data.bones
        self.assertEqual([bone.name for bone in bones if bone.parent is None], ["hips"])
        middle = 0.5 * (bones["thigh.L"].head_local + bones["thigh.R"].head_local)
        self.assertLess((bones["hips"].head_local - middle).length, JOINT_TOLERANCE)

    def test_bones_connect_where_they_meet(self) -> None:
        for bone in build().data.bones:
            if bone.parent is not None:
                meets = (bone.head_local - bone.parent.tail_local).length < JOINT_TOLERANCE
                self.assertEqual(bone.use_connect, meets, bone.name)

    def test_left_is_at_positive_x_and_the_face_looks_along_negative_y(self) -> None:
        figure = build()
        self.assertGreater(figure.data.bones["thigh.L"].head_local.x, 0.0)
        head = world_points(segments(figure)["head"])
        ear = figure.data.bones["head"].head_local.y
        nose = head[np.argmin(head[:, 1])]
        self.assertLess(nose[1], ear - 0.1)
        self.assertAlmostEqual(nose[0], 0.0, delta=1e-6)

    def test_rest_pose_is_symmetric(self) -> None:
        bones = build().data.bones
        for bone in bones:
            if bone.name.endswith(".L"):
                here, there = bone.matrix_local.to_3x3(), bones[bone.name[:-1] + "R"].matrix_local.to_3x3()
                mirrored = np.array(here) * [[1, -1, -1], [-1, 1, 1], [-1, 1, 1]]
                self.assertLess(np.abs(np.array(there) - mirrored).max(), 1e-5, bone.name)

    def test_positive_rotation_about_x_flexes(self) -> None:
        figure = build()
        tips = {"shin.L": Vector((0, 1, 0)), "shin.R": Vector((0, 1, 0)), "forearm.L": Vector((0, -1, 0)),
                "forearm.R": Vector((0, -1, 0)), "spine": Vector((0, -1, 0)), "neck": Vector((0, -1, 0))}
        for name, towards in tips.items():
            bpy.context.view_layer.update()
            bone = figure.pose.bones[name]
            self.assertEqual(bone.rotation_mode, "QUATERNION")
            before = bone.tail.copy()
            bone.rotation_quaternion = Quaternion((1.0, 0.0, 0.0), 0.5)
            bpy.context.view_layer.update()
            self.assertGreater((bone.tail - before).dot(towards), 0.3 * bone.length, name)
            bone.rotation_quaternion.identity()

    def test_palms_face_each_other(self) -> None:
        bones = build().data.bones
        self.assertLess(bones["hand.L"].matrix_local.col[0].x, -0.5)  # local +x of the left hand points to the right
        self.assertLess(bones["hand.R"].matrix_local.col[0].x, -0.5)  # so local -x of the right hand points to the left

    def test_stature_and_sex_are_kept_on_the_rig(self) -> None:
        figure = build(1.62, "female")
        self.assertAlmostEqual(figure["reachcast_stature"], 1.62)
        self.assertEqual(figure["reachcast_sex"], "female")
        self.assertEqual(build(1.62, None)["reachcast_sex"], "")

    def test_stature_is_estimated_when_not_given(self) -> None:
        figure = mannequin.build_mannequin(bpy.context.scene.collection, standing(1.6), None)
        self.assertAlmostEqual(figure["reachcast_stature"], 1.6, places=6)


class SurfacesAreSound(unittest.TestCase):
    def test_every_bone_has_one_closed_outward_mesh(self) -> None:
        for sex in ("female", "male", None):
            figure = build(1.68, sex)
            self.assertEqual(set(segments(figure)), {bone.name for bone in figure.data.bones})
            for name, item in segments(figure).items():
                directed = Counter(edge for face in item.data.polygons for edge in corner_pairs(face.vertices))
                self.assertTrue(all(count == 1 and directed[b, a] == 1 for (a, b), count in directed.items()), name)
                self.assertEqual(item.data.validate(), False, name)

    def test_every_shell_encloses_positive_volume(self) -> None:
        for sex in ("female", "male"):
            for name, surface in shape.surfaces(standing(1.75), 1.75, sex).items():
                for faces in shells(surface.faces):
                    self.assertGreater(shape.signed_volume(surface.vertices, faces), 1e-8, name)

    def test_volume_is_that_of_a_person(self) -> None:
        surfaces = shape.surfaces(standing(1.75), 1.75, "male").values()
        litres = 1e3 * sum(shape.signed_volume(surface.vertices, surface.faces) for surface in surfaces)
        self.assertTrue(55.0 < litres < 110.0, f"{litres:.0f} l; shells overlap at the joints")

    def test_soles_are_flat_on_the_floor_and_the_crown_is_at_stature(self) -> None:
        for stature in STATURES:
            for sex in ("female", "male"):
                figure = build(stature, sex)
                parts = {name: world_points(item) for name, item in segments(figure).items()}
                for name in ("foot.L", "foot.R", "toe.L", "toe.R"):
                    self.assertAlmostEqual(parts[name][:, 2].min(), 0.0, delta=SURFACE_TOLERANCE)
                    self.assertGreater((parts[name][:, 2] < SURFACE_TOLERANCE).sum(), 12, "a sole, not a point")
                everything = np.concatenate(list(parts.values()))
                self.assertAlmostEqual(everything[:, 2].max(), stature, delta=SURFACE_TOLERANCE)
                self.assertAlmostEqual(everything[:, 2].min(), 0.0, delta=SURFACE_TOLERANCE)

    def test_figure_is_its_own_mirror_image(self) -> None:
        parts = shape.surfaces(standing(1.75), 1.75, "female")
        for name, surface in parts.items():
            other = parts[name.replace(".L", ".X").replace(".R", ".L").replace(".X", ".R")]
            mirrored = surface.vertices * (-1.0, 1.0, 1.0)
            apart = np.linalg.norm(mirrored[:, None] - other.vertices[None], axis=-1)
            self.assertLess(apart.min(axis=1).max(), 1e-9, name)

    def test_palm_thumb_and_fingers_touch_a_box_side_through_the_grip(self) -> None:
        for sex in ("female", "male"):
            figure = build(1.75, sex)
            for name, palm in (("hand.L", 1.0), ("hand.R", -1.0)):
                bone = figure.data.bones[name]
                points = np.array([vertex.co for vertex in segments(figure)[name].data.vertices])
                held = points[points[:, 1] > 0.8 * bone.length]
                beyond = held[:, 0] * palm  # metres past the grip, to where the palm looks
                self.assertLess(beyond.max(), 0.006, name)
                self.assertGreater(beyond.max(), -0.006, name)
                palm_surface = held[np.linalg.norm(held[:, 1:] - (bone.length, 0.0), axis=1) < 0.02]
                self.assertLess(abs((palm_surface[:, 0] * palm).max()), 0.004, name)

    def test_meshes_follow_their_bones(self) -> None:
        figure = build()
        shin = segments(figure)["shin.L"]
        bone = figure.pose.bones["shin.L"]
        local = np.array([bone.matrix.inverted() @ Vector(p) for p in world_points(shin)])
        bone.rotation_quaternion = Quaternion((1.0, 0.0, 0.0), 2.0)
        figure.location = (1.0, 2.0, 3.0)
        bpy.context.view_layer.update()
        pose = figure.matrix_world @ bone.matrix
        moved = np.array([pose.inverted() @ Vector(p) for p in world_points(shin)])
        self.assertLess(np.abs(moved - local).max(), 5e-6)

    def test_face_budget(self) -> None:
        self.assertLess(sum(len(item.data.polygons) for item in build().children), 12000)


class BuildingIsTidy(unittest.TestCase):
    def test_two_figures_have_their_own_names_and_share_materials(self) -> None:
        first, second = build(), build()
        self.assertNotEqual(first.name, second.name)
        self.assertFalse({item.name for item in first.children} & {item.name for item in second.children})
        self.assertEqual(set(next(iter(segments(first).values())).data.materials),
                         set(next(iter(segments(second).values())).data.materials))

    def test_figure_is_active_and_alone_selected(self) -> None:
        build()
        figure = build()
        self.assertEqual(bpy.context.view_layer.objects.active, figure)
        self.assertEqual(list(bpy.context.selected_objects), [figure])

    def test_only_the_given_collection_gets_the_figure(self) -> None:
        target = bpy.data.collections.new("Crew")
        bpy.context.scene.collection.children.link(target)
        figure = mannequin.build_mannequin(target, standing(1.75), "male")
        for item in (figure, *figure.children):
            self.assertEqual(list(item.users_collection), [target])

    def test_a_hidden_collection_will_do(self) -> None:
        target = bpy.data.collections.new("Out of sight")
        figure = mannequin.build_mannequin(target, standing(1.75), "male")
        self.assertEqual(len(figure.data.bones), 22)

    def test_a_failure_anywhere_leaves_nothing(self) -> None:
        for step in ("_group_bones", "_material", "_add_segment", "_make_active"):
            for calls_before in (0, 2):
                with self.subTest(step=step, calls_before=calls_before):
                    self.fail_at(step, calls_before)

    def fail_at(self, step: str, calls_before: int) -> None:
        """Build with a step that fails after some good calls; the scene must be as before."""
        real, calls = getattr(mannequin, step), []

        def failing(*arguments: object) -> object:
            calls.append(step)
            if len(calls) > calls_before or step in ("_group_bones", "_make_active"):
                raise RuntimeError("on purpose")
            return real(*arguments)

        before, active = census(), bpy.context.view_layer.objects.active
        with mock.patch.object(mannequin, step, failing), self.assertRaisesRegex(RuntimeError, "on purpose"):
            build()
        self.assertEqual(census(), before)
        self.assertEqual(bpy.context.view_layer.objects.active, active)
        self.assertEqual(bpy.context.mode, "OBJECT")

    def test_a_joint_that_is_missing_leaves_nothing(self) -> None:
        posture, before = standing(1.75), census()
        del posture["left_wrist"]
        with self.assertRaises(KeyError):
            mannequin.build_mannequin(bpy.context.scene.collection, posture, "male")
        self.assertEqual(census(), before)

    def test_a_failure_in_edit_mode_leaves_nothing(self) -> None:
        good, before = shape.skeleton(standing(1.75), 1.75), census()
        broken = (good[0], shape.Bone("spine", "nobody", good[1].head, good[1].tail, good[1].z_hint))
        with mock.patch.object(shape, "skeleton", return_value=broken), \
                mock.patch.object(shape, "surfaces", return_value={}), self.assertRaises(KeyError):
            build()
        self.assertEqual(census(), before)
        self.assertEqual(bpy.context.mode, "OBJECT")


def corner_pairs(corners: object) -> list[tuple[int, int]]:
    """Directed edges of a face."""
    ring = list(corners)  # type: ignore[call-overload]
    return list(zip(ring, ring[1:] + ring[:1]))


def shells(faces: tuple[tuple[int, ...], ...]) -> list[list[tuple[int, ...]]]:
    """Faces by connected part."""
    leader: dict[int, int] = {}

    def find(corner: int) -> int:
        while leader.setdefault(corner, corner) != corner:
            corner = leader[corner]
        return corner

    for face in faces:
        for corner in face[1:]:
            leader[find(corner)] = find(face[0])
    parts: dict[int, list[tuple[int, ...]]] = {}
    for face in faces:
        parts.setdefault(find(face[0]), []).append(face)
    return list(parts.values())
