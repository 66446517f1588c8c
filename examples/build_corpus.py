#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds a corpus from recorded lifts, and says of every recording what became of it.

    /usr/bin/python3 examples/build_corpus.py --mocap ../shared/mocap --out corpus.sqlite

Reads the folders omomo/ and lieblich_lifting/ of a mocap collection, cuts phases in which the feet stay where they are,
and adds each with its mirror image. Nobody was recorded on the way back from a shelf, so each is also added as it would
be played backwards: a transfer as a retrieve, a reach as a return (--forwards leaves that out). A recording that is
left out is listed with the reason. Adapt `omomo_phases` or `lieblich_phases` to your own recordings: each yields one
Candidate per phase.
"""

import argparse
import csv
import sys
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "addon" / "reachcast"))
try:
    import numpy as np
    import reachcast_core as rc
except ImportError as missing:
    sys.exit(
        f"{missing}. Run this with the Python that Blender runs, after building reachcast_core for it; this is "
        f"{sys.executable}, try /usr/bin/python3."
    )

STILL = 0.10  # of the peak hand speed: below it a phase has not begun, or is over
FASTEST_END = 0.75  # of the peak hand speed: a phase that a step cuts off faster than this is no phase
NEARLY_UP = 0.9  # of the rise: a pause below it does not end a lift
STEP_M = 0.08  # a foot that has moved this far has stepped
DRIFT_M = 0.15  # the same for ankles found from video, which waver
LEAST_RISE_M = 0.25
LEAST_SECONDS = 0.4
UNEVEN_M = 0.15  # one hand this much higher than the other: not a lift with both hands alike
PARTED_M = 0.16  # hands (from video, so they waver) that part this much do not hold one box between them
SLIP_M = 0.08  # a hand whose distance from the object's centre varies this much does not hold it
RISE_BEGINS_M = 0.01  # an object this much higher than it stood has been lifted off
UNSTABLE = 0.10  # of a segment's median length: a joint was lost
# Shank, thigh and trunk as parts of stature (Drillis & Contini 1966): for people whose stature was not written down.
SHANK_THIGH_TRUNK = 0.246 + 0.245 + 0.288


class Rejected(Exception):
    """Why a phase does not enter the corpus."""


@dataclass(frozen=True)
class Candidate:
    origin: str
    reach: object = None  # a Reach, or None when rejected
    reason: str = ""


def joint(clip, name):
    return clip.positions[:, clip.names.index(name)]


def hold_point(clip):
    return (joint(clip, "left_grip") + joint(clip, "right_grip")) / 2


def speeds(points, rate):
    return np.linalg.norm(np.gradient(points, axis=0), axis=1) * rate


def farthest_from(points, frame):
    """Distance of a point from where it is at a frame, at every frame."""
    return np.linalg.norm(points - points[frame], axis=1)


def stature_from_skeleton(clips):
    """Metres: median shank, thigh (both sides) and trunk over all frames, by published proportions."""
    lengths = []
    for clip in clips:
        point = {name: joint(clip, name) for name in clip.names}
        legs = sum(
            np.linalg.norm(point[f"{side}_{a}"] - point[f"{side}_{b}"], axis=1) / 2
            for side in ("left", "right")
            for a, b in (("ankle", "knee"), ("knee", "hip"))
        )
        hips = (point["left_hip"] + point["right_hip"]) / 2
        shoulders = (point["left_shoulder"] + point["right_shoulder"]) / 2
        lengths.append(legs + np.linalg.norm(shoulders - hips, axis=1))
    return float(np.nanmedian(np.concatenate(lengths))) / SHANK_THIGH_TRUNK


# ---------------------------------------------------------------- OMOMO: whole body with a tracked object, 30 Hz


def standing_frames(clip, frame):
    """(first, last) around a frame in which neither ball of the foot has moved STEP_M from its place at that frame."""
    moved = np.maximum(*(farthest_from(joint(clip, f"{side}_ball"), frame) for side in ("left", "right"))) > STEP_M
    before = np.flatnonzero(moved[:frame])
    after = np.flatnonzero(moved[frame:])
    first = int(before[-1]) + 1 if before.size else 0
    last = frame + int(after[0]) - 1 if after.size else len(clip) - 1
    return first, last


def frames_of_lift(clip, heights, moves, rests):
    """From lift-off to where the hands first hold the object up and rest, or to where the feet step."""
    risen = np.flatnonzero(heights[moves : rests + 1] > heights[moves] + RISE_BEGINS_M)
    if not risen.size:
        raise Rejected("the object does not rise")
    start = moves + int(risen[0])
    hands = hold_point(clip)[start : min(standing_frames(clip, start)[1], rests) + 1]
    hands = hands[: int(np.argmax(hands[:, 2])) + 1]
    end, open_speed = rest_after_rise(hands, clip.rate)
    return start, start + end, open_speed


def frames_of_lowering(clip, heights, moves, rests):
    """Backwards: from where the hands last hold the object up, or the feet have arrived, to where it is down."""
    above = np.flatnonzero(heights[moves : rests + 1] > heights[rests] + RISE_BEGINS_M)
    if not above.size:
        raise Rejected("the object does not come down")
    end = moves + int(above[-1])
    hands = hold_point(clip)[max(standing_frames(clip, end)[0], moves) : end + 1][::-1]
    hands = hands[: int(np.argmax(hands[:, 2])) + 1]
    length, open_speed = rest_after_rise(hands, clip.rate)
    return end - length, end, open_speed


def rest_after_rise(hands, rate):
    """First frame after the peak speed at which rising hands are nearly up and still, else the last; and its speed
    as a part of the peak speed."""
    if len(hands) < 2:
        raise Rejected("the hands do not rise with the feet still")
    speed = speeds(hands, rate)
    peak = int(np.argmax(speed))
    up = hands[:, 2] > hands[0, 2] + NEARLY_UP * (hands[-1, 2] - hands[0, 2])
    slow = np.flatnonzero(up[peak:] & (speed[peak:] < STILL * speed[peak]))
    end = peak + int(slow[0]) if slow.size else len(hands) - 1
    return end, speed[end] / speed[peak]


def check_rise(clip, start, end):
    rise = abs(float(np.diff(hold_point(clip)[[start, end], 2])[0]))
    if rise < LEAST_RISE_M:
        raise Rejected(f"the hands travel only {rise:.2f} m in height with the feet still")


def check_lift(clip, object_points, start, end, open_speed):
    """Raises Rejected when frames start to end are not a lift (or its reverse) with both hands and standing feet."""
    seconds = (end - start) / clip.rate
    if seconds < LEAST_SECONDS:
        raise Rejected(f"lasts only {seconds:.2f} s with the feet still")
    part = slice(start, end + 1)
    check_rise(clip, start, end)
    if open_speed > FASTEST_END:
        raise Rejected(f"a step cuts it off while the hands move at {open_speed:.0%} of their peak speed")
    grips = {side: joint(clip, f"{side}_grip")[part] for side in ("left", "right")}
    for side, grip in grips.items():
        slip = float(np.ptp(np.linalg.norm(grip - object_points[part], axis=1)))
        if slip > SLIP_M:
            raise Rejected(f"the {side} hand is not on the object: their distance varies by {slip:.2f} m")
    uneven = float(np.abs(grips["left"][:, 2] - grips["right"][:, 2]).max())
    if uneven > UNEVEN_M:
        raise Rejected(f"one hand is {uneven:.2f} m higher than the other")


def omomo_phases(folder):
    sexes = {"F": "female", "M": "male"}
    for row in read_rows(folder / "clips.csv"):
        name = row["clip"]
        if row["object_lifted_over_25cm"] != "yes":
            yield Candidate(f"omomo/{name}.csv", reason="the object is not lifted over 25 cm")
            continue
        recorded = rc.read_motion(str(folder / f"{name}.csv"))
        clip = rc.canonical(recorded, "omomo")
        object_points = joint(recorded, "obj")
        heights = object_points[:, 2]
        subject = rc.Subject(float(row["stature_est_from_skeleton_m"]), sex=sexes[row["sex"]])
        moves, rests = int(row["obj_move_first_frame"]), int(row["obj_move_last_frame"])
        for way, find_frames in (("up", frames_of_lift), ("down", frames_of_lowering)):
            origin = f"omomo/{name}.csv ({way})"
            try:
                start, end, open_speed = find_frames(clip, heights, moves, rests)
                origin = f"omomo/{name}.csv:{start}-{end}"
                check_lift(clip, object_points, start, end, open_speed)
                yield Candidate(origin, rc.cut_reach(clip, start, end, subject, "transfer", origin))
            except (Rejected, ValueError) as why:
                yield Candidate(origin, reason=str(why))


# ---------------------------------------------------------------- Lieblich: floor to waist, 12 joints, 60 Hz


def check_tracking(recorded, clip, start, end, flagged):
    """Raises Rejected when a flagged segment changes its length, or a foot moves, within the frames."""
    part = slice(start, end + 1)
    for pair in flagged:
        a, b = (joint(recorded, name) for name in pair.split("-"))
        lengths = np.linalg.norm(a - b, axis=1)
        worst = float(np.abs(lengths[part] / np.median(lengths) - 1).max())
        if worst > UNSTABLE:
            raise Rejected(f"{pair} is off its length by {worst:.0%}")
    for side in ("left", "right"):
        moved = float(farthest_from(joint(clip, f"{side}_ankle")[part], 0).max())
        if moved > DRIFT_M:
            raise Rejected(f"the {side} foot moves {moved:.2f} m")


def check_hold(clip, start, end):
    """Raises Rejected when the hands do not keep the distance they have at the start."""
    apart = np.linalg.norm(joint(clip, "left_grip") - joint(clip, "right_grip"), axis=1)[start : end + 1]
    parted = float(np.abs(apart - apart[0]).max())
    if parted > PARTED_M:
        raise Rejected(f"the distance between the hands changes by {parted:.2f} m: they hold no box")


def lieblich_phases(folder):
    rows = read_rows(folder / "dip_segments.csv")
    keys = [(row["subject"], row["dip"]) for row in rows]
    recordings = {(who, dip): rc.read_motion(str(folder / f"{who}_dip{dip}.csv")) for who, dip in keys}
    clips = {key: rc.canonical(recorded, "lieblich") for key, recorded in recordings.items()}
    statures = {
        subject: stature_from_skeleton([clip for (who, _), clip in clips.items() if who == subject])
        for subject in {row["subject"] for row in rows}
    }
    for row in rows:
        key = (row["subject"], row["dip"])
        name = f"{key[0]}_dip{key[1]}.csv"
        flagged = [pair for pair in row["segments_len_unstable"].split() if pair]
        for phase, begin, finish in (("reach", "frame_start", "frame_low"), ("transfer", "frame_low", "frame_end")):
            origin = f"lieblich/{name} ({phase})"
            try:
                if row["joints_far_off"]:
                    raise Rejected(f"flagged as far off: {row['joints_far_off']}")
                offset = int(clips[key].channels["frame"][0])
                first, last = (int(row[column]) - offset for column in (begin, finish))
                start, end = rc.trim_by_hand_speed(clips[key], first, last, STILL)
                origin = f"lieblich/{name}:{start}-{end}"
                check_rise(clips[key], start, end)
                if phase == "transfer":
                    check_hold(clips[key], start, end)
                check_tracking(recordings[key], clips[key], start, end, flagged)
                reach = rc.cut_reach(clips[key], start, end, rc.Subject(statures[key[0]]), phase, origin)
                yield Candidate(origin, reach)
            except (Rejected, ValueError) as why:
                yield Candidate(origin, reason=str(why))


# ---------------------------------------------------------------- the command


def read_rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def report(candidates):
    """Prints what became of each candidate; returns the reaches accepted."""
    accepted = [candidate.reach for candidate in candidates if candidate.reach is not None]
    for candidate in candidates:
        if candidate.reach is None:
            print(f"rejected  {candidate.origin}: {candidate.reason}")
            continue
        reach = candidate.reach
        heights = reach.hold_points[[0, -1], 2]
        print(
            f"accepted  {candidate.origin}: {reach.phase}, {reach.duration:.2f} s, "
            f"hands from {heights[0]:.2f} to {heights[1]:.2f} m, stature {reach.subject.stature:.2f} m"
        )
    phases = ", ".join(f"{count} {phase}" for phase, count in sorted(Counter(r.phase for r in accepted).items()))
    print(f"{len(accepted)} accepted ({phases or 'none'}), {len(candidates) - len(accepted)} rejected")
    return accepted


def main():
    parser = argparse.ArgumentParser(description="Build a corpus from recorded lifts.")
    parser.add_argument("--mocap", type=Path, required=True, help="folder with omomo/ and lieblich_lifting/")
    parser.add_argument("--out", type=Path, required=True, help="the corpus file to create")
    parser.add_argument("--dry-run", action="store_true", help="report only, write nothing")
    parser.add_argument("--forwards", action="store_true", help="add nothing that is played backwards")
    options = parser.parse_args()
    readers = {"omomo": omomo_phases, "lieblich_lifting": lieblich_phases}
    candidates = []
    for folder, phases in readers.items():
        if (options.mocap / folder).is_dir():
            candidates += phases(options.mocap / folder)
        else:
            print(f"skipped   {options.mocap / folder}: no such folder")
    accepted = report(candidates)
    if not accepted:
        sys.exit("No phase was accepted: no corpus is written.")
    if not options.dry_run:
        corpus = rc.Corpus.create(str(options.out))
        corpus.set_meta("kind", "recorded")
        corpus.add_reaches(accepted)
        if not options.forwards:
            corpus.add_reaches([reach.reversed() for reach in accepted])
        print(f"{options.out}: {len(corpus)} motions, mirror images and what is played backwards included")


if __name__ == "__main__":
    main()
