# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens a real window on the Reachcast tab, predicts a lift and takes pictures of the panel before and after.

    xvfb-run -a -s "-screen 0 1280x800x24" blender --factory-startup --enable-event-simulate \\
        --window-geometry 0 0 1280 800 --python blender_tests/test_panel_window.py -- [--out DIR] [--corpus FILE]

Writes panel_missing.png (nothing chosen yet), panel_ready.png, panel_result.png and panel_problem.png, prints what it
saw and quits; exit status 1 when something is not as it should be. Without a corpus, the stand-in predictor is used.
"""
from __future__ import annotations

import argparse
import os
import sys
import tempfile
import traceback
from collections.abc import Callable, Iterator
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [os.fspath(HERE.parent / "addon"), os.fspath(HERE)]
sys.dont_write_bytecode = True

import addon_utils  # noqa: E402
import bpy  # noqa: E402

PAUSE_S = 0.4


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser()
    parser.add_argument("--out", type=Path, default=Path(tempfile.gettempdir()))
    parser.add_argument("--corpus", type=Path)
    parser.add_argument("--small", action="store_true", help="the path editing alone, in a view that is cheap to draw")
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])


def view_3d() -> tuple[bpy.types.Area, bpy.types.Region]:
    area = next(area for area in bpy.context.window_manager.windows[0].screen.areas if area.type == "VIEW_3D")
    return area, next(region for region in area.regions if region.type == "UI")


def open_tab() -> None:
    """Shows the sidebar and clicks on its tab; Python has no other way to choose one."""
    area, region = view_3d()
    window = bpy.context.window_manager.windows[0]
    scale = bpy.context.preferences.system.ui_scale
    place = (int(region.x + region.width - 11 * scale), int(region.y + region.height - 175 * scale))  # the fourth tab
    window.event_simulate(type="MOUSEMOVE", value="NOTHING", x=place[0], y=place[1])
    for value in ("PRESS", "RELEASE"):
        window.event_simulate(type="LEFTMOUSE", value=value, x=place[0], y=place[1])


def look_at_all() -> None:
    area, _ = view_3d()
    region = next(region for region in area.regions if region.type == "WINDOW")
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=area, region=region):
        bpy.ops.view3d.view_axis(type="LEFT")
        bpy.ops.view3d.view_all()


def furnish(corpus: Path | None) -> None:
    from test_action import cuboid
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()
    if corpus is None:
        from rig_cases import mannequin
        settings_rig = mannequin()
    else:
        bpy.ops.reachcast.add_mannequin()
        settings_rig = bpy.context.scene.reachcast.rig
    settings = bpy.context.scene.reachcast
    settings.rig = settings_rig
    for name, place in (("Shelf", (0.0, -0.4, 1.2)), ("Home", (0.0, -0.4, 0.95))):
        item = bpy.data.objects.new(name, None)
        item.location = place
        bpy.context.collection.objects.link(item)
    settings.shelf, settings.home = bpy.data.objects["Shelf"], bpy.data.objects["Home"]
    settings.box = cuboid("Box", (0.36, 0.28, 0.24))
    settings.box.location = settings.home.location
    settings.corpus = os.fspath(corpus or Path(__file__))
    for item in bpy.context.selected_objects:
        item.select_set(False)


def picture(path: Path) -> None:
    area, region = view_3d()
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=area, region=region):
        bpy.ops.screen.screenshot(filepath=os.fspath(path))
    print(f"saved {path}", flush=True)


def press() -> set[str]:
    area, region = view_3d()
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=area, region=region):
        return bpy.ops.reachcast.predict_motion()


def story(options: argparse.Namespace) -> Iterator[None]:
    """What happens, one step between two redraws."""
    settings = bpy.context.scene.reachcast
    view_3d()[0].spaces.active.show_region_ui = True
    yield
    open_tab()
    yield
    picture(options.out / "panel_missing.png")
    assert not bpy.ops.reachcast.predict_motion.poll(), "the button is on although nothing is chosen"
    furnish(options.corpus)
    look_at_all()
    yield
    picture(options.out / "panel_ready.png")
    assert press() == {"FINISHED"}, "the prediction failed"
    bpy.context.scene.frame_set(20)
    yield
    picture(options.out / "panel_result.png")
    settings.shelf.location.y = -3.0
    try:
        press()
    except RuntimeError:
        assert "reach" in bpy.context.window_manager.reachcast_problem, "no sentence about the reach"
    yield
    picture(options.out / "panel_problem.png")


def player(steps: Iterator[float | None]) -> Callable[[], float]:
    """A timer that takes one step after another; a step may yield how many seconds to wait, else PAUSE_S."""
    def advance() -> float:
        try:
            pause = next(steps)
        except StopIteration:
            print("1 passed, 0 failed, 0 skipped", flush=True)
            os._exit(0)  # a quit from a timer asks whether to save
        except BaseException:
            traceback.print_exc()
            print("0 passed, 1 failed, 0 skipped", flush=True)
            os._exit(1)
        return PAUSE_S if pause is None else pause
    return advance


def main() -> None:
    options = arguments()
    options.out.mkdir(parents=True, exist_ok=True)
    addon_utils.enable("reachcast")
    if options.corpus is None:
        import fake_core
        fake_core.installed().start()
    bpy.context.preferences.view.show_splash = False
    bpy.app.timers.register(player(story(options)), first_interval=1.0)


if __name__ == "__main__":
    main()
