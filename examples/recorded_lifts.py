# SPDX-License-Identifier: GPL-3.0-or-later
"""Recorded lifts of OMOMO, Lieblich and Becanovic as what is to be predicted, and corpora without one of their people."""
from __future__ import annotations

import csv
import itertools
import shutil
import subprocess
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from reachcast.rigs.joints import INDEX

HERE = Path(__file__).resolve().parent
TIMES = 11              #: evenly spaced from lift-off to placed
PAPERS_JOINTS = 23      #: the first ones of reachcast_core.JOINTS
SAME_TASK_M = 0.10      #: ends of two lifts with the same task
GRIP_BEYOND_WRIST = 0.054   #: of stature, half a hand (Drillis & Contini 1966)
SETS = {"omomo": "OMOMO", "lieblich": "Lieblich"}
#: Markers of Becanovic's subjects and the joints that they lie over.
MARKERS = {"RANK": "right_ankle", "RKNE": "right_knee", "RGTR": "right_hip", "RSHO": "right_shoulder",
           "RELB": "right_elbow", "RWRI": "right_wrist"}
#: Markers with other names on other people: the front of the foot, and the middle of the box's far side.
FOOT, BOX = ("BODY_RMET", "BODY_RTOE"), (("BOX_FARMID",), ("BOX_FARDL", "BOX_FARDR"))


@dataclass(frozen=True)
class Case:
    """Body frame, metres: x right, y ahead, z up."""

    set: str
    person: str
    stature: float
    sex: str | None
    home: np.ndarray            #: hold point at lift-off
    target: np.ndarray          #: and where it was placed
    grip_distance: float
    truth: np.ndarray           #: (TIMES, joints, 3)
    joints: tuple[int, ...]     #: of reachcast_core.JOINTS
    axes: tuple[int, ...] = (0, 1, 2)   #: in which distances are taken

    def error(self, positions: np.ndarray) -> float:
        """Mean distance over time, by the trapezoidal rule, and joints, of (TIMES, 27, 3)."""
        away = (positions[:, self.joints] - self.truth)[..., self.axes]
        by_time = np.linalg.norm(away, axis=2).mean(axis=1)
        return float(np.trapz(by_time) / (TIMES - 1))


class Corpora:
    """The corpus of OMOMO's and Lieblich's phases, and copies of it without a person."""

    def __init__(self, core: Any, mocap: Path, folder: Path) -> None:
        self.core, self.folder = core, folder
        if not (mocap / "omomo").is_dir():
            raise ValueError(f"There are no recordings in {mocap}; give their folder with --mocap")
        self.path = folder / "recorded.sqlite"
        subprocess.run(["/usr/bin/python3", str(HERE / "build_corpus.py"), "--mocap", str(mocap), "--out", str(self.path)],
                       check=True, stdout=subprocess.DEVNULL)
        self.whole = core.Corpus.open(self.path)
        self._without: dict[str, Any] = {}

    def without(self, case: Case) -> Any:
        """An opened corpus that holds nothing of this person."""
        if case.person not in self._without:
            path = self.folder / f"without {len(self._without)}.sqlite"
            shutil.copy(self.path, path)
            with self.core.Corpus.open_for_writing(path) as corpus:
                corpus.remove([motion.id for motion in corpus.motions() if person_of(motion.origin) == case.person])
            self._without[case.person] = self.core.Corpus.open(path)
        return self._without[case.person]


def person_of(origin: str) -> str:
    """'omomo/sub2_largetable_003.csv:22-40' -> 'omomo sub2'."""
    folder, _, name = origin.partition("/")
    return f"{folder} {name.partition('_')[0]}"


def recorded_lifts(core: Any, corpora: Corpora, mocap: Path, most: int = 0) -> list[Case]:
    """All that a body of published proportions can hold. most: of each set; 0: all."""
    found = [*_of_the_corpus(core, corpora), *_becanovic(core, mocap / "becanovic_box_lifting")]
    kept = [case for _, cases in itertools.groupby(found, lambda case: case.set)
            for case in itertools.islice(cases, most or None)]
    if not kept:
        raise ValueError(f"No lift in {mocap} can be used")
    return kept


def _of_the_corpus(core: Any, corpora: Corpora) -> Iterator[Case]:
    motions = [motion for motion in corpora.whole.motions()
               if motion.phase == "transfer" and not motion.mirrored]
    for motion in sorted(motions, key=lambda motion: (person_of(motion.origin).split()[0] != "omomo", motion.id)):
        try:
            truth = core.replay(corpora.whole, motion.id, TIMES)
        except ValueError:
            continue
        person = person_of(motion.origin)
        yield Case(SETS[person.split()[0]], person, motion.subject.stature, motion.subject.sex, motion.home, motion.target,
                   motion.grip_distance, truth[:, :PAPERS_JOINTS], tuple(range(PAPERS_JOINTS)))


