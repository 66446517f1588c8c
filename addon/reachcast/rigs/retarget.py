# SPDX-License-Identifier: GPL-3.0-or-later
"""Joint centres over time -> the pose of a rig. The mathematics is native: see native/include/reachcast/rig."""
from __future__ import annotations

from typing import Any

from ..native import core
from .joints import JOINTS
from .rotations import Array
from .skeleton import Skeleton

#: The joints that a posed rig passes through exactly. Of the nasion only the direction is kept, for the head bone does
#: not turn about the tragion; the front and back of the hands give way to the palms, which are turned to face each
#: other.
EXACT_JOINTS = tuple(index for index, name in enumerate(JOINTS)
                     if name != "nasion" and not name.endswith(("hand_front", "hand_back")))


def retarget(skeleton: Skeleton, joints: Array) -> Any:
    """The reachcast_core.RigPose for joint centres (F, 27, 3) in the world; its bones are `skeleton.keyed`."""
    bones = skeleton.bones
    rest = core().RestRig(bones.parents, bones.heads, bones.rotations, skeleton.segments, skeleton.joints,
                          skeleton.axes)
    return rest.retarget(joints)
