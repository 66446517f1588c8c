# SPDX-License-Identifier: GPL-3.0-or-later
"""The one session of path editing that runs in Blender's window, looked after by a timer while the mouse moves."""
from __future__ import annotations

import bpy

from .scene.path_session import PathSession, SessionEnded, end_session

LOOK_S = 1.0 / 60.0  #: between two looks at the curves

_session: PathSession | None = None


def active() -> PathSession | None:
    """The session that is running. A timer does not outlive the file it was started in, nor does the session."""
    global _session
    if _session is not None and not bpy.app.timers.is_registered(_look):
        _session = None
    return _session


def start(session: PathSession) -> None:
    """Runs this session and no other."""
    global _session
    stop()
    _session = session
    bpy.app.timers.register(_look, first_interval=LOOK_S)


def stop() -> None:
    """Ends the session that is running, if any, and takes its curves away."""
    global _session
    session, _session = active(), None
    if bpy.app.timers.is_registered(_look):
        bpy.app.timers.unregister(_look)
    if session is not None:
        end_session(session)


def forget() -> None:
    """Ends without touching the scene: for a session whose objects are gone, and for the add-on that is disabled."""
    global _session
    _session = None
    if bpy.app.timers.is_registered(_look):
        bpy.app.timers.unregister(_look)


def _look() -> float | None:
    global _session
    if _session is None:
        return None
    manager = bpy.context.window_manager
    try:
        if not _session.update():
            return LOOK_S
        manager.reachcast_problem = ""
    except SessionEnded:  # undone or deleted by the user, who sees that
        _session = None
    except ValueError as error:
        manager.reachcast_problem = str(error)
    for window in manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
    return LOOK_S if _session is not None else None
