# SPDX-License-Identifier: GPL-3.0-or-later
"""What the evaluated scene shows over the frames of a lift, for reports and tests. It reads; the frame is put back."""
from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass

import bpy
import numpy as np

from ..rigs.joints import INDEX, JOINTS, SIDES
from ..rigs.rotations import Array, dot, normalise, reject, to_quaternion, transpose, turn, twist_angle
from ..rigs.skeleton import Skeleton
from .read_task import BoxShape
from .transforms import layer_of

#: Joint centre -> the segment whose bone carries it as a fixed point.
CARRIERS: dict[str, str] = {
    "l5s1": "spine", "c7t1": "neck", "suprasternale": "chest", "tragion": "neck", "nasion": "head",
    **{f"{word}_{joint}": f"{segment}.{side}" for side, word in SIDES for joint, segment in (
        ("ball", "foot"), ("ankle", "foot"), ("knee", "shin"), ("hip", "thigh"), ("clavicle", "clavicle"),
        ("shoulder", "upper_arm"), ("elbow", "forearm"), ("wrist", "hand"), ("hand_front", "hand"),
        ("hand_back", "hand"), ("grip", "hand"))},
}
#: A limb straighter than this has no side to which it bends.
LEAST_BEND_DEG = 3.0
#: Middle of an elbow's swivel, outwards from a relaxed one: the median of the recorded lifts, whose range is -10 to 81.
#: Half a turn about it is natural, so an elbow that is mirrored through its arm's line never is.
NATURAL_SWIVEL_DEG = 30.0
#: Sine of the angle between an arm and the line of the shoulders below which a relaxed elbow has no direction.
LEAST_ASIDE = 0.1


@dataclass(frozen=True)
class Samples:
    """A rig, and a box if there is one, in the evaluated scene: one row a frame, world metres."""

    frames: tuple[int, ...]
    joints: Array               #: (F, 27, 3)
    turns: dict[int, Array]     #: keyed bone -> (F, 3, 3), from rest
    stretch: Array              #: (F, K): length of every keyed bone as a part of its rest length, minus one
    box_origins: Array | None   #: (F, 3)
    box_axes: Array | None      #: (F, 3, 3), columns of unit length


@dataclass(frozen=True)
class LiftMeasures:
    """Worst values over the frames. Metres, degrees, radians per second."""

    landing_m: float            #: box to shelf at release
    grasp_m: float              #: middle of the grips to middle of the handles, worse of grasp and release
    held_m: float               #: either grip to its handle, grasp to release
    left_foot_m: float          #: left ball or ankle from where it stood in the first frame; see `foot_slip`
    stretch: float              #: relative change of any bone's length or scale
    least_elbow_deg: float      #: signed flexion; below zero is backwards: see `elbow_flexion`
    least_knee_deg: float
    forearm_twist_deg: float    #: of the forearm on the upper arm and the hand on the forearm, about the forearm
    fastest_rad_s: float        #: any joint

    def as_dict(self) -> dict[str, float]:
        return asdict(self)


@contextmanager
def _kept_frame(scene: bpy.types.Scene) -> Iterator[None]:
    frame, subframe = scene.frame_current, scene.frame_subframe
    try:
        yield
    finally:
        scene.frame_set(frame, subframe=subframe)


def sample(rig: bpy.types.Object, skeleton: Skeleton, frames: Sequence[int], box: bpy.types.Object | None = None,
           scene: bpy.types.Scene | None = None) -> Samples:
    """Steps through `frames` and reads every keyed bone (and the box) as the scene's view layer evaluates them."""
    scene = scene or bpy.context.scene
    layer = layer_of(scene)
    names = [skeleton.bones.names[bone] for bone in skeleton.keyed]
    matrices, boxes = np.empty((len(frames), len(names), 4, 4)), np.empty((len(frames), 4, 4))
    with _kept_frame(scene):
        for row, frame in enumerate(frames):
            scene.frame_set(frame)
            shown = _evaluated(rig, layer)
            world = shown.matrix_world
            for column, name in enumerate(names):
                if name not in skeleton.bones.implied:
                    matrices[row, column] = world @ shown.pose.bones[name].matrix
            if box is not None:
                boxes[row] = _evaluated(box, layer).matrix_world
    _carry_implied(skeleton, matrices)
    return _samples(skeleton, tuple(frames), matrices, None if box is None else boxes)


