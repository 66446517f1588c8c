# SPDX-License-Identifier: GPL-3.0-or-later
"""What a posture costs the lower back: moments at L5/S1 of weight above it and of a load in the hands. Statics only."""
from __future__ import annotations

import numpy as np

from .rigs.joints import INDEX
from .rigs.rotations import Array

GRAVITY = 9.81
#: (from, to, how far along the centre of mass lies, share of the body's mass): Winter, Biomechanics and Motor Control of
#: Human Movement, 2009, table 4.1: abdomen, thorax, head and neck, then upper arm, forearm and hand of either side.
PARTS = (("l5s1", "c7t1", 0.25, 0.139), ("l5s1", "c7t1", 0.70, 0.216), ("c7t1", "tragion", 0.90, 0.081),
         *((f"{side}_{upper}", f"{side}_{lower}", along, share) for side in ("left", "right")
           for upper, lower, along, share in (("shoulder", "elbow", 0.436, 0.028), ("elbow", "wrist", 0.430, 0.016),
                                              ("wrist", "grip", 0.90, 0.006))))


def back_moment(joints: Array, body_mass: float, load: float = 0.0, load_centres: Array | None = None) -> Array:
    """(F,) newton metres that the back must hold against gravity: |sum of weight times level distance from L5/S1|.

    joints: (F, 27, 3) joint centres, world, metres, z up. Masses in kilograms. load_centres: (F, 3) of what is carried,
    NaN in frames in which it is not. Whoever moves needs more: accelerations are left out.
    """
    pelvis = joints[:, INDEX["l5s1"]]
    level = np.zeros((len(joints), 2))
    for upper, lower, along, share in PARTS:
        first, last = joints[:, INDEX[upper]], joints[:, INDEX[lower]]
        level += share * body_mass * (first + along * (last - first) - pelvis)[:, :2]
    if load_centres is not None:
        level += load * np.nan_to_num((load_centres - pelvis)[:, :2])
    return GRAVITY * np.linalg.norm(level, axis=1)


def trunk_inclination(joints: Array) -> Array:
    """(F,) radians of the line from L5/S1 to C7/T1 from the vertical."""
    trunk = joints[:, INDEX["c7t1"]] - joints[:, INDEX["l5s1"]]
    return np.arctan2(np.linalg.norm(trunk[:, :2], axis=1), trunk[:, 2])
