# SPDX-License-Identifier: GPL-3.0-or-later
"""Several corpora as one."""
from __future__ import annotations

from collections.abc import Iterator
from types import ModuleType

_AT_ONCE = 500  #: codes held in memory


def merge_into(core: ModuleType, corpus: object, path: str) -> Iterator[tuple[str, int]]:
    """Copies what another corpus holds and this one does not, a file per step: yields (name, new motions).

    Motions that came from no file follow last, under the name "". ValueError when the codes of the two do not fit.
    """
    with core.Corpus.open(path) as other:
        rest = {motion.id for motion in other.motions()}
        for source in other.sources():
            ids = other.motions_of(source.id)
            rest.difference_update(ids)
            before = len(corpus)
            corpus.copy_source(source, other.load(ids))
            yield source.path, len(corpus) - before
        before = len(corpus)
        ordered = sorted(rest)
        for start in range(0, len(ordered), _AT_ONCE):
            corpus.add(other.load(ordered[start:start + _AT_ONCE]))
        yield "", len(corpus) - before
