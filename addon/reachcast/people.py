# SPDX-License-Identifier: GPL-3.0-or-later
"""How tall people are: percentiles of stature from published anthropometry.

Means and standard deviations of the US Army survey of 1988 (Gordon et al., Natick TR-89/044), 2,208 women and 1,774
men, taken as normal distributions. Soldiers are not everybody: for other people give the stature itself.
"""
from __future__ import annotations

from dataclasses import dataclass
from statistics import NormalDist

STATURE_M = {"female": NormalDist(1.6294, 0.0636), "male": NormalDist(1.7558, 0.0668)}


@dataclass(frozen=True)
class Person:
    """Somebody of a sex ("female" or "male") at a percentile (above 0, below 100) of stature."""

    sex: str
    percentile: float

    @property
    def stature(self) -> float:
        """Metres."""
        return stature_at(self.sex, self.percentile)

    def __str__(self) -> str:
        word = {"female": "woman", "male": "man"}[self.sex]
        return f"{_ordinal(self.percentile)} percentile {word}"


def stature_at(sex: str, percentile: float) -> float:
    """Metres; ValueError for another sex than "female" and "male" and for a percentile outside (0, 100)."""
    if sex not in STATURE_M:
        raise ValueError(f"The sex is {sex!r}; it must be 'female' or 'male' for a percentile")
    if not 0.0 < percentile < 100.0:
        raise ValueError(f"The percentile is {percentile!r}; it must be above 0 and below 100")
    return STATURE_M[sex].inv_cdf(percentile / 100.0)


def _ordinal(number: float) -> str:
    if number != int(number):
        return f"{number:g}th"
    last = int(number) % 10 if int(number) % 100 not in (11, 12, 13) else 0
    return f"{int(number)}{ {1: 'st', 2: 'nd', 3: 'rd'}.get(last, 'th') }"


#: Short, middling and tall women and men, as workplaces are checked for.
FAMILY = tuple(Person(sex, percentile) for percentile in (5, 50, 95) for sex in ("female", "male"))
