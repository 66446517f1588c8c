# SPDX-License-Identifier: GPL-3.0-or-later
"""Buttons that do several things in a real window: they go on step by step while Blender draws, Esc keeps what is
finished, and undo takes that back.

    xvfb-run -a -s "-screen 0 1280x900x24" blender --factory-startup --enable-event-simulate \\
        --window-geometry 0 0 1280 800 --python blender_tests/test_progress_window.py -- [--out DIR]

Writes progress.png, in which the status bar says how far it is; exit status 1 when something is not as it should be.
"""
from __future__ import annotations

import os
import sys
import time
from collections.abc import Iterator
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [os.fspath(HERE.parent / "addon"), os.fspath(HERE)]
sys.dont_write_bytecode = True

import addon_utils  # noqa: E402
import bpy  # noqa: E402
from test_panel_window import arguments, picture, player  # noqa: E402

PATIENCE_S = 60.0
MANY = 200  #: variants: more than are done before Esc


def press_escape() -> None:
    window = bpy.context.window_manager.windows[0]
    for value in ("PRESS", "RELEASE"):
        window.event_simulate(type="ESC", value=value)


def workers() -> int:
    """How many people of a family have their Action."""
    return sum(item.animation_data is not None for item in bpy.data.objects
               if item.type == "ARMATURE" and "percentile" in item.name)


def variants() -> int:
    return sum("variant" in action.name and action.name.startswith("Worker") for action in bpy.data.actions)


def wait_for(done, least: int) -> Iterator[float]:  # type: ignore[no-untyped-def]
    began = time.perf_counter()
    while done() < least:
        assert time.perf_counter() - began < PATIENCE_S, f"{done()} of {least} in {PATIENCE_S} s"
        yield 0.02


def invoke(operator) -> None:  # type: ignore[no-untyped-def]
    from undo_cases import in_window
    with in_window():
        bpy.ops.ed.undo_push(message="before")
        assert operator("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}


def stopped(operator, done, all_of_them: int, options, shown: bool) -> Iterator[float]:  # type: ignore[no-untyped-def]
    """Pressed, stopped after the second, undone."""
    from undo_cases import difference, in_window, state
    before = state()
    invoke(operator)
    yield from wait_for(done, 2)
    if shown:
        picture(options.out / "progress.png")
    press_escape()
    yield 1.0
    finished = done()
    assert 2 <= finished < all_of_them, f"{finished} of {all_of_them} after Esc"
    yield 0.5
    assert done() == finished, "it goes on after Esc"
    with in_window():
        bpy.ops.ed.undo()
    yield 0.2
    found = state()
    assert found == before, difference(before, found)
    print(f"{operator.idname()}: {finished} of {all_of_them} were finished and undone", flush=True)


def story(options) -> Iterator[float]:  # type: ignore[no-untyped-def]
    from undo_cases import furnish, in_window
    with in_window():
        furnish()
        bpy.ops.ed.undo_push(message="furnished")
    bpy.context.scene.reachcast.variants = MANY
    yield 0.3
    yield from stopped(bpy.ops.reachcast.predict_family, workers, 6, options, True)
    yield from stopped(bpy.ops.reachcast.predict_variants, variants, MANY, options, False)
    invoke(bpy.ops.reachcast.predict_family)
    yield from wait_for(workers, 6)
    yield 1.0
    assert workers() == 6
    bpy.context.scene.reachcast.shelf.location.z = 3.0
    with in_window():
        assert "out of reach" in refusal(bpy.ops.reachcast.predict_family)
    yield from wait_for(lambda: "out of reach" in bpy.context.window_manager.reachcast_problem, True)


def refusal(operator) -> str:  # type: ignore[no-untyped-def]
    """What is said of a shelf that nobody reaches, when a script presses."""
    try:
        operator("EXEC_DEFAULT", True)
    except RuntimeError as error:
        return str(error)
    return "nothing"


def main() -> None:
    options = arguments()
    options.out.mkdir(parents=True, exist_ok=True)
    addon_utils.enable("reachcast")
    bpy.context.preferences.view.show_splash = False
    bpy.app.timers.register(player(story(options)), first_interval=1.0)


if __name__ == "__main__":
    main()
