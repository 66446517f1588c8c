# SPDX-License-Identifier: GPL-3.0-or-later
"""A motion on the controls of a generated Rigify rig: rotations, places and switch properties as channels."""
from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from bpy.utils import escape_identifier

from .. import native
from ..rigs.rigify_controls import ROOT, Control, Plan, Pole, plan
from ..rigs.rotations import Array, dot, normalise, transpose, turn
from ..rigs.skeleton import Skeleton
from .action_writer import Channel

RIGIFY = "rigify"                                            #: what a bone map of such a rig says in "controls"
HANDS, FEET = "reachcast_hands", "reachcast_feet"            #: properties of the armature object: FK or IK
CHOICES = (("FK", "FK", "Turn the limb's own controls, from the trunk outwards"),
           ("IK", "IK", "Place the control at its end, and a pole for its bend"))
_FALLBACK = 1e-4    #: weight of the limb's roll beside its bend, as a sine: decides only where the limb is straight
_PATHS = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}
_REST = {"location": (0.0, 0.0, 0.0), "scale": (1.0, 1.0, 1.0), "rotation_euler": (0.0, 0.0, 0.0),
         "rotation_quaternion": (1.0, 0.0, 0.0, 0.0), "rotation_axis_angle": (0.0, 0.0, 1.0, 0.0)}


def is_control_rig(skeleton: Skeleton) -> bool:
    return skeleton.bone_map.controls == RIGIFY


def plan_of(rig: bpy.types.Object) -> Plan:
    """What is written on `rig`, by its own choice of FK or IK."""
    return plan(getattr(rig, HANDS, "FK"), getattr(rig, FEET, "FK"))


def refuse_unusable(rig: bpy.types.Object) -> None:
    """ValueError in one sentence when a control is missing or something else than its keys moves it."""
    chosen = plan_of(rig)
    if absent := [bone for bone in (*chosen.bones, *chosen.stiff) if bone not in rig.pose.bones]:
        raise ValueError(f"Control rig '{rig.name}' lacks the controls {', '.join(absent)}; generate it from the human "
                         f"metarig, or map its bones by hand")
    for bone, name, _ in chosen.switches:
        if bone not in rig.pose.bones or name not in rig.pose.bones[bone]:
            raise ValueError(f"Control rig '{rig.name}' lacks the property {name} on '{bone}'; generate it anew")
    for bone in chosen.bones:
        for constraint in rig.pose.bones[bone].constraints:
            if not constraint.mute and constraint.influence > 0.0:
                raise ValueError(f"Bone '{bone}' of rig '{rig.name}' has the constraint '{constraint.name}', which would "
                                 f"move it beside its keys; mute or remove it")


def control_channels(rig: bpy.types.Object, skeleton: Skeleton, pose: Any) -> list[Channel]:
    """Channels of a reachcast_core.RigPose of the deform bones; see `rigify_controls` for what is written where."""
    writer = _Writer(rig, skeleton, pose)
    chosen = plan_of(rig)
    channels = [channel for control in chosen.controls for channel in writer.control(control)]
    channels += [writer.pole(pole) for pole in chosen.poles]
    for name in chosen.resting:
        channels += writer.resting(name)
    for bone, name, value in chosen.switches:
        path = f'pose.bones["{escape_identifier(bone)}"]["{escape_identifier(name)}"]'
        channels.append(Channel(path, np.array([[value]]), bone))
    channels += [_channel(rig.pose.bones[name], "ik_stretch", np.zeros((1, 1))) for name in chosen.stiff]
    return channels


class _Writer:
    """Frames first; all in the armature's own space, where a rotation is `turn @ rest`."""

    def __init__(self, rig: bpy.types.Object, skeleton: Skeleton, pose: Any) -> None:
        self.rig, self.skeleton, self.axes = rig, skeleton, skeleton.bones.axes
        self.slots = {segment: skeleton.keyed.index(bone) for segment, bone in skeleton.segments.items()}
        turns = np.asarray(pose.turns)
        self.world_turns, self.world_heads = turns, np.asarray(pose.heads)
        self.turns = self.axes.T @ turns @ self.axes
        self.frames = turns.shape[1]

    def turn_of(self, segment: str) -> Array:
        """(F, 3, 3)"""
        if segment == ROOT:
            return np.repeat(np.eye(3)[None], self.frames, axis=0)
        return self.turns[self.slots[segment]]

    def carried(self, segment: str, place: Array) -> Array:
        """(F, 3): where a point of the armature's rest pose goes with a segment."""
        bones, slot = self.skeleton.bones, self.slots[segment]
        world = bones.origin + bones.scale * self.axes @ place
        moved = self.world_heads[slot] + turn(self.world_turns[slot], world - bones.heads[self.skeleton.segments[segment]])
        return self.local(moved)

    def local(self, world: Array) -> Array:
        return (world - self.skeleton.bones.origin) @ self.axes / self.skeleton.bones.scale

    def control(self, control: Control) -> list[Channel]:
        bone = self.rig.pose.bones[control.bone]
        rest = _rest(bone)
        local = rest.T @ transpose(self.turn_of(control.above)) @ self.turn_of(control.segment) @ rest
        path = _PATHS.get(bone.rotation_mode, "rotation_euler")
        channels = [_channel(bone, path, native.core().rotation_values(local, bone.rotation_mode))]
        if control.places:
            channels.append(self._placed(bone, self.carried(control.segment, np.array(bone.bone.head_local))))
        return channels + _neutral(bone, ("scale",) if control.places else ("location", "scale"))

    def pole(self, pole: Pole) -> Channel:
        bone = self.rig.pose.bones[pole.bone]
        first, joint, last = (self.local(self.world_heads[self.slots[name]])
                              for name in (pole.upper, pole.lower, pole.end))
        rest = np.array(bone.bone.head_local)
        joint_rest = self.local(self.skeleton.bones.heads[self.skeleton.segments[pole.lower]])
        line = normalise(last - first)
        bend = joint - first
        bend = (bend - line * dot(bend, line)[:, None]) / np.linalg.norm(joint - first, axis=1)[:, None]
        kept = turn(self.turn_of(pole.upper), rest - joint_rest)
        kept = normalise(kept - line * dot(kept, line)[:, None])
        return self._placed(bone, joint + np.linalg.norm(rest - joint_rest) * normalise(bend + _FALLBACK * kept))

    def resting(self, name: str) -> list[Channel]:
        bone = self.rig.pose.bones[name]
        return _neutral(bone, ("location", _PATHS.get(bone.rotation_mode, "rotation_euler"), "scale"))

    def _placed(self, bone: bpy.types.PoseBone, places: Array) -> Channel:
        """`bone`, whose parent rests, at these places (F, 3)."""
        moved = places - np.array(bone.bone.head_local)
        if bone.bone.use_local_location:
            axes = _rest(bone)
        else:
            axes = _rest(bone.parent) if bone.parent else np.eye(3)
        return _channel(bone, "location", moved @ axes)


def _rest(bone: bpy.types.PoseBone) -> Array:
    return np.array(bone.bone.matrix_local, dtype=float)[:3, :3]


def _channel(bone: bpy.types.PoseBone, path: str, values: Array) -> Channel:
    return Channel(f'pose.bones["{escape_identifier(bone.name)}"].{path}', values, bone.name)


def _neutral(bone: bpy.types.PoseBone, paths: tuple[str, ...]) -> list[Channel]:
    """One key for each of these that is posed otherwise."""
    return [_channel(bone, path, np.array([_REST[path]])) for path in paths
            if tuple(getattr(bone, path)) != _REST[path] and not (path == "location" and bone.bone.use_connect)]
