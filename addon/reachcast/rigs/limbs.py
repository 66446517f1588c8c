# SPDX-License-Identifier: GPL-3.0-or-later
"""Turns from rest of arms and legs: the direction of each link exactly, the roll about it from the hinge.

A turn D (F, 3, 3) carries rest directions to posed ones. Elbow and knee are hinges: both links share its axis, the
normal of their plane. Where a limb is nearly straight that normal is noise; it is carried there from bent frames.
"""
from __future__ import annotations

import numpy as np

from .rotations import Array, aim, axis_rotation, cross, dot, frame, normalise, reject, signed_angle, turn

FULL_BEND = 0.2          #: sine of the bend from which a limb's own plane alone decides (11.5 degrees)
MAX_HAND_TWIST = 2.6     #: radians of pronation from the forearm's neutral; half goes to the forearm, half to the hand
LEAST_REST_BEND_DEG = 8.0
LEVEL_FOOT = 0.4         #: cosine of the foot's slope from which the sole is level, whatever the shin does (66 degrees)
HANGING_FOOT = 0.25      #: cosine below which the foot turns with the shin (76 degrees)


def carried_normal(raw: Array, axis: Array, fallback: Array, full: float = FULL_BEND) -> Array:
    """Unit normals (F, 3) across unit `axis` (F, 3), continuous in time.

    `raw` (F, 3) is across the axis, its length the sine of the bend. From `full` on it decides alone. Below, it gives
    way to the normals of the nearest bent frames before and after, each carried by the smallest turn of the axis;
    if no frame is bent, to `fallback` (F, 3).
    """
    sine = np.linalg.norm(raw, axis=-1)
    safe_fallback = frame(axis, fallback)[..., 1]
    own = np.where(sine[:, None] > 1e-9, normalise(raw), safe_fallback)
    carried = _between_bent_frames(own, axis, sine >= full) if np.any(sine >= full) else safe_fallback
    weight = np.clip(sine / full, 0.0, 1.0)
    weight = weight * weight * (3.0 - 2.0 * weight)
    return _turned_towards(carried, own, axis, weight)


def _between_bent_frames(own: Array, axis: Array, bent: Array) -> Array:
    frames = np.arange(len(own))
    before = np.maximum.accumulate(np.where(bent, frames, -1))
    after = np.minimum.accumulate(np.where(bent, frames, len(own))[::-1])[::-1]
    before, after = np.where(before < 0, after, before), np.where(after == len(own), before, after)
    first = turn(aim(axis[before], axis), own[before])
    second = turn(aim(axis[after], axis), own[after])
    share = (frames - before) / np.maximum(after - before, 1)
    return _turned_towards(first, second, axis, share)


def _turned_towards(start: Array, end: Array, axis: Array, share: Array) -> Array:
    """`start` turned about the axis by `share` of the angle to `end`; both are across the axis."""
    angle = signed_angle(start, end, axis)
    return normalise(reject(turn(axis_rotation(axis, share * angle), start), axis))


def hinge_turns(rest: Array, posed: Array, rest_normal: Array, fallback_turn: Array) -> tuple[Array, Array, Array]:
    """Turns of the upper and lower link of a hinged limb, and the hinge's posed normal (F, 3).

    rest (3, 3): the limb's three joints at rest; posed (F, 3, 3): over time; rest_normal (3,);
    fallback_turn (F, 3, 3): the turn of the bone above, which a limb that never bends follows.
    """
    rest_upper, rest_lower = normalise(rest[1] - rest[0]), normalise(rest[2] - rest[1])
    upper, lower = normalise(posed[:, 1] - posed[:, 0]), normalise(posed[:, 2] - posed[:, 1])
    followed = turn(fallback_turn, rest_upper)
    fallback = turn(aim(followed, upper), turn(fallback_turn, rest_normal))
    normal = carried_normal(cross(upper, lower), upper, fallback)
    upper_turn = frame(upper, normal) @ frame(rest_upper, rest_normal).T
    # the lower link's normal: the hinge's own, brought across it where the limb is too straight to be its plane
    lower_turn = frame(lower, normal) @ frame(rest_lower, rest_normal).T
    return upper_turn, lower_turn, normal


