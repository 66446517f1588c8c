# SPDX-License-Identifier: GPL-3.0-or-later
"""Recorded reaches to a wall of targets (Spiers, Gloumakov, Dollar 2024), read through reachcast_core."""

import sys
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

FOLDER = "roag_wall_reaching"
PATTERN = "*_complete_data.csv"
COLUMNS = 7  # of the wall; targets are numbered from 1, row by row, as the person sees them
STILL = 0.05  # of the peak speed: slower steps before and after the reach are cut off
LEAST_FRAMES = 10


@dataclass(frozen=True)
class WallReach:
    participant: str
    target: int
    points: np.ndarray  # (n, 3) of the right wrist, metres: x right, y towards the wall, z up
    posture: np.ndarray  # (3,) from the right shoulder to the wrist, before it moves
    duration: float  # seconds

    @property
    def row(self):
        return (self.target - 1) // COLUMNS

    @property
    def column(self):
        return (self.target - 1) % COLUMNS

    @property
    def start(self):
        return self.points[0]

    @property
    def end(self):
        return self.points[-1]


def trimmed(points):
    """(first, last) of the frames between the first and the last step at STILL of the peak speed or faster."""
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    fast = np.flatnonzero(steps >= STILL * steps.max())
    return int(fast[0]), int(fast[-1]) + 1


def files_in(folder):
    """The recordings in a folder, or in the one of its folders that is named for them."""
    folder = Path(folder)
    if (folder / FOLDER).is_dir():
        folder = folder / FOLDER
    files = sorted(folder.glob(PATTERN))
    if not files:
        raise FileNotFoundError(f"recordings are missing: no {PATTERN} in {folder}")
    return files


def reaches_of(file):
    """Yields (target, WallReach or None, why not) for each group of rows of one participant."""
    clip = rc.read_motion(str(file), metres_per_unit=0.001, up="z")
    labels = clip.channels["interval_label"].astype(int)
    wrist, shoulder = (clip.positions[:, clip.names.index(name)] for name in ("h_Wrist", "h_Sh"))
    for target in np.unique(labels):
        frames = labels == target
        points = wrist[frames]
        if len(points) < LEAST_FRAMES or not np.isfinite(points).all():
            yield target, None, f"has {int(np.isfinite(points).all(axis=1).sum())} whole frames of {len(points)}"
            continue
        first, last = trimmed(points)
        posture = points[first] - shoulder[frames][first]
        if not np.isfinite(posture).all():
            yield target, None, "has no shoulder where it starts"
            continue
        duration = (last - first) / clip.rate
        participant = file.name.split("_")[0]
        yield target, WallReach(participant, int(target), points[first : last + 1], posture, duration), ""


def read_reaches(folder):
    """All reaches of a folder; what cannot be used is said on stderr."""
    reaches = []
    for file in files_in(folder):
        for target, reach, reason in reaches_of(file):
            if reach is None:
                print(f"{file.name}: reach {target} {reason}, left out", file=sys.stderr)
            else:
                reaches.append(reach)
    return reaches
