# SPDX-License-Identifier: GPL-3.0-or-later
"""Joint centres over time -> how far each bone of a rig has turned from rest, and where its pelvis is.

The joints come from a body with this rig's own measures, so pelvis (l5s1 and both hips) and chest (l5s1, c7t1 and the
clavicle roots) are rigid and every link has its length: then the posed bones pass through the joints exactly.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .joints import INDEX, JOINTS, SIDES
from .limbs import LEAST_REST_BEND_DEG, foot_turns, hand_turns, hinge_turns
from .rotations import Array, aim, cross, frame, normalise, transpose, turn
from .skeleton import Skeleton, rest_bend, rest_hinge, rest_palm

Turns = dict[str, Array]

#: Joint centre -> the segment whose bone carries it as a fixed point.
CARRIERS: dict[str, str] = {
    "l5s1": "spine", "c7t1": "neck", "suprasternale": "chest", "tragion": "neck", "nasion": "head",
    **{f"{word}_{joint}": f"{segment}.{side}" for side, word in SIDES for joint, segment in (
        ("ball", "foot"), ("ankle", "foot"), ("knee", "shin"), ("hip", "thigh"), ("clavicle", "clavicle"),
        ("shoulder", "upper_arm"), ("elbow", "forearm"), ("wrist", "hand"), ("hand_front", "hand"),
        ("hand_back", "hand"), ("grip", "hand"))},
}

#: The joints that a posed rig passes through exactly. Of the nasion only the direction is kept, for the head bone does
#: not turn about the tragion; the front and back of the hands give way to the palms, which are turned to face each
#: other.
EXACT_JOINTS = tuple(index for index, name in enumerate(JOINTS)
                     if name != "nasion" and not name.endswith(("hand_front", "hand_back")))


@dataclass(frozen=True)
class RigPose:
    """A rig over time. A turn carries a bone's rest orientation to its posed one, in the world."""

    turns: dict[int, Array]   #: keyed bone -> (F, 3, 3)
    heads: dict[int, Array]   #: keyed bone -> (F, 3) world: where its head is
    pelvis: int               #: the one bone that also moves


def retarget(skeleton: Skeleton, joints: Array) -> RigPose:
    """The pose of every keyed bone for joint centres (F, 27, 3) in the world."""
    joints = np.asarray(joints, float)
    if joints.ndim != 3 or joints.shape[1:] != (len(JOINTS), 3) or not len(joints):
        raise ValueError(f"joints has shape {joints.shape}; it must be (frames, {len(JOINTS)}, 3)")
    if not np.all(np.isfinite(joints)):
        raise ValueError(f"joints is not finite at frame {int(np.argwhere(~np.isfinite(joints))[0][0])}")

    def posed(name: str) -> Array:
        return joints[:, INDEX[name]]

    turns = _trunk(skeleton, posed)
    for side, word in SIDES:
        turns.update(_arm(skeleton, posed, side, word, turns["spine"]))
        turns.update(_leg(skeleton, posed, side, word, turns["pelvis"]))
    turns.update(_neck_and_head(skeleton, posed, turns["spine"]))
    return _spread(skeleton, turns, posed("left_hip"))


def _trunk(skeleton: Skeleton, posed: Callable[[str], Array]) -> Turns:
    rest = skeleton.joint

    def triangle(of: Callable[[str], Array], base: str, primary: str, secondary: str) -> Array:
        return frame(of(primary) - of(base), of(secondary) - of(base))

    pelvis = triangle(posed, "left_hip", "right_hip", "l5s1") @ triangle(rest, "left_hip", "right_hip", "l5s1").T
    chest = triangle(posed, "l5s1", "c7t1", "right_clavicle") @ triangle(rest, "l5s1", "c7t1", "right_clavicle").T
    return {"pelvis": pelvis, "spine": chest, "chest": chest}


