# SPDX-License-Identifier: GPL-3.0-or-later
"""A rig's pose over time, and the box's places, as Actions."""
from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from bpy.utils import escape_identifier
from mathutils import Vector

from .. import native
from ..rigs.rotations import Array, from_quaternion, turn
from ..rigs.skeleton import Skeleton
from .action_writer import Channel, WriteAction, write_action
from .control_rig import control_channels, is_control_rig

_NOWHERE, _UNSCALED = Vector((0.0, 0.0, 0.0)), Vector((1.0, 1.0, 1.0))
_ROTATION_PATHS = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}


def write_rig_action(rig: bpy.types.Object, skeleton: Skeleton, pose: Any, name: str, first_frame: int,
                     write: WriteAction = write_action) -> bpy.types.Action:
    """A new Action on `rig` of a reachcast_core.RigPose: see `rig_channels`."""
    return write(rig, name, rig_channels(rig, skeleton, pose), first_frame)


def rig_channels(rig: bpy.types.Object, skeleton: Skeleton, pose: Any) -> list[Channel]:
    """A rotation per keyed bone and frame and the pelvis's place.

    A keyed bone that is posed with a scale or an offset of its own also gets one key that takes it to none.
    """
    if is_control_rig(skeleton):
        return control_channels(rig, skeleton, pose)
    pelvis = skeleton.segments["pelvis"]
    channels = []
    for bone in skeleton.keyed:
        bone_name = skeleton.bones.names[bone]
        if bone_name in skeleton.bones.implied:
            continue
        pose_bone = rig.pose.bones[bone_name]
        path = f'pose.bones["{escape_identifier(bone_name)}"].'
        mode = pose_bone.rotation_mode
        above = skeleton.bones.parents[bone]
        hangs = above >= 0 and skeleton.bones.names[above] in skeleton.bones.implied
        values = pose.rotation_values(bone, mode)
        if hangs:
            places, values = _past_implied(skeleton, pose, bone, mode)
            channels.append(Channel(path + "location", places, bone_name))
        elif bone == pelvis:
            channels.append(Channel(path + "location", _pelvis_location(rig, skeleton, pose), bone_name))
        elif pose_bone.location != _NOWHERE and not pose_bone.bone.use_connect:
            channels.append(Channel(path + "location", np.zeros((1, 3)), bone_name))
        channels.append(Channel(path + _ROTATION_PATHS.get(mode, "rotation_euler"),
                                values, bone_name))
        if pose_bone.scale != _UNSCALED:
            channels.append(Channel(path + "scale", np.ones((1, 3)), bone_name))
    return channels


def _past_implied(skeleton: Skeleton, pose: Any, bone: int, mode: str) -> tuple[Array, Array]:
    """Location (F, 3) and rotation values of a bone below an implied one, against the bone that it really hangs on."""
    bones = skeleton.bones
    above = bones.parents[bones.parents[bone]]
    own, held = skeleton.keyed.index(bone), skeleton.keyed.index(above)
    turns, heads, rest = np.asarray(pose.turns), np.asarray(pose.heads), bones.rotations[bone]
    back = np.swapaxes(turns[held], 1, 2)
    moved = turn(back, heads[own] - heads[held]) - (bones.heads[bone] - bones.heads[above])
    return moved @ rest / bones.scale, native.core().rotation_values(rest.T @ back @ turns[own] @ rest, mode)


def _pelvis_location(rig: bpy.types.Object, skeleton: Skeleton, pose: Any) -> Array:
    """(F, 3) in the axes the bone's location is given in: its own, or its parent's when Local Location is off."""
    bones, pelvis = skeleton.bones, skeleton.segments["pelvis"]
    moved = (pose.heads[skeleton.keyed.index(pelvis)] - bones.heads[pelvis]) / bones.scale
    if rig.data.bones[bones.names[pelvis]].use_local_location:
        axes = bones.rotations[pelvis]
    else:
        parent = bones.parents[pelvis]
        axes = bones.axes if parent < 0 else bones.rotations[parent]
    return moved @ axes


def box_channels(box: bpy.types.Object, above: Array, origins: Array, rotations: Array,
                 steps: tuple[int, ...]) -> list[Channel]:
    """The box's origin (F, 3) and rotation (F, 3, 3) in the world, in its own rotation mode, at these steps.

    above (4, 4): `transforms.above_matrix` of the box, of even scale.
    """
    scale = np.cbrt(np.linalg.det(above[:3, :3]))
    turned = above[:3, :3] / scale
    places = (origins - above[:3, 3]) @ turned / scale
    return [
        Channel("location", places, "Object Transforms", steps),
        Channel(_ROTATION_PATHS.get(box.rotation_mode, "rotation_euler"),
                native.core().rotation_values(turned.T @ rotations, box.rotation_mode), "Object Transforms", steps),
    ]


def box_world_places(skeleton: Skeleton, positions: Array, quaternions: Array) -> tuple[Array, Array]:
    """Box origins (F, 3) and turns (F, 3, 3) from the body frame to the world; the turn carries the body's x, y, z."""
    to_world = skeleton.axes.T
    return skeleton.to_world(positions), to_world @ from_quaternion(quaternions)
