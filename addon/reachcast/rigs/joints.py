# SPDX-License-Identifier: GPL-3.0-or-later
"""The joint centres of the native module, in its order (native/include/reachcast/body/joints.hpp)."""
from __future__ import annotations

_LIMBS = ("ball", "ankle", "knee", "hip", "shoulder", "elbow", "wrist", "hand_front", "hand_back")

JOINTS: tuple[str, ...] = (
    *(f"left_{name}" for name in _LIMBS),
    *(f"right_{name}" for name in _LIMBS),
    "l5s1", "c7t1", "suprasternale", "tragion", "nasion",
    "left_grip", "right_grip", "left_clavicle", "right_clavicle",
)
INDEX: dict[str, int] = {name: index for index, name in enumerate(JOINTS)}
SIDES: tuple[tuple[str, str], ...] = (("L", "left"), ("R", "right"))
