# SPDX-License-Identifier: GPL-3.0-or-later
"""Long work as a generator: it says how far it is before every step, and is told whether to stop there.

    steps = family_steps(rig, shelf)
    next(steps)             -> Progress(0, 6)
    steps.send(False)       -> Progress(1, 6), one member later
    steps.send(True)        raises StopIteration, whose value is the result of what was finished
"""
from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass
from typing import TypeVar, Union

Result = TypeVar("Result")


@dataclass(frozen=True)
class Progress:
    done: int
    total: int


Steps = Generator[Progress, Union[bool, None], Result]


def run_to_end(steps: Steps[Result]) -> Result:
    """The result of all steps, without stopping."""
    while True:
        try:
            next(steps)
        except StopIteration as end:
            return end.value
