# SPDX-License-Identifier: GPL-3.0-or-later
"""A rig at rest, in world metres: its bones, the joint centres they imply and the body frame.

Body frame: origin on the floor midway between the ankles, x to the subject's right, y forward, z up (world z).
"""
from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from .bone_map import PARENTS, BoneMap
from .joints import INDEX, JOINTS, SIDES
from .rotations import Array, dot, normalise

MAX_LEAN_DEG = 60.0
#: The lowest bone of the feet is at most this part of the height above the floor.
_SOLE = 0.05
#: (forward, up) of a person who stands and looks ahead, as parts of the height; as native/src/body has them.
_C7T1_TO_TRAGION, _TRAGION_TO_NASION = (0.034, 0.074), (0.054, 0.008)
_HALF_HAND = 0.25          #: from grip to the front of the hand, as a part of wrist to grip; as native/src/body has it
_LEAST_TRIANGLE = 0.004    #: height of the flattest triangle of joints that still shows a turn, as a part of the height


@dataclass(frozen=True)
class Bones:
    """Rest bones of an armature, parents before children, in world metres."""

    names: tuple[str, ...]
    parents: tuple[int, ...]  #: index of the parent, -1 for a root
    heads: Array              #: (B, 3)
    tails: Array              #: (B, 3)
    rotations: Array          #: (B, 3, 3): columns are the bone's own x, y (head to tail), z
    origin: Array             #: (3,) the armature's own origin
    axes: Array               #: (3, 3): columns are the armature's own x, y, z
    scale: float = 1.0        #: world metres per unit of the armature

    def index(self, name: str) -> int:
        return self.names.index(name)

    def ancestors(self, bone: int) -> list[int]:
        """From the bone's parent up to the root."""
        chain = []
        while (bone := self.parents[bone]) >= 0:
            chain.append(bone)
        return chain

    def family(self, bones: set[int]) -> list[int]:
        """These bones and all their descendants."""
        found = set(bones)
        for bone, parent in enumerate(self.parents):
            if parent in found:
                found.add(bone)
        return sorted(found)


@dataclass(frozen=True)
class Skeleton:
    """A rig that fits a bone map. Built by `build_skeleton`, which checks everything the other functions rely on."""

    name: str
    bones: Bones
    bone_map: BoneMap
    segments: dict[str, int]   #: segment -> bone index
    keyed: tuple[int, ...]     #: mapped bones and their ancestors, parents first
    joints: Array              #: (27, 3) world: rest joint centres
    origin: Array              #: (3,) world: origin of the body frame
    axes: Array                #: (3, 3): rows are the body frame's x, y, z in the world
    height: float              #: metres from the floor to the top of the head

    def to_body(self, points: Array) -> Array:
        """World points (..., 3) in the body frame."""
        return (np.asarray(points, float) - self.origin) @ self.axes.T

    def to_world(self, points: Array) -> Array:
        """Body-frame points (..., 3) in the world."""
        return np.asarray(points, float) @ self.axes + self.origin

    def joint(self, name: str) -> Array:
        return self.joints[INDEX[name]]

    def has(self, segment: str) -> bool:
        return segment in self.segments


def build_skeleton(name: str, bones: Bones, bone_map: BoneMap) -> Skeleton:
    """A checked skeleton; ValueError says in one sentence which bone cannot serve and why."""
    fitted = bone_map.fitted(bones.names, name)
    segments = {segment: bones.index(bone) for segment, bone in fitted.segments.items()}
    _check_hierarchy(name, bones, segments)
    keyed = sorted({bone for mapped in segments.values() for bone in (mapped, *bones.ancestors(mapped))})
    top = _extreme(max, bones, {segments["head"]})
    floor = _floor(bones, _extreme(min, bones, {segments["foot.L"], segments["foot.R"]}), top)
    joints = _main_joints(bones, fitted, segments)
    axes = _body_axes(name, joints)
    _check_lengths(name, joints, top - floor)
    _check_triangles(name, fitted, joints, top - floor)
    _check_sides(name, fitted, joints, axes)
    _add_derived_joints(joints, axes, top - floor)
    ankles = 0.5 * (joints[INDEX["left_ankle"]] + joints[INDEX["right_ankle"]])
    return Skeleton(name, bones, fitted, segments, tuple(keyed), joints, np.array([*ankles[:2], floor]), axes,
                    top - floor)


def _extreme(choose: Callable[[Iterable[float]], float], bones: Bones, roots: set[int]) -> float:
    """The lowest or highest end of these bones and all below them."""
    return choose(float(ends[bone, 2]) for bone in bones.family(roots) for ends in (bones.heads, bones.tails))


