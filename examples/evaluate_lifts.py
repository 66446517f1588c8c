# SPDX-License-Identifier: GPL-3.0-or-later
"""Predicted lifts beside recorded ones and beside what else could be done, leaving out whole people.

    blender -b --factory-startup --python-exit-code 1 --python examples/evaluate_lifts.py -- --mocap ../shared/mocap

Of every recorded lift (OMOMO, Lieblich, Becanovic) only the person's stature, sex and where the hands begin and end are
given; what was learned from holds nobody of that name. The figure is the paper's: the mean over time and joints of the
distance between prediction and recording on one body, of published proportions for the stature; the median over lifts, in
centimetres. Becanovic's lifts are known by markers on the right side only: there it is the distance in the sagittal
plane of six joints, on the recorded body itself.

Beside the schemes stand: one recorded motion carried over (k = 1 is retargeting), the plain mean of the same neighbours'
joint positions, and Blender's inverse kinematics, which pulls hands and feet of a mannequin from its rest pose to where
the default scheme has them. Exit status 1 if a baseline is better than the default scheme on a set.
"""
from __future__ import annotations

import argparse
import os
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path[:0] = [os.fspath(HERE.parent / "addon"), os.fspath(HERE)]

import addon_utils  # noqa: E402

addon_utils.enable("reachcast")

import bpy  # noqa: E402
import recorded_lifts as people  # noqa: E402
import numpy as np  # noqa: E402
from reachcast import native  # noqa: E402
from reachcast.batch.stage import add_mannequin  # noqa: E402
from reachcast.corpora import default_corpus  # noqa: E402
from reachcast.rigs.joints import INDEX  # noqa: E402
from reachcast.scene.measure import sample  # noqa: E402
from reachcast.scene.read_rig import read_rig  # noqa: E402

rc = native.core()
SETS = ("OMOMO", "Lieblich", "Becanovic")
DEFAULT = "ranks of task + stature, k = 5 (default)"
RETARGETED = "retargeting: nearest motion, k = 1"
SCHEMES = {
    RETARGETED: {"k": 1, "sets": 1},
    "k = 3, one set": {"k": 3, "sets": 1},
    "k = 3": {"k": 3},
    DEFAULT: {},
    "poses, k = 5, one set": {"postures": "poses", "sets": 1},
    "k = 10": {"k": 10},
    "ranks of task alone, k = 5": {"ranks": ["task"]},
    "distances, kernel, k = 15": {"k": 15, "distances": ["task", "stature"], "smoother": "kernel"},
    "distances, local line, k = 15": {"k": 15, "distances": ["task", "stature"], "smoother": "linear"},
}
SIMULATED, MEAN, IK = "default scheme, corpus that ships (simulated)", "mean of joint positions", "Blender's IK"
BASELINES = (RETARGETED, MEAN, IK)
#: Bones pulled by Empties, and the joint where the tail of each is; the whole figure follows.
PULLED = {"hand.L": "left_grip", "hand.R": "right_grip", "shin.L": "left_ankle", "shin.R": "right_ankle"}
RESAMPLES, SEED = 1000, 2004


def predicted(case: people.Case, corpus: object, scheme: dict[str, object]) -> object:
    """The Motion, or None where it cannot be held."""
    box = rc.Box(max(case.grip_distance, 0.02), 0.10, 0.10, 0.0, grip_distance=max(case.grip_distance, 0.02))
    task = rc.Task(case.home, case.target, box)
    try:
        return rc.predict(corpus, rc.Subject(case.stature, sex=case.sex), task,
                          rc.Body.from_stature(case.stature, sex=case.sex), scheme=scheme, frame_rate=30.0)
    except ValueError:
        return None


def in_time(positions: np.ndarray) -> np.ndarray:
    """(F, 27, 3) -> (TIMES, 27, 3), evenly spaced."""
    at = np.linspace(0.0, len(positions) - 1.0, people.TIMES)
    low = np.minimum(at.astype(int), len(positions) - 2)
    share = (at - low)[:, None, None]
    return (1.0 - share) * positions[low] + share * positions[low + 1]


def mean_of_joints(motion: object, corpus: object) -> np.ndarray | None:
    """The neighbours' joints, each on a body of its own subject's stature, averaged with the weights of the default."""
    total, weights = np.zeros((people.TIMES, len(rc.JOINTS), 3)), 0.0
    for near in motion.neighbours:
        try:
            total += near.weight * rc.replay(corpus, near.id, people.TIMES)
            weights += near.weight
        except ValueError:  # a body of published proportions cannot do what its subject did
            continue
    return total / weights if weights else None


