#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares the simulated corpus with recorded people: postures at lift-off from the floor, paths of the hands, times.

    /usr/bin/python3 examples/compare_simulated.py [--corpus FILE] [--mocap ../shared/mocap]

Prints a table: of each measure the median and the 5th and 95th percentile, for the simulated lifts and for three sets of
recordings, and whether the simulated median lies within the recorded people's spread, from the lowest 5th to the highest
95th percentile. Exit status 1 when one does not. The postures of the recorded people are published with the recordings
(the folder's README.md, last table); paths are measured here on the recorded lifts that build_corpus.py accepts.
"""
from __future__ import annotations

import argparse
import csv
import os
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, os.fspath(HERE.parent / "addon" / "reachcast"))
import numpy as np  # noqa: E402
import reachcast_core as rc  # noqa: E402

INDEX = {name: number for number, name in enumerate(rc.JOINTS)}
FLOOR_M = 0.35  #: a lift from below this height of the hands is one from the floor
SETS = ("Becanovic", "Lieblich", "OMOMO")
#: measure -> (median, 5th, 95th percentile) of each set, as its README says; degrees, metres, seconds
RECORDED = {
    "trunk from vertical": ((48, 38, 56), (82, 62, 103), (76, 18, 90)),
    "hip": ((55, 49, 62), (47, 34, 57), (47, 25, 134)),
    "knee": ((67, 56, 79), (88, 67, 134), (90, 51, 149)),
    "elbow": ((150, 128, 165), (150, 120, 169), (139, 114, 163)),
    "wrist height": ((0.29, 0.21, 0.34), (0.22, 0.16, 0.30), (0.34, 0.18, 0.72)),
    "wrist ahead of ankle": ((0.40, 0.35, 0.45), (0.34, 0.31, 0.41), (0.40, 0.20, 0.54)),
    "lift-off to placed": ((2.14, 1.05, 2.54), None, None),
}


def angle_at(postures: np.ndarray, first: str, middle: str, last: str) -> np.ndarray:
    """Included angle in degrees, the mean of both sides."""
    found = []
    for side in ("left", "right"):
        a, b, c = (postures[:, INDEX[f"{side}_{name}"]] for name in (first, middle, last))
        upper, lower = a - b, c - b
        cosine = np.sum(upper * lower, axis=1) / (np.linalg.norm(upper, axis=1) * np.linalg.norm(lower, axis=1))
        found.append(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))
    return np.mean(found, axis=0)


def middle(postures: np.ndarray, name: str) -> np.ndarray:
    return 0.5 * (postures[:, INDEX[f"left_{name}"]] + postures[:, INDEX[f"right_{name}"]])


def posture_measures(postures: np.ndarray) -> dict[str, np.ndarray]:
    """(n, 27, 3) body frame -> measure -> (n,)."""
    trunk = middle(postures, "shoulder") - middle(postures, "hip")
    wrist, ankle = middle(postures, "wrist"), middle(postures, "ankle")
    return {
        "trunk from vertical": np.degrees(np.arctan2(np.hypot(trunk[:, 0], trunk[:, 1]), trunk[:, 2])),
        "hip": angle_at(postures, "shoulder", "hip", "knee"),
        "knee": angle_at(postures, "hip", "knee", "ankle"),
        "elbow": angle_at(postures, "shoulder", "elbow", "wrist"),
        "wrist height": wrist[:, 2],
        "wrist ahead of ankle": wrist[:, 1] - ankle[:, 1],
    }


def floor_lifts(corpus: rc.Corpus) -> list[rc.MotionSummary]:
    return [motion for motion in corpus.motions()
            if motion.phase == "transfer" and not motion.mirrored and motion.home[2] < FLOOR_M]


def chord_deviation(hold: np.ndarray) -> float:
    chord = hold[-1] - hold[0]
    along = chord / np.linalg.norm(chord)
    rest = hold - hold[0]
    return float(np.linalg.norm(rest - np.outer(rest @ along, along), axis=1).max() / np.linalg.norm(chord))


def deviation(corpus: rc.Corpus, motion: rc.MotionSummary) -> float:
    """Largest distance of the hands' path from its chord, as a part of the chord."""
    postures = rc.replay(corpus, motion.id)
    return chord_deviation(middle(postures, "grip"))


def spread(values: object) -> tuple[float, float, float]:
    return tuple(float(np.quantile(values, share)) for share in (0.5, 0.05, 0.95))  # type: ignore[return-value]


def becanovic_deviations(mocap: Path) -> list[float]:
    """Of the right wrist, from lift-off (t2) to placed (t3); frames count from those of the trial's file."""
    folder, found = mocap / "becanovic_box_lifting", []
    with open(folder / "events.csv", encoding="utf-8", newline="") as file:
        for event in csv.DictReader(file):
            if not event["t2"] or not event["t3"]:
                continue
            trial = folder / "trials" / f"{event['subject']}_{event['trial']}_rep{event['rep']}_lift.csv"
            with open(trial, encoding="utf-8", newline="") as rows:
                wrist = [[float(row[f"BODY_RWRI_{axis}"] or "nan") for axis in "xyz"] for row in csv.DictReader(rows)
                         if int(event["t2"]) <= int(float(row["frame"])) <= int(event["t3"])]
            points = np.array(wrist)
            points = points[np.isfinite(points).all(axis=1)]
            if len(points) > 10:
                found.append(chord_deviation(points))
    return found


def recorded_deviations(mocap: Path) -> list[float]:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "recorded.sqlite"
        subprocess.run([sys.executable, os.fspath(HERE / "build_corpus.py"), "--mocap", os.fspath(mocap), "--out",
                        os.fspath(path)], check=True, capture_output=True)
        corpus, found = rc.Corpus.open(path), []
        for motion in floor_lifts(corpus):
            try:
                found.append(deviation(corpus, motion))
            except ValueError:  # a body of published proportions cannot hold it
                continue
        corpus.close()
    return found


def simulated(corpus: rc.Corpus) -> dict[str, tuple[float, float, float]]:
    lifts = floor_lifts(corpus)
    if not lifts:
        sys.exit(f"{corpus.path} has no lifts from below {FLOOR_M} m to compare.")
    first = np.array([rc.replay(corpus, motion.id)[0] for motion in lifts])
    found = {name: spread(values) for name, values in posture_measures(first).items()}
    found["lift-off to placed"] = spread([motion.duration for motion in lifts])
    found["path from its chord"] = spread([deviation(corpus, motion) for motion in lifts])
    return found


def text(values: tuple[float, float, float] | None, digits: int) -> str:
    return "-" if values is None else f"{values[0]:.{digits}f} [{values[1]:.{digits}f}, {values[2]:.{digits}f}]"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--corpus", type=Path, default=HERE.parent / "addon" / "reachcast" / "data" / "simulated.sqlite")
    parser.add_argument("--mocap", type=Path, default=HERE.parent.parent / "shared" / "mocap")
    options = parser.parse_args()
    corpus = rc.Corpus.open(options.corpus)
    found = simulated(corpus)
    table = dict(RECORDED)
    if (options.mocap / "omomo").is_dir():
        table["path from its chord"] = (spread(becanovic_deviations(options.mocap)), None,
                                       spread(recorded_deviations(options.mocap)))  # Lieblich and OMOMO
    else:
        print(f"recordings are missing: {options.mocap}; paths are not compared")
    print(f"{len(floor_lifts(corpus))} simulated lifts from the floor\n")
    print("| measure | simulated | " + " | ".join(SETS) + " | within |")
    print("|---" * 6 + "|")
    outside = []
    for name, sets in table.items():
        known = [values for values in sets if values is not None]
        low, high = min(values[1] for values in known), max(values[2] for values in known)
        inside = low <= found[name][0] <= high
        outside += [] if inside else [name]
        digits = 0 if name in ("trunk from vertical", "hip", "knee", "elbow") else 2
        print(f"| {name} | {text(found[name], digits)} | " + " | ".join(text(values, digits) for values in sets)
              + f" | {'yes' if inside else 'NO'} |")
    if outside:
        sys.exit(f"outside the recorded people's spread: {', '.join(outside)}")


if __name__ == "__main__":
    main()
