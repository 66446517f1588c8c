# SPDX-License-Identifier: GPL-3.0-or-later
"""How wrong predictions were in the neighbourhood of a task: every transfer of a corpus, predicted from other people.

That takes about a second for ten thousand motions, so a thread does it once for every state of a corpus file.
"""
from __future__ import annotations

import math
import os
import threading
from collections.abc import Mapping
from dataclasses import dataclass

import bpy

from . import native

MOST_TRANSFERS = 20_000  #: every one is compared with all others: a larger corpus is not looked at unasked
_LOOK_S = 0.25


@dataclass(frozen=True)
class LeftOut:
    """`errors`: id of a transfer -> metres, mirror images as their originals; empty for the reason `why`."""

    errors: Mapping[int, float]
    what: str            #: that was left out: "people", or "motions" where all are one person's
    why: str = ""


_State = tuple[str, int, int, int]  #: path, inode, size, time of change
_known: dict[_State, LeftOut] = {}
_running: set[_State] = set()


def compute(path: str) -> LeftOut:
    """Cross-validation of the default scheme. ValueError or RuntimeError of the native module for a bad file."""
    core = native.core()
    with core.Corpus.open(path) as corpus:
        transfers = [motion for motion in corpus.motions() if motion.phase == "transfer" and motion.hands == "both"]
        if len(transfers) > MOST_TRANSFERS:
            return LeftOut({}, "people", f"{len(transfers)} transfers are more than {MOST_TRANSFERS}")
        what = "people" if len({motion.subject_id for motion in transfers}) > 1 else "motions"
        found = core.left_out_errors(corpus, {}, "subject" if what == "people" else "motion")
        origins = {motion.origin: found[motion.id] for motion in transfers if motion.id in found}
    return LeftOut({motion.id: origins[motion.origin] for motion in transfers if motion.origin in origins}, what)


def expected_error(neighbours: Mapping[int, float], left_out: LeftOut) -> float | None:
    """Metres: the mean of the errors that these neighbours (id -> weight) had when they were left out."""
    known = [(weight, left_out.errors[number]) for number, weight in neighbours.items()
             if math.isfinite(left_out.errors.get(number, math.inf))]
    total = sum(weight for weight, _ in known)
    return sum(weight * error for weight, error in known) / total if total > 0.0 else None


def known(path: str) -> LeftOut | None:
    """What is known of a corpus; None while a thread is at it, which has the view drawn again, and without a file."""
    try:
        status = os.stat(path)
    except OSError:
        return None
    state = (path, status.st_ino, status.st_size, status.st_mtime_ns)
    if state not in _known and state not in _running:
        _running.add(state)
        threading.Thread(target=_work, args=(state,)).start()  # no daemon: Blender waits for it when it quits
        if not bpy.app.timers.is_registered(_redraw):
            bpy.app.timers.register(_redraw, first_interval=_LOOK_S)
    return _known.get(state)


def forget() -> None:
    """For the add-on that is disabled."""
    _known.clear()
    if bpy.app.timers.is_registered(_redraw):
        bpy.app.timers.unregister(_redraw)


def _work(state: _State) -> None:
    try:
        found = compute(state[0])
    except (ValueError, RuntimeError) as error:
        found = LeftOut({}, "people", str(error))
    _known[state] = found
    _running.discard(state)


def _redraw() -> float | None:
    if _running:
        return _LOOK_S
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
    return None