def _floor(bones: Bones, lowest: float, top: float) -> float:
    """Height of the floor: of the rig's origin if that is a sole's thickness below the feet's bones, else of those."""
    origin = float(bones.origin[2])
    return origin if lowest - _SOLE * (top - lowest) <= origin <= lowest else lowest


def _check_hierarchy(name: str, bones: Bones, segments: dict[str, int]) -> None:
    owners = {bone: segment for segment, bone in segments.items()}
    for segment, bone in segments.items():
        if segment == "chest" and bone == segments["spine"]:
            continue
        above = next((owners[ancestor] for ancestor in bones.ancestors(bone) if ancestor in owners), None)
        allowed = PARENTS[segment]
        if allowed and above not in allowed:
            raise ValueError(f"Rig '{name}': bone '{bones.names[bone]}' ({segment}) must hang below the bone of "
                             f"{' or '.join(allowed)}, but the nearest mapped bone above it is {above or 'none'}")


def _main_joints(bones: Bones, bone_map: BoneMap, segments: dict[str, int]) -> Array:
    joints = np.full((len(JOINTS), 3), np.nan)
    heads, tails = bones.heads, bones.tails
    for side, word in SIDES:
        for joint, segment in (("ankle", "foot"), ("knee", "shin"), ("hip", "thigh"), ("shoulder", "upper_arm"),
                               ("elbow", "forearm"), ("wrist", "hand"), ("clavicle", "clavicle")):
            joints[INDEX[f"{word}_{joint}"]] = heads[segments[f"{segment}.{side}"]]
        toe = segments.get(f"toe.{side}")
        joints[INDEX[f"{word}_ball"]] = tails[segments[f"foot.{side}"]] if toe is None else heads[toe]
        grip = bone_map.grip(side)
        bone = bones.index(grip.bone)
        if segments[f"hand.{side}"] not in (bone, *bones.ancestors(bone)):
            raise ValueError(f"Bone map '{bone_map.name}': grip.{side} is on bone '{grip.bone}', "
                             f"which is not the hand bone or below it")
        joints[INDEX[f"{word}_grip"]] = (1.0 - grip.along) * heads[bone] + grip.along * tails[bone]
    joints[INDEX["l5s1"]] = heads[segments["spine"]]
    joints[INDEX["c7t1"]] = heads[segments["neck"]]
    joints[INDEX["suprasternale"]] = 0.5 * (joints[INDEX["left_clavicle"]] + joints[INDEX["right_clavicle"]])
    return joints


def _body_axes(name: str, joints: Array) -> Array:
    across = joints[INDEX["right_hip"]] - joints[INDEX["left_hip"]]
    right = np.array([across[0], across[1], 0.0])
    if np.linalg.norm(right) < 0.5 * np.linalg.norm(across) or np.linalg.norm(across) < 1e-6:
        raise ValueError(f"Rig '{name}': its hips do not lie side by side, so it has no left and right")
    right = normalise(right)
    up = np.array([0.0, 0.0, 1.0])
    trunk = normalise(joints[INDEX["c7t1"]] - joints[INDEX["l5s1"]])
    lean = math.degrees(math.acos(float(np.clip(trunk[2], -1.0, 1.0))))
    if lean > MAX_LEAN_DEG:
        raise ValueError(f"Rig '{name}' does not stand upright: its trunk leans {lean:.0f} degrees from the world's z, "
                         f"the limit is {MAX_LEAN_DEG:.0f}")
    return np.stack([right, np.cross(up, right), up])


def _check_lengths(name: str, joints: Array, height: float) -> None:
    """Every link the motion turns needs a length; a millionth of the height is none."""
    links = [("l5s1", "c7t1"), ("left_hip", "right_hip")]
    for _, word in SIDES:
        links += [(f"{word}_{a}", f"{word}_{b}") for a, b in (
            ("clavicle", "shoulder"), ("shoulder", "elbow"), ("elbow", "wrist"), ("wrist", "grip"),
            ("hip", "knee"), ("knee", "ankle"), ("ankle", "ball"))]
    for start, end in links:
        if np.linalg.norm(joints[INDEX[end]] - joints[INDEX[start]]) < 1e-6 * max(height, 1e-9):
            raise ValueError(f"Rig '{name}': {start.replace('_', ' ')} and {end.replace('_', ' ')} are the same point, "
                             f"so there is nothing to turn between them")


