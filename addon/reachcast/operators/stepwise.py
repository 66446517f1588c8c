# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that do one thing after another: a button shows progress and can be stopped, a script gets all at once."""
from __future__ import annotations

from typing import Any

import bpy

from ..scene.steps import Progress, run_to_end
from .predict_motion import problem_of

_PAUSE_S = 0.01  #: between two steps, in which Blender draws and listens


class Stepwise:
    """Mixin for an operator with `steps(context)`, which gives the work as scene.steps.Steps, and `finish(context, found)`,
    which says what came of it. Esc keeps what is finished."""

    _timer: Any = None

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            found = run_to_end(self.steps(context))
        except (ValueError, RuntimeError) as error:
            return problem_of(self, context, error)
        return self._done(context, found)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        if bpy.app.background or context.window is None:
            return self.execute(context)
        self._steps, manager = self.steps(context), context.window_manager
        try:
            next(self._steps)  # reads and checks; nothing has been written yet
        except (ValueError, RuntimeError) as error:
            return problem_of(self, context, error)
        manager.progress_begin(0, 1000)
        self._timer = manager.event_timer_add(_PAUSE_S, window=context.window)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type not in {"ESC", "TIMER"}:
            return {"RUNNING_MODAL"}
        try:
            progress = self._steps.send(event.type == "ESC")
        except StopIteration as end:
            self._tidy(context)
            return self._done(context, end.value, "Stopped; " if event.type == "ESC" else "")
        except (ValueError, RuntimeError) as error:
            self._tidy(context)
            return problem_of(self, context, error)
        self._show(context, progress)
        return {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender ends the operator, as when its window is closed."""
        self._steps.close()
        self._tidy(context)

    def _show(self, context: bpy.types.Context, progress: Progress) -> None:
        context.window_manager.progress_update(1000 * progress.done // max(1, progress.total))
        context.workspace.status_text_set(f"{self.bl_label}: {progress.done} of {progress.total}. "
                                          f"Esc: stop here and keep what is finished")

    def _tidy(self, context: bpy.types.Context) -> None:
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        if context.workspace:
            context.workspace.status_text_set(None)

    def _done(self, context: bpy.types.Context, found: Any, how: str = "") -> set[str]:
        context.window_manager.reachcast_problem = ""
        self.report({"WARNING" if how or found.failed else "INFO"}, how + self.finish(context, found))
        return {"FINISHED"}
