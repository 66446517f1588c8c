#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares the phases that find_reaches finds by itself with those cut by tables that people made.

    /usr/bin/python3 examples/evaluate_reaches.py --mocap ../shared/mocap

The tables are omomo/clips.csv and lieblich_lifting/dip_segments.csv, read as build_corpus.py reads them. find_reaches is
given the recording and the stature alone. A phase is recovered when one is found whose ends are both within 0.25 s and
in which the hands are as full, or as empty. What is found besides is counted by whether the table has frames there.
With --others every other recording of the collection is searched as well. --list tells each phase.
"""

import argparse
import sys
from dataclasses import dataclass, field
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "addon" / "reachcast"))
import build_corpus
from build_corpus import rc

TOLERANCE_S = 0.25
LOADED = ("transfer", "retrieve")
OTHERS = (".bvh", ".c3d", ".trc", ".amc")


@dataclass
class Recording:
    name: str
    clip: object  # canonical
    recorded: object
    stature: float
    truths: list = field(default_factory=list)  # (first, last, phase)
    tabled: list = field(default_factory=list)  # (first, last) of everything the table speaks of


def span_of(origin):
    first, last = origin.rsplit(":", 1)[1].split("-")
    return int(first), int(last)


def collect(folder, phases, joint_map):
    """Recordings of a folder with the phases that their tables give."""
    recordings = {}
    for candidate in phases(folder):
        stem = candidate.origin.split(".csv")[0].split("/")[1]
        if stem not in recordings:
            recorded = rc.read_motion(str(folder / f"{stem}.csv"))
            clip = rc.canonical(recorded, joint_map)
            recordings[stem] = Recording(stem, clip, recorded, build_corpus.stature_from_skeleton([clip]))
        if ".csv:" in candidate.origin:
            recordings[stem].tabled.append(span_of(candidate.origin))
        if candidate.reach is not None:
            recordings[stem].truths.append((*span_of(candidate.origin), candidate.reach.phase))
    return list(recordings.values())


def near(span, truth, rate):
    return all(abs(a - b) / rate <= TOLERANCE_S for a, b in zip(span, truth))


def overlaps(span, other):
    return span[0] <= other[1] and other[0] <= span[1]


def why_missed(found, truth, rate):
    """What became of the frames of a phase that was not recovered."""
    first, last, _ = truth
    parts = [
        f"{reach.phase} found at {a}-{b}"
        for reach, (a, b) in zip(found.reaches, found.spans)
        if overlaps((a, b), (first, last))
    ]
    parts += [f"{r.what} {r.first}-{r.last}: {r.reason}" for r in found.rejections if overlaps((r.first, r.last), truth)]
    return "; ".join(parts) or "no movement was seen there"


def compare(recording, lines):
    """(recovered, missed, found within the table's frames besides, found elsewhere, rejected)"""
    found = rc.find_reaches(recording.clip, rc.Subject(recording.stature), recorded=recording.recorded)
    rate, taken = recording.clip.rate, set()
    for truth in recording.truths:
        match = next(
            (
                i
                for i, span in enumerate(found.spans)
                if i not in taken
                and near(span, truth[:2], rate)
                and (found.reaches[i].phase in LOADED) == (truth[2] in LOADED)
            ),
            None,
        )
        if match is None:
            lines.append(f"missed    {recording.name}:{truth[0]}-{truth[1]} {truth[2]}: {why_missed(found, truth, rate)}")
        else:
            taken.add(match)
    besides = [span for i, span in enumerate(found.spans) if i not in taken]
    for span, reach in zip(found.spans, found.reaches):
        if span in besides:
            lines.append(f"besides   {recording.name}:{span[0]}-{span[1]} {reach.phase}, {reach.duration:.2f} s")
    inside = sum(any(overlaps(span, tabled) for tabled in recording.tabled) for span in besides)
    return len(taken), len(recording.truths) - len(taken), inside, len(besides) - inside, len(found.rejections)


def search_others(mocap):
    """Every other recording that shows a whole body: what is found in it, or why not."""
    for path in sorted(p for p in mocap.rglob("*") if p.suffix.lower() in OTHERS):
        try:
            recorded = rc.read_motion(str(path), **({"rate": 120} if path.suffix.lower() == ".amc" else {}))
            clip = rc.canonical(recorded)
            found = rc.find_reaches(clip, rc.Subject(build_corpus.stature_from_skeleton([clip])), recorded=recorded)
        except ValueError as why:
            print(f"{path.name}: {why}")
            continue
        print(f"{path.name}: {len(clip) / clip.rate:.1f} s, {len(found.reaches)} phases, {len(found.rejections)} rejected")
        for reach, span in zip(found.reaches, found.spans):
            print(f"    {reach.phase} {span[0]}-{span[1]}, {reach.duration:.2f} s")
        for rejection in found.rejections[:4]:
            print(f"    no {rejection.what} {rejection.first}-{rejection.last}: {rejection.reason}")


def main():
    parser = argparse.ArgumentParser(description="Compare find_reaches with tables that people made.")
    parser.add_argument("--mocap", type=Path, required=True, help="folder with omomo/ and lieblich_lifting/")
    parser.add_argument("--others", action="store_true", help="search the other recordings as well")
    parser.add_argument("--list", action="store_true", help="tell each phase that was missed or found besides")
    options = parser.parse_args()
    collections = {
        "OMOMO": ("omomo", build_corpus.omomo_phases, "omomo"),
        "Lieblich": ("lieblich_lifting", build_corpus.lieblich_phases, "lieblich"),
    }
    lines = []
    print("| recordings | in the table | recovered | missed | besides, in its frames | besides, elsewhere | rejected |")
    print("|---|---|---|---|---|---|---|")
    for title, (folder, phases, joint_map) in collections.items():
        if not (options.mocap / folder).is_dir():
            print(f"skipped   {options.mocap / folder}: no such folder")
            continue
        recordings = collect(options.mocap / folder, phases, joint_map)
        counts = [sum(column) for column in zip(*(compare(recording, lines) for recording in recordings))]
        print(f"| {title} ({len(recordings)}) | {counts[0] + counts[1]} | " + " | ".join(map(str, counts)) + " |")
    if options.list:
        print("\n".join(lines))
    if options.others:
        search_others(options.mocap)


if __name__ == "__main__":
    main()
