# SPDX-License-Identifier: GPL-3.0-or-later
"""Every button in a real window, undone and redone 20 times, with another add-on's handlers running all the while;
saved and opened again; with two windows on two scenes; on a library override. Nothing may be printed that is an error.

    xvfb-run -a -s "-screen 0 1280x900x24" blender --factory-startup --enable-event-simulate \\
        --window-geometry 0 0 1280 800 --python blender_tests/test_undo_window.py -- [--out DIR]

Exit status 1 when something is not as it should be.
"""
from __future__ import annotations

import argparse
import os
import re
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [os.fspath(HERE.parent / "addon"), os.fspath(HERE)]
sys.dont_write_bytecode = True

import addon_utils  # noqa: E402
import bpy  # noqa: E402
from test_panel_window import arguments, player  # noqa: E402

TIMES = 20
SHOWN_EVERY = 10  #: so many times between two redraws, at which timers run too
SMALL_PX = (320, 240)  #: of the window: where OpenGL is software, drawing takes most of the time
ERRORS = re.compile(r"Traceback|Error:|ReferenceError|Segmentation|EXCEPTION|rna_uiItem|unknown property")


def back_and_forth(press, number: int = 0) -> Iterator[float]:  # type: ignore[no-untyped-def]
    """Presses in a window, then undoes and redoes TIMES times, comparing what the file holds."""
    from undo_cases import difference, in_window, state
    with in_window(number):
        press.before()
        bpy.ops.ed.undo_push(message=f"before {press}")
    yield 0.05
    before, began = state(), time.perf_counter()
    with in_window(number):
        assert getattr(bpy.ops.reachcast, press.operator)("EXEC_DEFAULT", True, **press.options) == {"FINISHED"}, press
    after = state()
    yield 0.05
    for turn in range(TIMES):
        for way, wanted in ((bpy.ops.ed.undo, before), (bpy.ops.ed.redo, after)):
            with in_window(number):
                assert way() == {"FINISHED"}, f"{press}: {way.idname()} {turn}"
            found = state()
            assert found == wanted, f"{press}, {way.idname()} {turn}: {difference(wanted, found)}"
            if turn % SHOWN_EVERY == 0:
                yield 0.05
    print(f"{press}: undone and redone {TIMES} times in {time.perf_counter() - began:.1f} s", flush=True)


def reopen(path: Path) -> Iterator[float]:
    from undo_cases import difference, in_window, state
    before = state()
    with in_window():
        bpy.ops.wm.save_as_mainfile(filepath=os.fspath(path))
        bpy.ops.wm.open_mainfile(filepath=os.fspath(path))
    yield 0.3
    after = state()
    assert before == after, f"saved and opened: {difference(before, after)}"


def every_button(folder: Path) -> Iterator[float]:
    from undo_cases import furnish, in_window, presses
    with in_window():
        furnish()
        bpy.ops.ed.undo_push(message="furnished")
    for number, press in enumerate(presses(folder)):
        yield from back_and_forth(press)
        if number % 5 == 4:
            yield from reopen(folder / "kept.blend")


def session_survives_undo() -> Iterator[float]:
    """A curve that is undone and comes back by redo is followed again."""
    from reachcast import path_editing
    from undo_cases import furnish, in_window
    with in_window():
        furnish()
        bpy.ops.ed.undo_push(message="furnished")
        bpy.ops.reachcast.edit_hand_path("EXEC_DEFAULT", True)
    yield 0.2
    session = path_editing.active()
    assert session is not None
    with in_window():
        bpy.ops.ed.undo()
    yield 0.5
    assert path_editing.active() is None, "a session without curves"
    with in_window():
        bpy.ops.ed.redo()
    yield 0.8
    assert path_editing.active() is session, "the curves came back, the session did not"
    solves = session.solves
    curve = bpy.data.objects[session.curves[0]]
    curve.data.splines[0].bezier_points[0].handle_right.z += 0.05
    yield 0.5
    assert session.solves > solves, "the body does not follow the curve that came back"
    with in_window():
        bpy.ops.reachcast.finish_hand_path("EXEC_DEFAULT", True)


