# SPDX-License-Identifier: GPL-3.0-or-later
"""A corpus of any size: the one that ships, repeated with other places and durations.

    /usr/bin/python3 blender_tests/large_corpora.py FILE [MOTIONS]
"""
from __future__ import annotations

import random
import shutil
import sqlite3
import sys
from pathlib import Path

SHIPPED = Path(__file__).resolve().parent.parent / "addon" / "reachcast" / "data" / "simulated.sqlite"
SEED = 2004
APART_M = 0.05   #: by which a copy's ends may differ from its motion's
PACE = 0.1       #: and its duration, as a part of it


def write_repeated(path: Path, count: int) -> None:
    """At least `count` motions. Straight into the tables, which is ten times quicker than adding them."""
    shutil.copy(SHIPPED, path)
    pick = random.Random(SEED)
    with sqlite3.connect(path) as file:
        file.execute("PRAGMA synchronous = OFF")
        clips, motions, codes = (file.execute(f"SELECT * FROM {name} ORDER BY 1").fetchall()
                                 for name in ("clips", "motions", "codes"))
        for copy in range(1, -(-count // len(motions))):
            clip, motion = copy * clips[-1][0], copy * motions[-1][0]
            file.executemany("INSERT INTO clips VALUES (?, ?, ?)",
                             [(key + clip, f"{origin}, copy {copy}", source) for key, origin, source in clips])
            file.executemany(f"INSERT INTO motions VALUES ({', '.join('?' * len(motions[0]))})",
                             [(row[0] + motion, row[1], row[2] + clip, *row[3:6], row[6] * pick.uniform(1 - PACE, 1 + PACE),
                               *(value + pick.uniform(-APART_M, APART_M) for value in row[7:13]), *row[13:])
                              for row in motions])
            file.executemany("INSERT INTO codes VALUES (?, ?, ?)",
                             [(key + motion, original and original + motion, data) for key, original, data in codes])


if __name__ == "__main__":
    write_repeated(Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 1_000_000)
