# SPDX-License-Identifier: GPL-3.0-or-later
"""What a compact corpus costs: recorded motions stored both ways and played on the body of their subject."""
from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "addon" / "reachcast")]
import corpora  # noqa: E402
import reachcast_core as rc  # noqa: E402

WORST_M = 5e-3    #: of an elbow or a knee that is nearly straight, where little moves it far
MOST_M = 3e-4     #: of 99 places in a hundred
USUAL_M = 1e-4


@pytest.fixture(scope="module")
def both(tmp_path_factory: pytest.TempPathFactory) -> tuple[rc.Corpus, rc.Corpus]:
    if not (corpora.MOCAP / "omomo").is_dir():
        pytest.skip(f"recordings are missing: {corpora.MOCAP} (set REACHCAST_MOCAP)")
    exact = rc.Corpus.open(corpora.recorded_corpus())
    compact = rc.Corpus.create(tmp_path_factory.mktemp("compact") / "c.sqlite", "compact")
    compact.add(exact.load([motion.id for motion in exact.motions()]))
    return exact, compact


def test_joints_stay_where_they_were(both: tuple[rc.Corpus, rc.Corpus]) -> None:
    exact, compact = both
    off = []
    for one, other in zip(exact.motions(), compact.motions()):
        assert (one.origin, one.phase, one.mirrored, one.duration) == (other.origin, other.phase, other.mirrored,
                                                                       other.duration)
        np.testing.assert_array_equal([one.home, one.target], [other.home, other.target])
        try:
            recorded = rc.replay(exact, one.id)
        except ValueError:
            continue
        off.append(np.linalg.norm(rc.replay(compact, other.id) - recorded, axis=2))
    assert len(off) > 0.9 * len(exact)
    assert np.max(off) < WORST_M
    assert np.quantile(off, 0.99) < MOST_M
    assert np.median(off) < USUAL_M


def test_it_is_small(both: tuple[rc.Corpus, rc.Corpus]) -> None:
    exact, compact = both
    assert compact.path.stat().st_size < 0.3 * exact.path.stat().st_size
    assert (exact.meta["precision"], compact.meta["precision"]) == ("exact", "compact")


def test_another_precision_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="precision is 'float'; it must be 'exact' or 'compact'"):
        rc.Corpus.create(tmp_path / "c.sqlite", precision="float")
    assert not list(tmp_path.iterdir())
