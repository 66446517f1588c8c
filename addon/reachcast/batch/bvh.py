# SPDX-License-Identifier: GPL-3.0-or-later
"""A posed rig as BVH: the rest pose as offsets, every bone's turn against the bone above it."""
from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..reachcast_corpus.bvh_document import BvhJoint, bvh_document
from ..rigs.skeleton import Skeleton

MOST_OFF_M = 1e-3   #: of a bone from its place on the bone above


def write_bvh(path: Path, skeleton: Skeleton, pose: Any, frame_rate: float) -> None:
    """Metres, z up, world axes in rest: a bone's offset is from the head of the bone above. Only the root is moved.

    ValueError when a bone is moved off its place on the bone above, which this form cannot say.
    """
    turns, heads = np.asarray(pose.turns), np.asarray(pose.heads)          # (K, F, 3, 3), (K, F, 3)
    keyed, bones, pelvis = list(pose.keyed), skeleton.bones, skeleton.segments["pelvis"]
    shown = [bone for bone in bones.family({pelvis}) if bone in keyed]     # what is above the pelvis does not move
    row = {bone: keyed.index(bone) for bone in shown}
    joints = []
    for bone in shown:
        above = None if bone == pelvis else bones.parents[bone]
        offset = np.zeros(3) if above is None else bones.heads[bone] - bones.heads[above]
        if above is not None:
            carried = np.swapaxes(turns[row[above]], 1, 2) @ (heads[row[bone]] - heads[row[above]])[..., None]
            if (off := float(np.abs(carried[..., 0] - offset).max())) > MOST_OFF_M:
                raise ValueError(f"Bone '{bones.names[bone]}' moves {1000 * off:.1f} mm on the bone above it, which BVH "
                                 f"cannot say; the limit is {1000 * MOST_OFF_M:g} mm")
        joints.append(BvhJoint(bones.names[bone].replace(" ", "_"), None if above is None else shown.index(above),
                               offset, bones.tails[bone] - bones.heads[bone], turns[row[bone]]))
    path.write_text(bvh_document(joints, heads[row[pelvis]], frame_rate), encoding="utf-8")
