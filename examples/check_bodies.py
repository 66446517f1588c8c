#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Averaging never breaks a body: random sets of neighbours, bodies and tasks, each predicted and measured.

    /usr/bin/python3 examples/check_bodies.py [--cases 100000] [--corpus FILE ...] [--jobs 2]

A set of neighbours is 1 to 40 motions picked anyhow from a corpus, mirror images included; scheme and k are random too.
A body has a random stature and sex, and segments up to 7 % longer or shorter than published proportions have them; a
task has random ends, turns, box and load. Measured are all rigid links, the grips on the box, the feet where they stand,
the box where it was asked for, and the bend of elbows and knees. Exit status 1 when a limit is broken.
"""
from __future__ import annotations

import argparse
import os
import re
import sys
import tempfile
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, os.fspath(ROOT / "addon" / "reachcast"))
sys.dont_write_bytecode = True

import numpy as np  # noqa: E402
import reachcast_core as rc  # noqa: E402

SHIPPED = ROOT / "addon" / "reachcast" / "data" / "simulated.sqlite"
SEED = 2004
PER_SET = 50            #: tasks with one set of neighbours
EXACT_M = 1e-6
#: Published bounds that the linkage holds (AAOS 1965), radians of flexion: native/src/posture/linkage.cpp.
BENDS = {"elbow": (0.12, 2.45), "knee": (0.07, 2.35)}
SLACK_RAD = 1e-6
AT = {name: number for number, name in enumerate(rc.JOINTS)}
SIDES = ("left", "right")
#: Pairs of joints whose distance is the body's own.
LINKS = [("l5s1", "c7t1"), ("c7t1", "tragion"), ("tragion", "nasion"), ("left_hip", "right_hip"),
         ("left_clavicle", "right_clavicle")] + [
    (a if a in AT else f"{side}_{a}", f"{side}_{b}") for side in SIDES for a, b in (
        ("ball", "ankle"), ("ankle", "knee"), ("knee", "hip"), ("l5s1", "hip"), ("l5s1", "clavicle"), ("c7t1", "clavicle"),
        ("clavicle", "shoulder"), ("shoulder", "elbow"), ("elbow", "wrist"), ("wrist", "grip"))]
ENDS = {"elbow": (0.12, 2.45), "knee": (0.07, 2.35)}
SLACK_RAD = 1e-6
AT = {name: number for number, name in enumerate(rc.JOINTS)}
SIDES = ("left", "right")
#: Pairs of joints whose distance is the body's own.
LINKS = [("l5s1", "c7t1"), ("l5s1", "suprasternale"), ("c7t1", "suprasternale"), ("c7t1", "tragion"),
         ("tragion", "nasion"), ("left_hip", "right_hip"), ("left_clavicle", "right_clavicle")] + [
    (f"{side}_{a}" if a not in AT else a, f"{side}_{b}") for side in SIDES for a, b in (
        ("ball", "ankle"), ("ankle", "knee"), ("knee", "hip"), ("hip", "l5s1")[::-1], ("l5s1", "clavicle"),
        ("clavicle", "shoulder"), ("shoulder", "elbow"), ("elbow", "wrist"), ("wrist", "grip"))]
ENDS = np.array([[AT[a], AT[b]] for a, b in LINKS])
SEGMENTS = ("shank", "thigh", "trunk", "upper_arm", "forearm")
REFUSALS = re.compile(r"(out of reach from the (?:left|right) (?:shoulder|hip))$|(the corpus holds only mirror images)")


def random_set(pick: np.random.Generator, corpora: list[rc.Corpus], folder: Path) -> rc.Corpus:
    """A corpus of a few transfers."""
    source = corpora[pick.integers(len(corpora))]
    ids = [motion.id for motion in source.motions() if motion.phase == "transfer"]
    chosen = pick.choice(ids, size=pick.integers(1, min(40, len(ids)) + 1), replace=False)
    path = folder / "set.sqlite"
    path.unlink(missing_ok=True)
    rc.Corpus.create(path).add(source.load([int(key) for key in chosen]))
    return rc.Corpus.open(path)


def random_scheme(pick: np.random.Generator) -> dict[str, object]:
    scheme: dict[str, object] = {"k": int(pick.integers(1, 41)), "sets": int(pick.integers(1, 3)),
                                 "mirrored": bool(pick.integers(2)), "paths": str(pick.choice(["deviation", "bezier"])),
                                 "postures": str(pick.choice(["coordinates", "poses"]))}
    kind = pick.integers(3)
    if kind == 0:
        scheme["weights"] = str(pick.choice(["uniform", "triangular"]))
    else:
        scheme |= {"distances": ["task", "stature"], "smoother": ("kernel", "linear")[kind - 1]}
    return scheme


def random_body(pick: np.random.Generator) -> tuple[rc.Subject, rc.Body]:
    stature, sex = pick.uniform(1.45, 2.0), str(pick.choice(["female", "male"]))
    lengths = dict(rc.Body.from_stature(stature, sex=sex).lengths)
    for name in SEGMENTS:
        lengths[name] *= pick.uniform(0.93, 1.07)
    return rc.Subject(stature, sex=sex), rc.Body(lengths, stature)


def random_task(pick: np.random.Generator) -> rc.Task:
    width = pick.uniform(0.2, 0.5)
    box = rc.Box(width, pick.uniform(0.2, 0.4), pick.uniform(0.1, 0.4), pick.uniform(0.0, 0.1),
                 mass=pick.uniform(0.0, 20.0), grip_distance=width)
    home = [pick.uniform(-0.25, 0.25), pick.uniform(0.3, 0.5), pick.uniform(0.0, 0.9)]
    target = [pick.uniform(-0.45, 0.45), pick.uniform(0.25, 0.5), pick.uniform(0.1, 1.7)]
    return rc.Task(home, target, box, home_yaw=pick.uniform(-0.5, 0.5), target_yaw=pick.uniform(-0.8, 0.8))


def bends(positions: np.ndarray, ends: tuple[str, str, str]) -> np.ndarray:
    """Flexion in radians, both sides: 0 is straight."""
    found = []
    for side in SIDES:
        a, b, c = (positions[:, AT[f"{side}_{name}"]] for name in ends)
        upper, lower = b - a, c - b
        crossed = np.linalg.norm(np.cross(upper, lower), axis=1)
        found.append(np.arctan2(crossed, np.sum(upper * lower, axis=1)))
    return np.concatenate(found)


def measure(motion: rc.Motion, task: rc.Task, body: rc.Body) -> dict[str, float]:
    """Worst of each over the motion: metres, and radians beyond the bounds."""
    positions, posture = np.asarray(motion.positions), np.asarray(body.posture)
    own = np.linalg.norm(posture[ENDS[:, 0]] - posture[ENDS[:, 1]], axis=1)
    links = np.linalg.norm(positions[:, ENDS[:, 0]] - positions[:, ENDS[:, 1]], axis=2)
    feet = [AT[f"{side}_{joint}"] for side in SIDES for joint in ("ball", "ankle")]
    boxes = np.asarray(motion.box_positions)
    w, x, y, z = np.asarray(motion.box_quaternions).T
    across = np.stack([1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)], axis=1)
    held = slice(motion.events["grasp"], motion.events["release"] + 1)
    grips = 0.0
    for side, sign in (("left", -0.5), ("right", 0.5)):
        handle = boxes + sign * task.object.grip_distance * across + [0.0, 0.0, task.object.handle_height]
        grips = max(grips, float(np.linalg.norm(positions[held, AT[f"{side}_grip"]] - handle[held], axis=1).max()))
    elbow, knee = bends(positions, ("shoulder", "elbow", "wrist")), bends(positions, ("hip", "knee", "ankle"))
    return {
        "links": float(np.abs(links - own).max()),
        "grips": grips,
        "feet": float(np.linalg.norm(positions[:, feet] - posture[feet], axis=2).max()),
        "box at its target": float(np.linalg.norm(boxes[motion.events["release"]] - np.asarray(task.target))),
        "elbows beyond": float(max(BENDS["elbow"][0] - elbow.min(), elbow.max() - BENDS["elbow"][1])),
        "knees beyond": float(max(BENDS["knee"][0] - knee.min(), knee.max() - BENDS["knee"][1])),
    }


def check(job: tuple[int, int, list[str]]) -> tuple[int, Counter[str], dict[str, float]]:
    """(predicted, refusals by their words, worst of each) of so many cases from a seed."""
    seed, cases, paths = job
    pick, corpora = np.random.default_rng([SEED, seed]), [rc.Corpus.open(path) for path in paths]
    worst: dict[str, float] = {}
    refused: Counter[str] = Counter()
    done = 0
    with tempfile.TemporaryDirectory(prefix="reachcast-") as folder:
        for case in range(cases):
            if case % PER_SET == 0:
                neighbours, scheme = random_set(pick, corpora, Path(folder)), random_scheme(pick)
            (subject, body), task = random_body(pick), random_task(pick)
            try:
                motion = rc.predict(neighbours, subject, task, body, scheme=scheme, frame_rate=6.0)
            except ValueError as error:
                words = REFUSALS.search(str(error))
                refused[next(filter(None, words.groups())) if words else str(error)] += 1
                continue
            done += 1
            for name, value in measure(motion, task, body).items():
                worst[name] = max(worst.get(name, -np.inf), value)
    return done, refused, worst


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, default=100_000)
    parser.add_argument("--corpus", type=Path, action="append", help="motions to pick from; else the one that ships")
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    paths = [os.fspath(path) for path in options.corpus or [SHIPPED]]
    share = 2_000
    jobs = [(number, min(share, options.cases - first), paths)
            for number, first in enumerate(range(0, options.cases, share))]
    done, refused, worst = 0, Counter(), {}
    with ProcessPoolExecutor(options.jobs) as pool:
        for count, some, figures in pool.map(check, jobs):
            done, refused = done + count, refused + some
            worst = {name: max(worst.get(name, -np.inf), value) for name, value in figures.items()} or worst
    print(f"{options.cases} cases: {done} predicted, {sum(refused.values())} refused")
    for words, count in refused.most_common():
        print(f"  refused: {words}: {count}")
    print("\n| worst of all | | limit |\n|---|---|---|")
    broken = []
    for name, value in worst.items():
        limit, unit = (SLACK_RAD, "rad") if name.endswith("beyond") else (EXACT_M, "m")
        print(f"| {name} | {value:.1e} {unit} | {limit:.0e} |")
        broken += [name] if not value <= limit else []
    if unknown := [words for words in refused if not REFUSALS.search(words)]:
        print(f"refused for no known reason: {unknown[0]}")
    return 1 if broken or unknown or not done else 0


if __name__ == "__main__":
    sys.exit(main())