def _arm(skeleton: Skeleton, posed: Callable[[str], Array], side: str, word: str, chest: Array) -> Turns:
    rest = skeleton.joint
    shoulder, elbow, wrist, grip = (f"{word}_{name}" for name in ("shoulder", "elbow", "wrist", "grip"))
    root = f"{word}_clavicle"
    carried = turn(chest, normalise(rest(shoulder) - rest(root)))
    clavicle = aim(carried, normalise(posed(shoulder) - posed(root))) @ chest
    straight = rest_hinge(normalise(rest(elbow) - rest(shoulder)), skeleton.axes)
    hinge = rest_bend(skeleton.joints, side, ("shoulder", "elbow", "wrist"), straight, LEAST_REST_BEND_DEG)
    upper, forearm, _ = hinge_turns(np.stack([rest(shoulder), rest(elbow), rest(wrist)]),
                                    np.stack([posed(shoulder), posed(elbow), posed(wrist)], axis=1), hinge, clavicle)
    other = "left_grip" if side == "R" else "right_grip"
    forearm, hand = hand_turns(
        normalise(rest(grip) - rest(wrist)), rest_palm(skeleton.joints, skeleton.axes, side),
        normalise(posed(grip) - posed(wrist)), posed(other) - posed(grip),
        normalise(posed(wrist) - posed(elbow)), forearm)
    return {f"clavicle.{side}": clavicle, f"upper_arm.{side}": upper, f"forearm.{side}": forearm,
            f"hand.{side}": hand}


def _leg(skeleton: Skeleton, posed: Callable[[str], Array], side: str, word: str, pelvis: Array) -> Turns:
    rest = skeleton.joint
    hip, knee, ankle, ball = (f"{word}_{name}" for name in ("hip", "knee", "ankle", "ball"))
    straight = cross(normalise(rest(knee) - rest(hip)), -skeleton.axes[1])
    hinge = rest_bend(skeleton.joints, side, ("hip", "knee", "ankle"), straight, LEAST_REST_BEND_DEG)
    thigh, shin, _ = hinge_turns(np.stack([rest(hip), rest(knee), rest(ankle)]),
                                 np.stack([posed(hip), posed(knee), posed(ankle)], axis=1), hinge, pelvis)
    foot, toe = foot_turns(normalise(rest(ball) - rest(ankle)), normalise(posed(ball) - posed(ankle)),
                           skeleton.axes, shin)
    return {f"thigh.{side}": thigh, f"shin.{side}": shin, f"foot.{side}": foot, f"toe.{side}": toe}


def _neck_and_head(skeleton: Skeleton, posed: Callable[[str], Array], chest: Array) -> Turns:
    rest, right = skeleton.joint, skeleton.axes[0]
    neck = frame(posed("tragion") - posed("c7t1"), turn(chest, right)) \
        @ frame(rest("tragion") - rest("c7t1"), right).T
    carried = turn(neck, normalise(rest("nasion") - rest("tragion")))
    head = aim(carried, normalise(posed("nasion") - posed("tragion"))) @ neck
    return {"neck": neck, "head": head}


def _spread(skeleton: Skeleton, turns: Turns, left_hip: Array) -> RigPose:
    """From segments to keyed bones: unmapped bones follow their parent, those above the pelvis stay at rest."""
    bones = skeleton.bones
    segment_of = {bone: segment for segment, bone in skeleton.segments.items()}
    pelvis = skeleton.segments["pelvis"]
    still = np.broadcast_to(np.eye(3), turns["pelvis"].shape)
    bone_turns: dict[int, Array] = {}
    heads: dict[int, Array] = {}
    for bone in skeleton.keyed:
        parent = bones.parents[bone]
        above = bone_turns[parent] if parent >= 0 else still
        bone_turns[bone] = turns[segment_of[bone]] if bone in segment_of else above
        if bone == pelvis:
            heads[bone] = left_hip + turn(turns["pelvis"], bones.heads[bone] - skeleton.joint("left_hip"))
        elif parent < 0:
            heads[bone] = np.broadcast_to(bones.heads[bone], left_hip.shape)
        else:
            heads[bone] = heads[parent] + turn(above, bones.heads[bone] - bones.heads[parent])
    return RigPose(bone_turns, heads, pelvis)


def local_rotations(skeleton: Skeleton, pose: RigPose) -> dict[int, Array]:
    """Each keyed bone's rotation (F, 3, 3) in its own rest frame: what Blender calls its basis."""
    local = {}
    for bone, bone_turn in pose.turns.items():
        rest, parent = skeleton.bones.rotations[bone], skeleton.bones.parents[bone]
        relative = bone_turn if parent < 0 else transpose(pose.turns[parent]) @ bone_turn
        local[bone] = rest.T @ relative @ rest
    return local


def posed_joints(skeleton: Skeleton, pose: RigPose) -> Array:
    """(F, 27, 3) world: the joint centres that the posed bones carry; the inverse of `retarget`."""
    columns = []
    for joint in JOINTS:
        bone = skeleton.segments[CARRIERS[joint]]
        offset = skeleton.joint(joint) - skeleton.bones.heads[bone]
        columns.append(pose.heads[bone] + turn(pose.turns[bone], offset))
    return np.stack(columns, axis=1)
