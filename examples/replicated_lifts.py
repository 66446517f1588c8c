# SPDX-License-Identifier: GPL-3.0-or-later
"""Recorded box lifts that each person made several times (Becanovic), read through reachcast_core: for what one person
varies between repetitions of a task, which the reaches to the wall do not show."""

import csv
from pathlib import Path

from wall_reaches import np, rc

FOLDER = "becanovic_box_lifting"


def wrist_paths(folder):
    """(paths, people): the right wrist from lift-off to placed, one path per lift that has both events; empty lists
    when the folder is not in this collection."""
    folder = Path(folder) / FOLDER
    paths, people = [], []
    if not folder.is_dir():
        return paths, people
    with open(folder / "events.csv", encoding="utf-8", newline="") as file:
        events = list(csv.DictReader(file))
    for event in events:
        name = f"{event['subject']}_{event['trial']}_rep{event['rep']}_lift.csv"
        if not (folder / "trials" / name).is_file() or not event["t2"] or not event["t3"]:
            continue
        clip = rc.read_motion(str(folder / "trials" / name), up="y")
        frames = clip.channels["frame"]
        moving = (frames >= float(event["t2"])) & (frames <= float(event["t3"]))
        wrist = clip.positions[moving, clip.names.index("BODY_RWRI")]
        wrist = wrist[np.isfinite(wrist).all(axis=1)]
        if len(wrist) >= 2:
            paths.append(wrist)
            people.append(f"{event['subject']} {event['trial']}")
    return paths, people
