# SPDX-License-Identifier: GPL-3.0-or-later
"""Joint centres over time -> the pose of a rig. The mathematics is native: see native/include/reachcast/rig."""
from __future__ import annotations

from typing import Any

import numpy as np

from ..native import core
from .joints import JOINTS
from .rotations import Array
from .skeleton import Skeleton

#: The joints that a posed rig passes through exactly. Of the nasion only the direction is kept, for the head bone does
#: not turn about the tragion; the front and back of the hands give way to the palms, which are turned to face each
#: other.
EXACT_JOINTS = tuple(index for index, name in enumerate(JOINTS)
                     if name != "nasion" and not name.endswith(("hand_front", "hand_back")))


def retarget(skeleton: Skeleton, joints: Array, bends: Array | tuple[()] = ()) -> Any:
    """The reachcast_core.RigPose for joint centres (F, 27, 3) in the world; its bones are `skeleton.keyed`.

    bends: (F,) radians, how far the back is bent, which the bones between spine and chest share; none: not at all.
    """
    return _rest_rig(skeleton).retarget(joints, bends)


def body_of(skeleton: Skeleton) -> Any:
    """The reachcast_core.Body with the rig's measures; its back bends where the bones between spine and chest meet.

    The back of a control rig does not bend: its bones have one control.
    """
    body = core().Body.from_posture(skeleton.to_body(skeleton.joints), skeleton.height)
    stiff = bool(skeleton.bone_map.controls)
    return body.bending_at(np.empty((0, 3)) if stiff else skeleton.to_body(_rest_rig(skeleton).back_joints))


def _rest_rig(skeleton: Skeleton) -> Any:
    bones = skeleton.bones
    return core().RestRig(bones.parents, bones.heads, bones.rotations, skeleton.segments, skeleton.joints,
                          skeleton.axes)