def hand_turns(rest_hand: Array, rest_palm: Array, hand: Array, towards: Array, forearm: Array,
               forearm_turn: Array) -> tuple[Array, Array]:
    """Turns of the forearm and the hand when the palm faces along `towards` (F, 3), sharing the pronation equally.

    rest_hand, rest_palm (3,): unit; hand, forearm (F, 3): unit posed directions; forearm_turn (F, 3, 3): without
    pronation. The twist is how far the palm turns about the hand from where the forearm alone would bring it. The
    hand's direction is exact; its palm gives way where the twist would be more than a forearm can do.
    """
    followed = turn(forearm_turn, rest_hand)
    neutral = turn(aim(followed, hand), turn(forearm_turn, rest_palm))
    palm = carried_normal(reject(normalise(towards), hand), hand, neutral)
    twist = np.unwrap(signed_angle(neutral, palm, hand))
    twist -= 2.0 * np.pi * np.round(np.mean(twist) / (2.0 * np.pi))
    twist = np.clip(twist, -MAX_HAND_TWIST, MAX_HAND_TWIST)
    hand_turn = axis_rotation(hand, twist) @ aim(followed, hand) @ forearm_turn
    return axis_rotation(forearm, 0.5 * twist) @ forearm_turn, hand_turn


def foot_turns(rest_foot: Array, foot: Array, axes: Array, shin_turn: Array) -> tuple[Array, Array]:
    """Turns of the foot and the toe: the foot along ankle -> ball, its sole level; the toe keeps its rest slope.

    A foot that points straight down has no level side; it takes that of the shin.

    rest_foot (3,), foot (F, 3): unit; axes (3, 3): rows of the body frame; shin_turn (F, 3, 3).
    """
    up = axes[2]
    level = cross(rest_foot, up)
    rest_side = normalise(level) if np.linalg.norm(level) > FULL_BEND else axes[0]
    followed = turn(shin_turn, rest_foot)
    carried = turn(aim(followed, foot), turn(shin_turn, rest_side))
    side = _foot_side(cross(foot, up), carried, foot)
    foot_turn = frame(foot, side) @ frame(rest_foot, rest_side).T
    heading = normalise(side - dot(side, up)[:, None] * up)
    toe_turn = frame(np.broadcast_to(up, heading.shape), heading) @ frame(up, rest_side).T
    return foot_turn, toe_turn


def _foot_side(level: Array, carried: Array, foot: Array) -> Array:
    """Unit sideways axes (F, 3) of a foot: `level` while the sole can be level, `carried` by the shin while it cannot.

    A foot that swings past straight down comes out with its level axis reversed. So each run of level frames has a
    sign: the first, in which the person stands, is right; later ones agree with the shin.
    """
    slope = np.linalg.norm(level, axis=1)
    flat = slope >= LEVEL_FOOT
    if not np.any(flat):
        return carried
    starts = flat & ~np.concatenate([[False], flat[:-1]])
    run_of = np.cumsum(starts) - 1
    agreement = np.array([np.sum(dot(level, carried)[flat & (run_of == run)]) for run in range(run_of[-1] + 1)])
    signs = np.where(agreement < 0.0, -1.0, 1.0)
    signs[0] = 1.0
    level_frames = np.flatnonzero(flat)
    after = np.searchsorted(level_frames, np.arange(len(flat))).clip(0, len(level_frames) - 1)
    before = (after - 1).clip(0)
    frames = np.arange(len(flat))
    nearer = np.where(np.abs(level_frames[after] - frames) <= np.abs(frames - level_frames[before]), after, before)
    own = normalise(level) * signs[run_of[level_frames[nearer]]][:, None]
    share = np.clip((slope - HANGING_FOOT) / (LEVEL_FOOT - HANGING_FOOT), 0.0, 1.0)
    share = share * share * (3.0 - 2.0 * share)
    return _turned_towards(carried, np.where(share[:, None] > 0.0, own, carried), foot, share)
