# SPDX-License-Identifier: GPL-3.0-or-later
"""A rig at rest, in world metres: its bones, the joint centres they imply and the body frame.

Body frame: origin on the floor midway between the ankles, x to the subject's right, y forward, z up (world z).
"""
from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .bone_map import PARENTS, BoneMap
from .joints import INDEX, JOINTS, SIDES
from .rotations import Array, cross

MAX_LEAN_DEG = 60.0
#: The lowest bone of the feet is at most this part of the height above the floor.
_SOLE = 0.05
#: (forward, up) of a person who stands and looks ahead, as parts of the height; as native/src/body has them.
_C7T1_TO_TRAGION, _TRAGION_TO_NASION = (0.034, 0.074), (0.054, 0.008)
_HALF_HAND = 0.25          #: from grip to the front of the hand, as a part of wrist to grip; as native/src/body has it
_LEAST_TRIANGLE = 0.004    #: height of the flattest triangle of joints that still shows a turn, as a part of the height

#: Joint centres at the heads of bones, and the segments of these bones.
_HEADS: dict[str, str] = {
    **{f"{word}_{joint}": f"{segment}.{side}" for side, word in SIDES for joint, segment in (
        ("ankle", "foot"), ("knee", "shin"), ("hip", "thigh"), ("shoulder", "upper_arm"), ("elbow", "forearm"),
        ("wrist", "hand"), ("clavicle", "clavicle"))},
    "l5s1": "spine", "c7t1": "neck",
}
_AT_HEADS = [INDEX[joint] for joint in _HEADS]
#: What the motion turns between two joints, and what with three.
_LINKS: tuple[tuple[str, str], ...] = (
    ("l5s1", "c7t1"), ("left_hip", "right_hip"),
    *((f"{word}_{start}", f"{word}_{end}") for _, word in SIDES for start, end in (
        ("clavicle", "shoulder"), ("shoulder", "elbow"), ("elbow", "wrist"), ("wrist", "grip"), ("hip", "knee"),
        ("knee", "ankle"), ("ankle", "ball"))))
_LINK_ENDS = np.array([[INDEX[end] for end in link] for link in _LINKS])
_TRIANGLES = (("pelvis", ("left_hip", "right_hip", "l5s1")), ("chest", ("l5s1", "c7t1", "left_clavicle")),
              ("chest", ("l5s1", "c7t1", "right_clavicle")))
_TRIANGLE_CORNERS = np.array([[INDEX[corner] for corner in corners] for _, corners in _TRIANGLES])


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
    implied: frozenset[str] = frozenset()  #: names of bones that the armature lacks; see implied_bones.py

    @cached_property
    def _index(self) -> dict[str, int]:
        return {name: number for number, name in enumerate(self.names)}

    def index(self, name: str) -> int:
        return self._index[name]

    def ancestors(self, bone: int) -> Iterator[int]:
        """From the bone's parent up to the root."""
        while (bone := self.parents[bone]) >= 0:
            yield bone

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
    fitted = bone_map.fitted(frozenset(bones.names), name)
    segments = {segment: bones.index(bone) for segment, bone in fitted.segments.items()}
    _check_hierarchy(name, bones, segments)
    keyed = sorted({bone for mapped in segments.values() for bone in (mapped, *bones.ancestors(mapped))})
    top = float(_heights(bones, {segments["head"]}).max())
    floor = _floor(bones, float(_heights(bones, {segments["foot.L"], segments["foot.R"]}).min()), top)
    joints = _main_joints(bones, fitted, segments)
    axes = _body_axes(name, joints)
    _check_lengths(name, joints, top - floor)
    _check_triangles(name, fitted, joints, top - floor)
    _check_sides(name, fitted, joints, axes)
    _add_derived_joints(joints, axes, top - floor)
    ankles = 0.5 * (joints[INDEX["left_ankle"]] + joints[INDEX["right_ankle"]])
    return Skeleton(name, bones, fitted, segments, tuple(keyed), joints, np.array([*ankles[:2], floor]), axes,
                    top - floor)


