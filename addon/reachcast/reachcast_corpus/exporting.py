# SPDX-License-Identifier: GPL-3.0-or-later
"""Stored motions as files: a table of joint centres, or a BVH skeleton."""
from __future__ import annotations

import csv
import os
from pathlib import Path
from types import ModuleType

import numpy as np

from .bvh import bvh_text

FORMATS = ("csv", "bvh")


def export_motion(core: ModuleType, corpus: object, motion: object, folder: Path, form: str,
                  rate: float = 60.0) -> Path:
    """Writes one motion as `<id>_<phase>.<form>` and returns the path; a file of that name is replaced as a whole.
    `rate`: frames per second, nearly: the last frame is the end of the motion.

    The body is one of published proportions of the subject's stature. Metres, z up, the person faces +y.
    """
    if form not in FORMATS:
        raise ValueError(f"the format '{form}' is none of {', '.join(FORMATS)}")
    if not 1.0 <= rate <= 1000.0:
        raise ValueError(f"the rate {rate:g} Hz is not within 1 to 1000")
    frames = max(2, round(motion.duration * rate) + 1)
    positions = core.replay(corpus, motion.id, frames)
    rate = (frames - 1) / motion.duration  # the last frame is the end
    path = folder / f"{motion.id:06d}_{motion.phase}.{form}"
    draft = path.with_suffix(path.suffix + ".part")
    with open(draft, "w", encoding="utf-8", newline="\n") as file:
        if form == "csv":
            _write_table(file, list(core.JOINTS), positions, rate)
        else:
            file.write(bvh_text(list(core.JOINTS), positions, rate, motion.subject.stature))
    os.replace(draft, path)
    return path


def _write_table(file: object, names: list[str], positions: np.ndarray, rate: float) -> None:
    table = csv.writer(file, lineterminator="\n")
    table.writerow(["time_s"] + [f"{name}_{axis}" for name in names for axis in "xyz"])
    for frame, posture in enumerate(positions):
        table.writerow([f"{frame / rate:.6f}"] + [f"{value:.6f}" for value in posture.reshape(-1)])
