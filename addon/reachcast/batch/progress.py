# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a batch is: a line with rate and time left, every other second."""
from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Mapping

EVERY_S = 2.0


class Progress:
    """Counts units of all processes; `seconds` is what they spent on each step together."""

    def __init__(self, count: int, say: Callable[[str], None]) -> None:
        self.count, self.done, self.seconds = count, 0, Counter[str]()
        self._say = say
        self._began = self._said = time.perf_counter()

    def add(self, seconds: Mapping[str, float]) -> None:
        """One unit more. The clock starts with the first: how long Blender takes to start says nothing of the rest."""
        now = time.perf_counter()
        if not self.done:
            self._began = now - max(sum(seconds.values()), 1e-3)
        self.done += 1
        self.seconds.update(seconds)
        if now - self._said >= EVERY_S or self.done == self.count:
            self._said = now
            rate = self.done / (now - self._began)
            self._say(f"{self.done} of {self.count}, {rate:.1f} a second, {(self.count - self.done) / rate:.0f} s left")

    def note(self, line: str) -> None:
        self._say(line)