def _carry_implied(skeleton: Skeleton, matrices: Array) -> None:
    """Bones that the armature lacks go along with what they hang on."""
    bones, columns = skeleton.bones, {bone: column for column, bone in enumerate(skeleton.keyed)}
    for bone, column in columns.items():
        if bones.names[bone] in bones.implied:
            above = bones.parents[bone]
            local = bones.rotations[above].T
            matrices[:, column] = matrices[:, columns[above]] @ np.block([
                [local @ bones.rotations[bone], local @ (bones.heads[bone] - bones.heads[above])[:, None] / bones.scale],
                [np.zeros((1, 3)), np.ones((1, 1))]])


def _evaluated(item: bpy.types.Object, layer: bpy.types.ViewLayer) -> bpy.types.Object:
    shown = item.evaluated_get(layer.depsgraph)
    if not shown.is_evaluated:
        raise ValueError(f"Object '{item.name}' is hidden or not in the view layer '{layer.name}', so nothing of it is "
                         f"evaluated; show it")
    return shown


def _samples(skeleton: Skeleton, frames: tuple[int, ...], matrices: Array, boxes: Array | None) -> Samples:
    bones = skeleton.bones
    column_of = {bone: column for column, bone in enumerate(skeleton.keyed)}
    lengths = np.linalg.norm(matrices[:, :, :3, :3], axis=2)   # (F, K, 3): a bone's length and its thickness
    axes = matrices[:, :, :3, :3] / lengths[:, :, None, :]
    joints = []
    for joint in JOINTS:
        bone = skeleton.segments[CARRIERS[joint]]
        local = bones.rotations[bone].T @ (skeleton.joint(joint) - bones.heads[bone]) / bones.scale
        placed = matrices[:, column_of[bone]]
        joints.append(placed[:, :3, 3] + turn(placed[:, :3, :3], local))
    turns = {bone: axes[:, column] @ bones.rotations[bone].T for bone, column in column_of.items()}
    return Samples(frames, np.stack(joints, axis=1), turns, (lengths / bones.scale - 1.0).reshape(len(frames), -1),
                   None if boxes is None else boxes[:, :3, 3],
                   None if boxes is None else boxes[:, :3, :3] / np.linalg.norm(boxes[:, :3, :3], axis=1)[:, None])


def measure_lift(samples: Samples, skeleton: Skeleton, events: dict[str, int], frame_rate: float,
                 shape: BoxShape | None = None, shelf: Array | None = None) -> LiftMeasures:
    """The worst of everything over `samples`. events: scene frames of grasp and release; shelf: (3,) world.

    Without a sampled box the three box measures are NaN.
    """
    landing, grasp, held = _box_errors(samples, events, shape, shelf)
    twists = [angle for side, _ in SIDES for angle in forearm_twists(samples, skeleton, side)]
    return LiftMeasures(
        landing, grasp, held, foot_slip(samples, "left"), float(np.abs(samples.stretch).max()),
        min(float(elbow_flexion(samples, side).min()) for side, _ in SIDES),
        min(float(knee_flexion(samples, skeleton, side).min()) for side, _ in SIDES),
        float(np.degrees(np.max(np.abs(twists)))), fastest_joint(samples, skeleton, frame_rate))


def foot_slip(samples: Samples, word: str) -> float:
    """Farthest that the ball or the ankle of the "left" or "right" foot gets from its first place, metres."""
    feet = samples.joints[:, [INDEX[f"{word}_ball"], INDEX[f"{word}_ankle"]]]
    return float(np.linalg.norm(feet - feet[0], axis=2).max())


def elbow_flexion(samples: Samples, side: str) -> Array:
    """(F,) degrees: positive when the elbow lies on the natural side of the line from shoulder to wrist.

    From joint centres alone, no bone's own hinge. A relaxed elbow lies below an arm that points ahead, behind one that
    hangs, ahead of one that is raised: across the arm and the line of the shoulders. It swivels outwards from there.
    Zero if nearly straight, or if the arm points along the shoulders.
    """
    word = dict(SIDES)[side]
    shoulder, wrist, left, right = (samples.joints[:, INDEX[name]] for name in (
        f"{word}_shoulder", f"{word}_wrist", "left_shoulder", "right_shoulder"))
    arm, across = normalise(wrist - shoulder), normalise(right - left)
    relaxed, outwards = np.cross(arm, across), reject(across if side == "R" else -across, arm)
    middle = np.radians(NATURAL_SWIVEL_DEG)
    natural = np.cos(middle) * relaxed + np.sin(middle) * outwards
    natural[np.linalg.norm(relaxed, axis=1) < LEAST_ASIDE] = 0.0
    return _flexion(samples, word, ("shoulder", "elbow", "wrist"), np.cross(natural, arm))


