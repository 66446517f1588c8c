# SPDX-License-Identifier: GPL-3.0-or-later
"""One unit, from its row to its folder."""
from __future__ import annotations

import errno
import shutil
import time
from pathlib import Path

import numpy as np

from ..rigs.joints import INDEX
from ..scene.predict_action import correction_in_words
from ..scene.prepare import Solved, solve
from .outputs import Work, write_outputs
from .stage import Stage
from .store import Store
from .tasks import Unit

Seconds = dict[str, float]   #: spent on each step: predict, write
_FEET = [INDEX[f"{side}_{joint}"] for side in ("left", "right") for joint in ("ball", "ankle")]


def work(store: Store, stage: Stage, unit: Unit, checksum: str) -> Seconds:
    """The unit's result is in `store` afterwards, also when it cannot be done or goes wrong, with the reason.

    DiskFull when the disk is; OSError when the result itself cannot be written.
    """
    began = predicted = time.perf_counter()
    draft, result = store.draft(unit), {"checksum": checksum}
    try:
        prepared, worker, load = stage.prepared(unit)
        solved = solve(prepared)
        predicted = time.perf_counter()
        files = write_outputs(Work(unit, prepared, worker, load, solved, stage.frame_rate, stage.actions),
                              draft)
        if empty := [name for name in files if not (draft / name).stat().st_size]:
            raise OSError(errno.ENOSPC if shutil.disk_usage(draft).free == 0 else errno.EIO, f"{empty[0]} is empty")
        result.update(_facts(solved, stage.frame_rate), status="done", files=" ".join(files))
    except ValueError as error:
        store.refuse_full()
        _empty(draft)
        result.update(status="refused", reason=str(error))
    except Exception as error:  # noqa: BLE001  whatever it is, the other tasks are not its victims
        store.refuse_full(error)
        _empty(draft)
        result.update(status="failed", reason=_reason(error))
    predicted = predicted if predicted > began else time.perf_counter()
    store.finish(unit, draft, result)
    return {"predict": predicted - began, "write": time.perf_counter() - predicted}


def _reason(error: Exception) -> str:
    """One line; what is no message of ours or Blender's is named by its kind."""
    said = " ".join(str(error).split())
    return said if said and isinstance(error, (OSError, RuntimeError)) else f"{type(error).__name__}: {said}"


def _facts(solved: Solved, rate: float) -> dict[str, object]:
    motion = solved.motion
    feet = solved.reached[:, _FEET]
    facts: dict[str, object] = {
        "foot_slip_mm": round(1000.0 * float(np.linalg.norm(feet - feet[0], axis=2).max()), 4),
        "duration_s": round((len(feet) - 1) / rate, 4),
        "durations": "; ".join(f"{phase} {(last - first) / rate:.3f}" for phase, first, last in motion.phases),
        "outside_data": "; ".join(map(str, motion.outside_reasons)) if motion.outside_data else "",
        "neighbours": " ".join(f"{near.id}:{near.weight:.3f}" for near in motion.neighbours),
        "corrections": "; ".join(map(correction_in_words, motion.corrections))}
    facts.update({f"{name}_error_mm": round(1000.0 * solved.errors[name], 4)
                  for name in ("landing", "grip") if name in solved.errors})
    return facts


def _empty(folder: Path) -> None:
    for item in list(folder.iterdir()):
        shutil.rmtree(item) if item.is_dir() else item.unlink()