def two_windows() -> Iterator[float]:
    """Two scenes with a task each, in two windows: pressing in one changes nothing in the other."""
    from undo_cases import Press, furnish, in_window
    manager = bpy.context.window_manager
    with in_window():
        bpy.ops.wm.window_new_main()
        other = bpy.data.scenes.new("Other Scene")
    manager.windows[-1].scene = other
    yield 0.3
    assert len(manager.windows) == 2
    for number in (0, 1):
        with in_window(number):
            furnish(bpy.context.scene)
    for number in (1, 0, 1):
        scenes = [window.scene for window in manager.windows]
        idle = scenes[1 - number].reachcast.rig.name
        kept = bpy.data.objects[idle].animation_data and bpy.data.objects[idle].animation_data.action.name
        yield from back_and_forth(Press("predict_motion", {}), number)
        now = bpy.data.objects[idle].animation_data and bpy.data.objects[idle].animation_data.action.name
        assert now == kept, f"{idle} has changed from {kept} to {now}"
        yield from back_and_forth(Press("follow_targets", {}), number)
    yield from back_and_forth(Press("predict_family", {}), 1)
    with in_window(1):
        bpy.ops.wm.window_close()
    yield 0.2


def overridden(folder: Path) -> Iterator[float]:
    """The rig comes from another file, as a library override; a rig that is only linked is refused in words."""
    from undo_cases import Press, furnish, in_window, setting
    library = folder / "library.blend"
    with in_window():
        furnish()
        rig = bpy.context.scene.reachcast.rig
        rig.name = "Linked"
        bpy.data.libraries.write(os.fspath(library), {rig})
        for item in [rig, *rig.children]:
            bpy.data.objects.remove(item)
        with bpy.data.libraries.load(os.fspath(library), link=True) as (_, into):
            into.objects = ["Linked"]
        linked = into.objects[0]
        bpy.context.scene.collection.objects.link(linked)
        bpy.context.scene.reachcast.rig = linked
        try:
            bpy.ops.reachcast.predict_motion()
        except RuntimeError as error:
            assert "library override" in str(error), error
        else:
            raise AssertionError("an Action was written on a linked rig")
        bpy.context.scene.reachcast.rig = linked.override_create(remap_local_usages=True)
    yield 0.1
    assert bpy.context.scene.reachcast.rig.override_library is not None
    for press in (Press("predict_motion", {}), Press("predict_motion", {}, setting(strips=True)),
                  Press("edit_hand_path", {}, setting(strips=False)), Press("edit_hand_path", {})):
        yield from back_and_forth(press)
        yield from reopen(folder / "override.blend")
    curves = [item.name for item in bpy.data.objects if item.type == "CURVE"]
    assert curves == ["Hand Path Transfer"], f"a file keeps {curves}"


def story(console, folder: Path) -> Iterator[float]:  # type: ignore[no-untyped-def]
    from undo_cases import Listener
    from test_path_window import resize_windows
    listener = Listener()
    bpy.context.preferences.system.viewport_aa = "OFF"
    resize_windows(*SMALL_PX)
    yield 0.2
    try:
        yield from every_button(folder)
        yield from session_survives_undo()
        yield from two_windows()
        yield from overridden(folder)
    finally:
        printed = console.give_back()
    assert all(listener.calls.values()), f"the other add-on was not called: {listener.calls}"
    wrong = [line for line in printed.splitlines() if ERRORS.search(line) and "library override" not in line]
    assert not wrong, f"printed: {wrong[:5]}"


def main() -> None:
    options: argparse.Namespace = arguments()
    options.out.mkdir(parents=True, exist_ok=True)
    main.folder = tempfile.TemporaryDirectory()  # kept until the process ends
    folder = Path(main.folder.name)
    os.environ["BLENDER_USER_SCRIPTS"] = os.fspath(folder)  # where the user's presets go
    addon_utils.enable("reachcast")
    bpy.context.preferences.view.show_splash = False
    bpy.context.preferences.edit.undo_steps = 128
    from undo_cases import Console
    steps = player(story(Console(folder / "console.txt"), folder))
    bpy.app.timers.register(steps, first_interval=1.0, persistent=True)


if __name__ == "__main__":
    main()