def _check_triangles(name: str, bone_map: BoneMap, joints: Array, height: float) -> None:
    """Pelvis and chest turn with the triangles of their joints; three joints in a line leave the turn about it open."""
    heads = {"left_hip": "thigh.L", "right_hip": "thigh.R", "l5s1": "spine", "c7t1": "neck",
             "left_clavicle": "clavicle.L", "right_clavicle": "clavicle.R"}
    for part, corners in (("pelvis", ("left_hip", "right_hip", "l5s1")), ("chest", ("l5s1", "c7t1", "left_clavicle")),
                          ("chest", ("l5s1", "c7t1", "right_clavicle"))):
        places = joints[[INDEX[corner] for corner in corners]]
        longest = max(np.linalg.norm(places[i] - places[i - 1]) for i in range(3))
        if np.linalg.norm(np.cross(places[1] - places[0], places[2] - places[0])) < _LEAST_TRIANGLE * height * longest:
            bones = ", ".join(f"'{bone_map.segments[heads[corner]]}'" for corner in corners)
            raise ValueError(f"Rig '{name}': the bones {bones} start on one line, so the turn of the {part} about it "
                             f"cannot be read from them; move one of them or map others")


def _check_sides(name: str, bone_map: BoneMap, joints: Array, axes: Array) -> None:
    """The body frame has left and right from the hips: the arms must agree, and the feet must point forward."""
    def bones(segment: str) -> str:
        return f"'{bone_map.segments[f'{segment}.L']}' and '{bone_map.segments[f'{segment}.R']}'"

    feet = [normalise(joints[INDEX[f"{word}_ball"]] - joints[INDEX[f"{word}_ankle"]]) @ axes[1] for _, word in SIDES]
    if min(feet) <= 0.0:
        raise ValueError(f"Rig '{name}': seen from the hips, {bones('foot')} do not both point forward; "
                         f"{bones('thigh')} look exchanged, left with right")
    for joint, segment in (("clavicle", "clavicle"), ("shoulder", "upper_arm")):
        if (joints[INDEX[f"right_{joint}"]] - joints[INDEX[f"left_{joint}"]]) @ axes[0] <= 0.0:
            raise ValueError(f"Rig '{name}': {bones(segment)} lie on the other sides than {bones('thigh')}; they look "
                             f"exchanged, left with right")


def _add_derived_joints(joints: Array, axes: Array, height: float) -> None:
    """Head: where a person's would be who looks ahead as the rig does, whichever way its neck bones happen to lean.
    Hand: front and back on the line from the wrist through the grip, which lies midway between them."""
    for start, end, (forward, up) in (("c7t1", "tragion", _C7T1_TO_TRAGION), ("tragion", "nasion", _TRAGION_TO_NASION)):
        joints[INDEX[end]] = joints[INDEX[start]] + height * (forward * axes[1] + up * axes[2])
    for _, word in SIDES:
        grip = joints[INDEX[f"{word}_grip"]]
        half = _HALF_HAND * (grip - joints[INDEX[f"{word}_wrist"]])
        joints[INDEX[f"{word}_hand_front"]], joints[INDEX[f"{word}_hand_back"]] = grip + half, grip - half


def rest_hinge(upper: Array, axes: Array) -> Array:
    """(3,) the elbow's axis of a straight arm along unit `upper`: it bends forward, and up if it points forward."""
    across = np.cross(upper, axes[1])
    return normalise(across if np.linalg.norm(across) > 0.2 else np.cross(upper, axes[2]))


def rest_palm(joints: Array, axes: Array, side: str) -> Array:
    """(3,) out of the palm at rest, across the hand: down in a T pose, inwards when the arms hang."""
    word = dict(SIDES)[side]
    upper = normalise(joints[INDEX[f"{word}_elbow"]] - joints[INDEX[f"{word}_shoulder"]])
    hand = normalise(joints[INDEX[f"{word}_grip"]] - joints[INDEX[f"{word}_wrist"]])
    normal = rest_hinge(upper, axes) * (-1.0 if side == "R" else 1.0)
    return normalise(normal - hand * dot(normal, hand))


def rest_bend(joints: Array, side: str, names: tuple[str, str, str], straight: Array, least_deg: float) -> Array:
    """(3,) hinge axis of a limb at rest: from its own bend when it is bent by `least_deg`, else `straight`."""
    word = dict(SIDES)[side]
    first, middle, last = (joints[INDEX[f"{word}_{name}"]] for name in names)
    upper, lower = normalise(middle - first), normalise(last - middle)
    bend = np.cross(upper, lower)
    chosen = bend if np.linalg.norm(bend) > math.sin(math.radians(least_deg)) and bend @ straight > 0.0 else straight
    return normalise(chosen - upper * dot(chosen, upper))