def _heights(bones: Bones, roots: set[int]) -> Array:
    """Of the heads and tails of these bones and all below them."""
    family = bones.family(roots)
    return np.concatenate([bones.heads[family, 2], bones.tails[family, 2]])


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
    joints[_AT_HEADS] = heads[[segments[segment] for segment in _HEADS.values()]]
    for side, word in SIDES:
        toe = segments.get(f"toe.{side}")
        joints[INDEX[f"{word}_ball"]] = tails[segments[f"foot.{side}"]] if toe is None else heads[toe]
        grip = bone_map.grip(side)
        bone = bones.index(grip.bone)
        if segments[f"hand.{side}"] not in (bone, *bones.ancestors(bone)):
            raise ValueError(f"Bone map '{bone_map.name}': grip.{side} is on bone '{grip.bone}', "
                             f"which is not the hand bone or below it")
        joints[INDEX[f"{word}_grip"]] = (1.0 - grip.along) * heads[bone] + grip.along * tails[bone]
    joints[INDEX["suprasternale"]] = 0.5 * (joints[INDEX["left_clavicle"]] + joints[INDEX["right_clavicle"]])
    return joints


def _body_axes(name: str, joints: Array) -> Array:
    across = (joints[INDEX["right_hip"]] - joints[INDEX["left_hip"]]).tolist()
    level, length = math.hypot(*across[:2]), math.hypot(*across)
    if level < 0.5 * length or length < 1e-6:
        raise ValueError(f"Rig '{name}': its hips do not lie side by side, so it has no left and right")
    x, y = across[0] / level, across[1] / level
    trunk = (joints[INDEX["c7t1"]] - joints[INDEX["l5s1"]]).tolist()
    lean = math.degrees(math.atan2(math.hypot(*trunk[:2]), trunk[2]))
    if lean > MAX_LEAN_DEG:
        raise ValueError(f"Rig '{name}' does not stand upright: its trunk leans {lean:.0f} degrees from the world's z, "
                         f"the limit is {MAX_LEAN_DEG:.0f}")
    return np.array([[x, y, 0.0], [-y, x, 0.0], [0.0, 0.0, 1.0]])


def _check_lengths(name: str, joints: Array, height: float) -> None:
    """Every link the motion turns needs a length; a millionth of the height is none."""
    spans = joints[_LINK_ENDS[:, 1]] - joints[_LINK_ENDS[:, 0]]
    for link in np.flatnonzero(np.sqrt(np.sum(spans * spans, axis=1)) < 1e-6 * max(height, 1e-9)):
        start, end = (end.replace("_", " ") for end in _LINKS[link])
        raise ValueError(f"Rig '{name}': {start} and {end} are the same point, "
                         f"so there is nothing to turn between them")


def _check_triangles(name: str, bone_map: BoneMap, joints: Array, height: float) -> None:
    """Pelvis and chest turn with the triangles of their joints; three joints in a line leave the turn about it open."""
    places = joints[_TRIANGLE_CORNERS]                               # (triangle, corner, 3)
    sides = places - places[:, [2, 0, 1]]
    areas = cross(sides[:, 1], -sides[:, 0])
    longest = np.sqrt(np.sum(sides * sides, axis=2)).max(axis=1)
    for flat in np.flatnonzero(np.sqrt(np.sum(areas * areas, axis=1)) < _LEAST_TRIANGLE * height * longest):
        part, corners = _TRIANGLES[flat]
        bones = ", ".join(f"'{bone_map.segments[_HEADS[corner]]}'" for corner in corners)
        raise ValueError(f"Rig '{name}': the bones {bones} start on one line, so the turn of the {part} about it "
                         f"cannot be read from them; move one of them or map others")


def _check_sides(name: str, bone_map: BoneMap, joints: Array, axes: Array) -> None:
    """The body frame has left and right from the hips: the arms must agree, and the feet must point forward."""
    def bones(segment: str) -> str:
        return f"'{bone_map.segments[f'{segment}.L']}' and '{bone_map.segments[f'{segment}.R']}'"

    feet = [(joints[INDEX[f"{word}_ball"]] - joints[INDEX[f"{word}_ankle"]]) @ axes[1] for _, word in SIDES]
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