class Puppet:
    """Mannequins that Blender's inverse kinematics moves, one of each person."""

    def __init__(self) -> None:
        self.rigs: dict[tuple[float, str | None], tuple[bpy.types.Object, object]] = {}

    def follow(self, case: people.Case, wanted: np.ndarray) -> np.ndarray:
        """Joints (TIMES, 27, 3), body frame, of a rig whose hands and feet are pulled to those of `wanted`."""
        rig, skeleton = self._rig(case)
        frames = range(1, people.TIMES + 1)
        targets = [self._target(rig, skeleton, bone, joint, wanted, frames) for bone, joint in PULLED.items()]
        bpy.context.scene.frame_set(1)
        joints = sample(rig, skeleton, frames).joints
        for bone in PULLED:
            constraints = rig.pose.bones[bone].constraints
            constraints.remove(constraints[0])
        for target in targets:
            action = target.animation_data.action
            bpy.data.objects.remove(target)
            bpy.data.actions.remove(action)
        return skeleton.to_body(joints)

    def _rig(self, case: people.Case) -> tuple[bpy.types.Object, object]:
        key = (case.stature, case.sex)
        if key not in self.rigs:
            rig = add_mannequin(*key)
            self.rigs[key] = rig, read_rig(rig)
        return self.rigs[key]

    @staticmethod
    def _target(rig: bpy.types.Object, skeleton: object, bone: str, joint: str, wanted: np.ndarray,
                frames: range) -> bpy.types.Object:
        target = bpy.data.objects.new("target", None)
        bpy.context.collection.objects.link(target)
        places = skeleton.to_world(wanted[:, INDEX[joint]])
        for frame, place in zip(frames, places):
            target.location = place
            target.keyframe_insert("location", frame=frame)
        constraint = rig.pose.bones[bone].constraints.new("IK")
        constraint.target, constraint.chain_count = target, 0  # up to the root
        constraint.iterations = 500
        return target


def errors_of(cases: Sequence[people.Case], corpora: people.Corpora, say: Callable[[str], None]) -> dict[str, list[float]]:
    """method -> error of every case, metres; infinite where a motion cannot be held."""
    errors: dict[str, list[float]] = {name: [] for name in (*SCHEMES, SIMULATED, MEAN, IK)}
    simulated, puppet = rc.Corpus.open(default_corpus()), Puppet()
    for number, case in enumerate(cases, 1):
        corpus = corpora.without(case)
        best = None
        for name, scheme in SCHEMES.items():
            motion = predicted(case, corpus, scheme)
            errors[name].append(case.error(in_time(motion.positions)) if motion else np.inf)
            best = motion if name == DEFAULT else best
        other = predicted(case, simulated, {})
        errors[SIMULATED].append(case.error(in_time(other.positions)) if other else np.inf)
        mean = mean_of_joints(best, corpus) if best else None
        errors[MEAN].append(np.inf if mean is None else case.error(mean))
        errors[IK].append(case.error(puppet.follow(case, in_time(best.positions))) if best else np.inf)
        if number % 10 == 0 or number == len(cases):
            say(f"{number} of {len(cases)} lifts")
    return errors


def behind(errors: np.ndarray, default: np.ndarray, groups: np.ndarray) -> tuple[float, float]:
    """95 % interval of the median's distance from the default's, resampling people."""
    pick, names = np.random.default_rng(SEED), np.unique(groups)
    rows = {name: np.flatnonzero(groups == name) for name in names}
    found = []
    for _ in range(RESAMPLES):
        chosen = np.concatenate([rows[name] for name in pick.choice(names, len(names))])
        found.append(np.median(errors[chosen]) - np.median(default[chosen]))
    return float(np.quantile(found, 0.025)), float(np.quantile(found, 0.975))


def table(cases: Sequence[people.Case], errors: dict[str, list[float]]) -> list[str]:
    """Prints it; returns which baselines are better than the default, and where."""
    sets = np.array([case.set for case in cases])
    groups = np.array([case.person for case in cases])
    heads = [f"{name} ({np.sum(sets == name)} lifts, {len(set(groups[sets == name]))} people)" for name in SETS]
    print("| | " + " | ".join(heads) + " |\n|---" + "|---" * len(SETS) + "|")
    better = []
    for method, values in errors.items():
        cells = []
        for name in SETS:
            here, default = np.array(values)[sets == name], np.array(errors[DEFAULT])[sets == name]
            low, high = behind(here, default, groups[sets == name])
            apart = "" if method == DEFAULT else f" ({100 * low:+.1f} to {100 * high:+.1f})"
            failed = int(np.sum(~np.isfinite(here)))
            cells.append(f"{100 * np.median(here):.1f}{apart}" + (f", {failed} not held" if failed else ""))
            if method in BASELINES and np.median(here) < np.median(default):
                better.append(f"{method} on {name}")
        print(f"| {method} | " + " | ".join(cells) + " |")
    return better


def print_variation(cases: Sequence[people.Case]) -> None:
    print("\nnatural variation, one person's lifts with the same task:")
    for name, (pairs, median) in people.natural_variation(cases).items():
        print(f"  {name}: {pairs} pairs" + (f", median {100 * median:.1f} cm" if pairs else ""))


def main() -> None:
    parser = argparse.ArgumentParser(prog="evaluate_lifts.py", description=__doc__.splitlines()[0])
    parser.add_argument("--mocap", type=Path, default=HERE.parents[1] / "shared" / "mocap")
    parser.add_argument("--most", type=int, default=0, help="this many lifts of each set; 0: all")
    options = parser.parse_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable("reachcast")
    with tempfile.TemporaryDirectory(prefix="reachcast-") as folder:
        try:
            corpora = people.Corpora(rc, options.mocap, Path(folder))
            cases = people.recorded_lifts(rc, corpora, options.mocap, options.most)
        except ValueError as error:
            sys.exit(str(error))
        errors = errors_of(cases, corpora, lambda line: print(line, file=sys.stderr, flush=True))
        better = table(cases, errors)
        print_variation(cases)
    if better and not options.most:
        sys.exit("better than the default scheme: " + "; ".join(better))


if __name__ == "__main__":
    main()
