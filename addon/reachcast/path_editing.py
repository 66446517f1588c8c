# SPDX-License-Identifier: GPL-3.0-or-later
"""The one session of path editing that runs in Blender's window, looked after by a timer while the mouse moves."""
from __future__ import annotations

import bpy

from .scene.path_session import PathSession, SessionEnded, end_session

LOOK_S = 1.0 / 60.0  #: between two looks at the curves
ASLEEP_S = 0.25      #: the same while the curves are undone

_session: PathSession | None = None
_is_asleep = False   #: its curves have been undone or deleted; they may come back by redo


def active() -> PathSession | None:
    """The session that is running. A timer does not outlive the file it was started in, nor does the session."""
    global _session
    if _session is not None and not bpy.app.timers.is_registered(_look):
        _session = None
    return None if _is_asleep else _session


def start(session: PathSession) -> None:
    """Runs this session and no other."""
    global _session
    stop()
    _session = session
    bpy.app.timers.register(_look, first_interval=LOOK_S)


def stop() -> None:
    """Ends the session that is running, if any, and takes its curves away."""
    session = active()
    forget()
    if session is not None:
        end_session(session)


def forget() -> None:
    """Ends without touching the scene: for a session whose objects are gone, and for the add-on that is disabled."""
    global _session, _is_asleep
    _session, _is_asleep = None, False
    if bpy.app.timers.is_registered(_look):
        bpy.app.timers.unregister(_look)


def _look() -> float | None:
    global _session, _is_asleep
    if _session is None:
        return None
    manager = bpy.context.window_manager
    try:
        changed = _session.update() or _is_asleep
        _is_asleep = False
        if not changed:
            return LOOK_S
        manager.reachcast_problem = ""
    except SessionEnded:  # undone or deleted by the user, who sees that
        if not _session.curves:
            _session = None
            return None
        if _is_asleep:
            return ASLEEP_S
        _is_asleep = True
    except ValueError as error:
        manager.reachcast_problem, _is_asleep = str(error), False
    for window in manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
    return LOOK_S