def _becanovic(core: Any, folder: Path) -> Iterator[Case]:
    if not folder.is_dir():
        return
    with open(folder / "subjects.csv", encoding="utf-8", newline="") as file:
        statures = {row["subject"]: float(row["stature_cm"]) / 100.0 for row in csv.DictReader(file)}
    with open(folder / "events.csv", encoding="utf-8", newline="") as file:
        events = [row for row in csv.DictReader(file) if row["t2"] and row["t3"]]
    for event in events:
        path = folder / "trials" / f"{event['subject']}_{event['trial']}_rep{event['rep']}_lift.csv"
        if not path.is_file():
            continue
        points = _seen_from_the_body(core.read_motion(str(path), up="y"), float(event["t2"]), float(event["t3"]))
        if points is not None:
            yield _marker_case(event["subject"], statures[event["subject"]], points)


def _seen_from_the_body(clip: Any, first: float, last: float) -> dict[str, np.ndarray] | None:
    """Markers over time (TIMES, 3): y along the right foot, x from the middle of the box to its right, z up from the
    floor. None where a marker is missing for long. The reader has turned the clip's up axis to z."""
    frames = clip.channels["frame"]
    moving = np.flatnonzero((frames >= first) & (frames <= last))
    foot = next(name for name in FOOT if name in clip.names)
    box = next(names for names in BOX if names[0] in clip.names)
    names = [*(f"BODY_{marker}" for marker in (*MARKERS, "RHEE")), foot, *box]
    if len(moving) < TIMES or not set(names) <= set(clip.names):
        return None
    at = np.linspace(0.0, len(moving) - 1.0, TIMES)
    points = {}
    for name in names:
        track = clip.positions[moving, clip.names.index(name)]
        seen = np.flatnonzero(np.isfinite(track).all(axis=1))
        if len(seen) < 0.9 * len(track):
            return None
        points[name] = np.stack([np.interp(at, seen, track[seen, axis]) for axis in range(3)], axis=1)
    ahead = np.mean(points[foot] - points["BODY_RHEE"], axis=0) * [1.0, 1.0, 0.0]
    ahead /= np.linalg.norm(ahead)
    axes = np.stack([np.cross(ahead, [0.0, 0.0, 1.0]), ahead, [0.0, 0.0, 1.0]])
    origin = points["BODY_RANK"].mean(axis=0) * [1.0, 1.0, 0.0]
    turned = {name: (track - origin) @ axes.T for name, track in points.items()}
    middle = float(np.mean([turned[name][:, 0] for name in box]))
    return {name: track - [middle, 0.0, 0.0] for name, track in turned.items()}


def _marker_case(subject: str, stature: float, points: dict[str, np.ndarray]) -> Case:
    wrist, elbow = points["BODY_RWRI"], points["BODY_RELB"]
    forearm = wrist - elbow
    grip = wrist + GRIP_BEYOND_WRIST * stature * forearm / np.linalg.norm(forearm, axis=1, keepdims=True)
    ends = [np.array([0.0, *grip[place, 1:]]) for place in (0, -1)]
    truth = np.stack([points[f"BODY_{marker}"] for marker in MARKERS], axis=1)
    return Case("Becanovic", f"becanovic {subject}", stature, None, *ends, 2.0 * float(abs(grip[:, 0]).mean()), truth,
                tuple(INDEX[joint] for joint in MARKERS.values()), axes=(1, 2))


def natural_variation(cases: Sequence[Case]) -> dict[str, tuple[int, float]]:
    """Set -> (pairs, median distance in metres) of one person's lifts whose ends lie within SAME_TASK_M."""
    found: dict[str, list[float]] = {name: [] for name in dict.fromkeys(case.set for case in cases)}
    for one, other in itertools.combinations(cases, 2):
        ends = max(np.linalg.norm(one.home - other.home), np.linalg.norm(one.target - other.target))
        if one.person == other.person and ends <= SAME_TASK_M:
            away = np.linalg.norm((one.truth - other.truth)[..., one.axes], axis=2).mean(axis=1)
            found[one.set].append(float(np.trapz(away) / (TIMES - 1)))
    return {name: (len(values), float(np.median(values)) if values else 0.0) for name, values in found.items()}
