# SPDX-License-Identifier: GPL-3.0-or-later
"""Joint centres over time as a BVH file: a skeleton at rest with its arms sideways, and rotations from there."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .bvh_document import BvhJoint, bvh_document

_TO_Y_UP = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
#: Parts of stature from the last joint up to the crown of the head and down to the sole (Drillis & Contini 1966).
_BEYOND = {"nasion": 0.064, "ball": -0.02}
_RIGHT, _FORWARD, _UP = np.eye(3)
_SIDES = {"left": -_RIGHT, "right": _RIGHT}


@dataclass(frozen=True)
class _Node:
    joint: str                                          #: "chest" is the trunk above l5s1, and lies there
    parent: str | None
    shape: tuple[str, str] | None = None                #: joints that, with this one, turn as one piece
    ahead: str | None = None                            #: else the joint at the end of the link


def _limbs(side: str) -> list[_Node]:
    def chain(first: str, *joints: str) -> list[_Node]:
        names = [first, *(f"{side}_{joint}" for joint in joints)]
        return [_Node(name, above, ahead=after) for above, name, after in zip(names, names[1:], [*names[2:], None])]

    fingers = [_Node(f"{side}_{joint}", f"{side}_wrist") for joint in ("hand_front", "hand_back")]
    return [*chain("l5s1", "hip", "knee", "ankle", "ball"),
            *chain("chest", "clavicle", "shoulder", "elbow", "wrist", "grip"), *fingers]


#: Parents before children.
_SKELETON = [
    _Node("l5s1", None, ("left_hip", "right_hip")), _Node("chest", "l5s1", ("c7t1", "suprasternale")),
    _Node("suprasternale", "chest"), _Node("c7t1", "chest", ahead="tragion"),
    _Node("tragion", "c7t1", ahead="nasion"), _Node("nasion", "tragion"), *_limbs("left"), *_limbs("right"),
]


def bvh_text(names: Sequence[str], positions: np.ndarray, rate: float, stature: float) -> str:
    """A BVH file, metres and y up, of joint centres (frames, joints, 3) in metres, z up, facing +y; rate in Hz.
    The person's stature tells where the crown of the head and the soles end.

    Joints come back exactly where links keep their lengths and pelvis and chest their shape, as in predicted and
    replayed motions. Hands are straight lines from wrist to grip.
    """
    at = {name: positions[:, i] for i, name in enumerate(names)}
    at["chest"] = at["l5s1"]
    rest = _rest_pose(at)
    turns = _turns(at, rest)
    number = {node.joint: place for place, node in enumerate(_SKELETON)}
    joints = []
    for node in _SKELETON:
        offset = rest[node.joint] - rest[node.parent] if node.parent else np.zeros(3)
        end = stature * _BEYOND.get(node.joint.split("_")[-1], 0.0) * _UP
        joints.append(BvhJoint(node.joint, number[node.parent] if node.parent else None, _TO_Y_UP @ offset,
                               _TO_Y_UP @ end, _TO_Y_UP @ turns[node.joint] @ _TO_Y_UP.T))
    return bvh_document(joints, at["l5s1"] @ _TO_Y_UP.T, rate)


def _rest_pose(at: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Standing, arms sideways, with the lengths of the first frame."""
    first = {name: points[0] for name, points in at.items()}

    def length(a: str, b: str) -> float:
        return float(np.linalg.norm(first[a] - first[b]))

    rest = {"l5s1": np.zeros(3), "chest": np.zeros(3)}
    hips = _frame(first["right_hip"] - first["left_hip"], first["l5s1"] - first["left_hip"])
    trunk = _frame(first["c7t1"] - first["l5s1"], first["suprasternale"] - first["l5s1"])
    stood = np.stack([_UP, _FORWARD, np.cross(_UP, _FORWARD)], axis=1)
    for joint in ("left_hip", "right_hip"):
        local = hips.T @ (first[joint] - first["l5s1"])
        rest[joint] = np.array([local[0], 0.0, local[1]])
    for joint in ("c7t1", "suprasternale", "left_clavicle", "right_clavicle"):
        rest[joint] = stood @ trunk.T @ (first[joint] - first["l5s1"])
    rest["tragion"] = rest["c7t1"] + length("c7t1", "tragion") * _UP
    rest["nasion"] = rest["tragion"] + length("tragion", "nasion") * _FORWARD
    for side, outward in _SIDES.items():
        drop = first[f"{side}_ankle"][2] - first[f"{side}_ball"][2]
        foot = length(f"{side}_ankle", f"{side}_ball")
        toe = np.sqrt(max(foot ** 2 - drop ** 2, 0.0)) * _FORWARD - drop * _UP
        links = [("hip", "knee", -_UP), ("knee", "ankle", -_UP), ("ankle", "ball", toe / foot),
                 *((a, b, outward) for a, b in (("clavicle", "shoulder"), ("shoulder", "elbow"), ("elbow", "wrist"),
                                                ("wrist", "grip"), ("wrist", "hand_front"), ("wrist", "hand_back")))]
        for above, below, direction in links:
            above, below = f"{side}_{above}", f"{side}_{below}"
            rest[below] = rest[above] + length(above, below) * direction
    return rest


def _turns(at: dict[str, np.ndarray], rest: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """From rest to each frame, in the world, (frames, 3, 3) for every joint of the skeleton."""
    turns: dict[str, np.ndarray] = {}
    for node in _SKELETON:
        if node.shape:
            now = _frame(*(at[joint] - at[node.joint] for joint in node.shape))
            then = _frame(*(rest[joint] - rest[node.joint] for joint in node.shape))
            turns[node.joint] = now @ then.T
            continue
        above = turns[node.parent]
        if node.ahead:
            start = above @ _unit(rest[node.ahead] - rest[node.joint])
            above = _smallest_turn(start, _unit(at[node.ahead] - at[node.joint])) @ above
        turns[node.joint] = above
    return turns


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def _frame(primary: np.ndarray, secondary: np.ndarray) -> np.ndarray:
    """(..., 3, 3), columns: along `primary`, towards `secondary`, and across both."""
    first = _unit(primary)
    second = _unit(secondary - (secondary * first).sum(-1, keepdims=True) * first)
    return np.stack([first, second, np.cross(first, second)], axis=-1)


def _smallest_turn(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """(frames, 3, 3): brings unit vectors onto others by the shortest way; ValueError where they oppose."""
    normal, cosine = np.cross(start, end), (start * end).sum(-1)
    if cosine.min() < -1.0 + 1e-9:
        raise ValueError("a link points exactly opposite to where it points at rest; its turn is not defined")
    x, y, z = normal.T
    cross = np.stack([np.zeros_like(x), -z, y, z, np.zeros_like(x), -x, -y, x, np.zeros_like(x)], -1).reshape(-1, 3, 3)
    return np.eye(3) + cross + cross @ cross / (1.0 + cosine)[:, None, None]
