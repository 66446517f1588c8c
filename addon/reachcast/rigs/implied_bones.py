# SPDX-License-Identifier: GPL-3.0-or-later
"""Clavicles for rigs without: a shoulder moves all the same, so its upper arm is placed where a clavicle would put it."""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from .bone_map import BoneMap
from .rotations import Array
from .skeleton import Bones

#: Root of a clavicle: this part of the way from the neck to the shoulder, and forward and down by parts of that way.
_ASIDE, _AHEAD, _DOWN = 0.12, 0.25, 0.15


def with_clavicles(bones: Bones, bone_map: BoneMap) -> tuple[Bones, BoneMap]:
    """The same with a bone for each clavicle that is not mapped, between the upper arm and what it hangs on.

    `bone_map` fits but for that.
    """
    for side in "LR":
        if bone_map.segments.get(f"clavicle.{side}") not in bones.names:
            bones, bone_map = _with_one(bones, bone_map, side)
    return bones, bone_map


def _with_one(bones: Bones, bone_map: BoneMap, side: str) -> tuple[Bones, BoneMap]:
    name = f"(no clavicle.{side})"
    arm = bones.index(bone_map.segments[f"upper_arm.{side}"])
    parents = [parent if parent < arm else parent + 1 for parent in bones.parents]
    parents[arm:arm + 1] = [parents[arm], arm]
    shoulder = bones.heads[arm]
    made = replace(bones, names=(*bones.names[:arm], name, *bones.names[arm:]), parents=tuple(parents),
                   heads=np.insert(bones.heads, arm, _root(bones, bone_map, shoulder), axis=0),
                   tails=np.insert(bones.tails, arm, shoulder, axis=0),
                   rotations=np.insert(bones.rotations, arm, np.eye(3), axis=0), implied=bones.implied | {name})
    return made, replace(bone_map, segments={**bone_map.segments, f"clavicle.{side}": name})


def _root(bones: Bones, bone_map: BoneMap, shoulder: Array) -> Array:
    neck, left, right = (bones.heads[bones.index(bone_map.segments[name])] for name in ("neck", "thigh.L", "thigh.R"))
    across = (right - left) / max(float(np.linalg.norm(right - left)), 1e-12)
    way = shoulder - neck
    length = float(np.linalg.norm(way))
    return neck + _ASIDE * way + length * (_AHEAD * np.array([-across[1], across[0], 0.0]) - _DOWN * np.array([0, 0, 1.0]))
