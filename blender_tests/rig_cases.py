# SPDX-License-Identifier: GPL-3.0-or-later
"""Rigs to test on, and random motions of them made with Blender's own posing."""
from __future__ import annotations

import math
from collections.abc import Callable

import bpy
import fake_core
import numpy as np
from mathutils import Euler, Matrix, Vector
from reachcast.rigs.joints import JOINTS, SIDES
from reachcast.rigs.rotations import cross, normalise, reject
from reachcast.rigs.skeleton import Skeleton
from reachcast.scene.mannequin import build_mannequin
from reachcast.scene.measure import sample

#: Degrees that a segment swings about each of its axes in a random motion.
_SWING = {"pelvis": 25, "spine": 30, "neck": 20, "head": 25, "clavicle": 12, "upper_arm": 55, "forearm": 40,
          "hand": 25, "thigh": 40, "shin": 30, "foot": 15}


#: A limb bent by less has no hinge of its own at rest.
LEAST_REST_BEND_DEG = 8.0
EULER_ORDERS = ("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX")


def mannequin(stature: float = 1.75) -> bpy.types.Object:
    posture = fake_core.Body.from_stature(stature).posture
    rig = build_mannequin(bpy.context.collection, dict(zip(JOINTS, map(tuple, posture))), None, stature=stature)
    return rig


def metarig() -> bpy.types.Object:
    bpy.ops.preferences.addon_enable(module="rigify")
    bpy.ops.object.armature_human_metarig_add()
    return bpy.context.object


RIGS: dict[str, Callable[[], bpy.types.Object]] = {"mannequin": mannequin, "metarig": metarig}


def set_rest_arms(rig: bpy.types.Object, degrees_from_hanging: float) -> None:
    """Makes the arms' rest straight, `degrees_from_hanging` out from the body: 90 is a T pose, 45 an A pose."""
    angle = math.radians(degrees_from_hanging)
    edit_bones(rig, lambda bones: [_straighten(bones, side, Vector((sign * math.sin(angle), 0.0, -math.cos(angle))))
                              for side, sign in (("L", 1.0), ("R", -1.0))])


def set_rolls(rig: bpy.types.Object, rolls: np.ndarray) -> None:
    """Adds to the roll of every bone, radians, repeating `rolls`."""
    def change(bones: bpy.types.ArmatureEditBones) -> None:
        for index, bone in enumerate(bones):
            bone.roll += float(rolls[index % len(rolls)])
    edit_bones(rig, change)


def _straighten(bones: bpy.types.ArmatureEditBones, side: str, along: Vector) -> None:
    for name in ("upper_arm", "forearm", "hand"):
        move_tail(bones[f"{name}.{side}"], along * bones[f"{name}.{side}"].length)


def move_tail(bone: bpy.types.EditBone, along: Vector) -> None:
    """Gives a bone another direction and length; what hangs on it goes along unchanged."""
    shift = bone.head + along - bone.tail
    bone.tail += shift
    for child in bone.children_recursive:
        if not child.use_connect:  # else Blender has moved it with its parent's tail
            child.head += shift
        child.tail += shift


def edit_bones(rig: bpy.types.Object, change: Callable[[bpy.types.ArmatureEditBones], object]) -> None:
    """Changes a rig's rest pose in Edit Mode."""
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    change(rig.data.edit_bones)
    bpy.ops.object.mode_set(mode="OBJECT")


def random_motion(rig: bpy.types.Object, skeleton: Skeleton, seed: int, frames: int) -> np.ndarray:
    """Joint centres (frames, 27, 3) in the world of `rig` posed at random but smoothly; the rig is then at rest again.

    The poses are set and read through Blender. Pelvis and chest stay rigid because only their own bones are turned;
    elbows and knees turn about their hinges.
    """
    random = np.random.default_rng(seed)
    swings = {segment: (random.uniform(-1, 1, (3, 2)), _SWING[segment.split(".")[0]]) for segment in skeleton.segments
              if segment.split(".")[0] in _SWING}  # the chest is left out: it turns with the spine
    joints = []
    for frame in range(frames):
        phase = np.array([math.sin(2.0 * math.pi * frame / frames), math.cos(2.0 * math.pi * frame / frames)])
        for segment, (amounts, degrees) in swings.items():
            bone = rig.pose.bones[skeleton.bones.names[skeleton.segments[segment]]]
            bone.matrix_basis = _turned(skeleton, segment, np.radians(degrees) * (amounts @ phase))
            if segment == "pelvis":
                moved = Vector(0.2 * phase[0] * random_direction(seed) / skeleton.bones.scale)
                bone.matrix_basis = Matrix.Translation(moved) @ bone.matrix_basis
        bpy.context.view_layer.update()
        joints.append(sample_now(rig, skeleton))
    for bone in rig.pose.bones:
        bone.matrix_basis = Matrix()
    bpy.context.view_layer.update()
    return np.stack(joints)


def _turned(skeleton: Skeleton, segment: str, angles: np.ndarray) -> Matrix:
    """A bone's own rotation: about all three axes, or only the right way about the hinge of an elbow or a knee."""
    name, _, side = segment.partition(".")
    if name not in ("forearm", "shin"):
        return Euler(angles).to_matrix().to_4x4()
    hinge = rest_hinge(skeleton, name, dict(SIDES)[side])
    own = skeleton.bones.rotations[skeleton.segments[segment]].T @ hinge
    return Matrix.Rotation(0.1 + abs(float(angles[0])), 4, Vector(own))


def rest_hinge(skeleton: Skeleton, name: str, word: str) -> np.ndarray:
    """(3,) the axis of an elbow ("forearm") or a knee ("shin") at rest: of its bend, or of a straight limb's."""
    names = ("shoulder", "elbow", "wrist") if name == "forearm" else ("hip", "knee", "ankle")
    first, middle, last = (skeleton.joint(f"{word}_{joint}") for joint in names)
    upper, lower = normalise(middle - first), normalise(last - middle)
    _, ahead, up = skeleton.axes
    straight = cross(upper, ahead if name == "forearm" else -ahead)
    if name == "forearm" and np.linalg.norm(straight) <= 0.2:  # it points ahead: the elbow bends upwards
        straight = cross(upper, up)
    bend = cross(upper, lower)
    is_bent = np.linalg.norm(bend) > math.sin(math.radians(LEAST_REST_BEND_DEG)) and bend @ straight > 0.0
    return normalise(reject(bend if is_bent else straight, upper))


def turn_about(axis: object, angle: float) -> np.ndarray:
    """(3, 3) by Rodrigues' formula in double precision, which mathutils lacks."""
    x, y, z = normalise(np.asarray(axis, float))
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + math.sin(angle) * skew + (1.0 - math.cos(angle)) * (skew @ skew)


def random_direction(seed: int) -> np.ndarray:
    direction = np.random.default_rng(seed + 1).normal(size=3)
    return direction / np.linalg.norm(direction)


def sample_now(rig: bpy.types.Object, skeleton: Skeleton) -> np.ndarray:
    """(27, 3): the joint centres in the scene as it is."""
    return sample(rig, skeleton, [bpy.context.scene.frame_current]).joints[0]