def knee_flexion(samples: Samples, skeleton: Skeleton, side: str) -> Array:
    """(F,) degrees: positive when the knee points to where the toes point. Zero if nearly straight."""
    word = dict(SIDES)[side]
    foot = samples.joints[:, INDEX[f"{word}_ball"]] - samples.joints[:, INDEX[f"{word}_ankle"]]
    return _flexion(samples, word, ("hip", "knee", "ankle"), normalise(np.cross(skeleton.axes[2], foot)))


def _flexion(samples: Samples, word: str, names: tuple[str, str, str], hinge: Array) -> Array:
    first, middle, last = (samples.joints[:, INDEX[f"{word}_{name}"]] for name in names)
    upper, lower = normalise(middle - first), normalise(last - middle)
    bend = np.cross(upper, lower)
    angle = np.degrees(np.arctan2(np.linalg.norm(bend, axis=1), dot(upper, lower)))
    return np.where(angle < LEAST_BEND_DEG, 0.0, angle * np.sign(dot(bend, hinge)))


def fastest_joint(samples: Samples, skeleton: Skeleton, frame_rate: float) -> float:
    """The fastest turn of any keyed bone against its parent, radians per second, from one frame to the next."""
    fastest = 0.0
    for bone, turns in samples.turns.items():
        parent = skeleton.bones.parents[bone]
        local = turns if parent < 0 else transpose(samples.turns[parent]) @ turns
        step = to_quaternion(local[1:] @ transpose(local[:-1]))
        angle = 2.0 * np.arctan2(np.linalg.norm(step[:, 1:], axis=1), step[:, 0])
        spacing = np.diff(samples.frames) / frame_rate
        fastest = max(fastest, float((angle / spacing).max(initial=0.0)))
    return fastest


def forearm_twists(samples: Samples, skeleton: Skeleton, side: str) -> tuple[Array, Array]:
    """(F,) radians each: forearm on upper arm, hand on forearm, about the forearm."""
    word = dict(SIDES)[side]
    along = normalise(samples.joints[:, INDEX[f"{word}_wrist"]] - samples.joints[:, INDEX[f"{word}_elbow"]])
    upper, forearm, hand = (samples.turns[skeleton.segments[f"{name}.{side}"]]
                            for name in ("upper_arm", "forearm", "hand"))
    return twist_angle(forearm @ transpose(upper), along), twist_angle(hand @ transpose(forearm), along)


def _box_errors(samples: Samples, events: dict[str, int], shape: BoxShape | None,
                shelf: Array | None) -> tuple[float, float, float]:
    if samples.box_origins is None or samples.box_axes is None or shape is None:
        return (float("nan"),) * 3
    grasp, release = samples.frames.index(events["grasp"]), samples.frames.index(events["release"])
    frames = samples.box_axes @ np.array(shape.turn).T
    base = samples.box_origins - turn(frames, np.array(shape.origin_offset))
    ends = [base + turn(frames, np.array([sign * 0.5 * shape.grip_distance, 0.0, shape.handle_height]))
            for sign in (-1.0, 1.0)]
    left, right = (samples.joints[:, INDEX[f"{word}_grip"]] for word in ("left", "right"))
    straight = [np.linalg.norm(left - ends[0], axis=1), np.linalg.norm(right - ends[1], axis=1)]
    crossed = [np.linalg.norm(left - ends[1], axis=1), np.linalg.norm(right - ends[0], axis=1)]
    pair = straight if straight[0][grasp] <= crossed[0][grasp] else crossed
    middle = np.linalg.norm(0.5 * (left + right) - 0.5 * (ends[0] + ends[1]), axis=1)
    put_down = base[release] + frames[release] @ np.array([*shape.middle, 0.0])
    landing = float("nan") if shelf is None else float(np.linalg.norm(put_down - shelf))
    return (landing, float(max(middle[grasp], middle[release])),
            float(max(values[grasp:release + 1].max() for values in pair)))
