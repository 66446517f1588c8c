# SPDX-License-Identifier: GPL-3.0-or-later
"""How well the transfers of a corpus are predicted from the others: one row per number of neighbours.

    /usr/bin/python3 examples/cross_validate.py corpus.sqlite

Each motion (or its whole subject) is left out, predicted on the proportions of the subject's stature, and compared with
what its own code gives on that body: the mean distance over time and 23 joints, in centimetres. Given are where the
hands begin and end; feet stand still.
"""
from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "addon" / "reachcast"))
sys.dont_write_bytecode = True

NEIGHBOURS = (1, 2, 3, 5, 8)


def main() -> int:
    if len(sys.argv) != 2:
        print(__doc__)
        return 2
    import reachcast_core
    with reachcast_core.Corpus.open(sys.argv[1]) as corpus:
        print("left out   k  motions  median  quartiles (cm)")
        for leave_out in ("motion", "subject"):
            for row in reachcast_core.cross_validate(corpus, [{"k": k} for k in NEIGHBOURS], leave_out):
                low, high = (100 * value for value in row["quartiles"])
                print(f"{leave_out:8} {row['k']:3}  {row['motions']:7}  {100 * row['median']:6.1f}  {low:.1f} to {high:.1f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
