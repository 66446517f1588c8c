# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens a real window, edits a hand path with the mouse and draws variants; takes pictures of both.

    xvfb-run -a -s "-screen 0 1280x800x24" blender --factory-startup --enable-event-simulate \\
        --window-geometry 0 0 1280 800 --python blender_tests/test_path_window.py -- --corpus FILE [--out DIR]

In Edit Mode a handle is grabbed (G) and dragged; the body must follow while the mouse moves. Writes path_before.png,
path_dragged.png and variants.png, prints how often the body was solved, and quits; exit status 1 when something is not
as it should be. Where OpenGL is software, drawing the window takes most of the time: --small makes the window small and leaves
the 3D view alone in it, cheap to draw: to measure and not to look at.
"""
from __future__ import annotations

import ctypes
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
from mathutils import Vector  # noqa: E402
from test_panel_window import arguments, furnish, open_tab, picture, player, view_3d  # noqa: E402

DRAG_S = 2.0
STEP_PX = 2
SMALL_PX = (240, 180)  #: Blender opens no window below 640 x 480, but takes any size that the display gives it


def in_view() -> dict[str, object]:
    area, _ = view_3d()
    region = next(region for region in area.regions if region.type == "WINDOW")
    return {"window": bpy.context.window_manager.windows[0], "area": area, "region": region}


def send(kind: str, value: str, place: tuple[int, int]) -> None:
    bpy.context.window_manager.windows[0].event_simulate(type=kind, value=value, x=place[0], y=place[1])


def look_from_the_side() -> None:
    area, _ = view_3d()
    area.spaces.active.shading.type = "SOLID"
    area.spaces.active.shading.color_type = "OBJECT"
    with bpy.context.temp_override(**in_view()):
        bpy.ops.view3d.view_axis(type="LEFT")
        bpy.ops.view3d.view_all()


def resize_windows(width: int, height: int) -> None:
    """All windows of this display: under xvfb-run there is none but Blender's."""
    x11 = ctypes.CDLL("libX11.so.6")
    x11.XOpenDisplay.restype, x11.XDefaultRootWindow.restype = ctypes.c_void_p, ctypes.c_ulong
    display = ctypes.c_void_p(x11.XOpenDisplay(None))
    root = ctypes.c_ulong(x11.XDefaultRootWindow(display))
    children, count, unused = ctypes.POINTER(ctypes.c_ulong)(), ctypes.c_uint(), ctypes.c_ulong()
    x11.XQueryTree(display, root, ctypes.byref(unused), ctypes.byref(unused), ctypes.byref(children), ctypes.byref(count))
    for window in children[:count.value]:
        x11.XResizeWindow(display, ctypes.c_ulong(window), ctypes.c_uint(width), ctypes.c_uint(height))
    x11.XCloseDisplay(display)


def view_alone() -> Iterator[None]:
    """The 3D view alone in a small window and as cheap to draw as it gets: what is left is the path editing."""
    bpy.context.preferences.system.viewport_aa = "OFF"
    resize_windows(*SMALL_PX)
    yield
    with bpy.context.temp_override(**in_view()):
        bpy.ops.screen.screen_full_area(use_hide_panels=True)
    yield
    space = view_3d()[0].spaces.active
    space.shading.light, space.shading.color_type, space.shading.show_backface_culling = "FLAT", "SINGLE", True
    space.overlay.show_overlays = space.shading.show_object_outline = space.show_gizmo = False
    space.show_region_ui = space.show_region_toolbar = space.show_region_header = space.show_region_tool_header = False
    yield
    region = in_view()["region"]
    assert (region.width, region.height) == SMALL_PX, f"the 3D view has {region.width} x {region.height} pixels"


def story(options) -> Iterator[None]:  # type: ignore[no-untyped-def]
    from reachcast import path_editing
    view_3d()[0].spaces.active.show_region_ui = True
    yield
    open_tab()
    furnish(options.corpus)
    look_from_the_side()
    yield
    with bpy.context.temp_override(**in_view()):
        assert bpy.ops.reachcast.edit_hand_path() == {"FINISHED"}
    bpy.context.scene.frame_set(22)
    session = path_editing.active()
    assert session is not None
    yield
    picture(options.out / "path_before.png")
    curve = bpy.data.objects[session.curves[0]]
    before = Vector(curve.data.splines[0].bezier_points[0].handle_right)
    with bpy.context.temp_override(**in_view()):
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.curve.select_all(action="DESELECT")
        curve.data.splines[0].bezier_points[0].select_right_handle = True
    yield
    if options.small:
        yield from view_alone()
    with bpy.context.temp_override(**in_view()):
        began = time.perf_counter()
        bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=10)
        print(f"the window alone can be drawn {10.0 / (time.perf_counter() - began):.0f} times a second", flush=True)
    region = in_view()["region"]
    place = [region.x + region.width // 2, region.y + region.height // 2]
    send("MOUSEMOVE", "NOTHING", tuple(place))
    yield
    send("G", "PRESS", tuple(place))
    send("G", "RELEASE", tuple(place))
    yield
    began, solves = time.perf_counter(), session.solves
    while time.perf_counter() - began < DRAG_S:
        place[0], place[1] = place[0] - STEP_PX, place[1] + STEP_PX
        if place[0] < region.x + 20 or place[1] > region.y + region.height - 20:
            place = [region.x + region.width // 2, region.y + region.height // 2]
        send("MOUSEMOVE", "NOTHING", tuple(place))
        yield 1.0 / 60.0
    seconds = time.perf_counter() - began
    rate = (session.solves - solves) / seconds
    print(f"hand path in a window: {rate:.0f} updates a second while the mouse moved", flush=True)
    picture(options.out / "path_dragged.png")
    send("LEFTMOUSE", "PRESS", tuple(place))
    send("LEFTMOUSE", "RELEASE", tuple(place))
    yield
    assert (Vector(curve.data.splines[0].bezier_points[0].handle_right) - before).length > 0.02, "the drag moved nothing"
    assert session.solves > solves, "the body did not follow while the mouse moved"
    with bpy.context.temp_override(**in_view()):
        assert bpy.ops.reachcast.finish_hand_path() == {"FINISHED"}
    assert session.result.action in bpy.data.actions
    settings = bpy.context.scene.reachcast
    settings.variants, settings.variants_as, settings.spacing = 3, "GHOSTS", 1.0
    bpy.context.scene.frame_set(1)
    with bpy.context.temp_override(**in_view()):
        assert bpy.ops.reachcast.predict_variants() == {"FINISHED"}
        bpy.context.scene.frame_set(22)
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_all()
    yield
    picture(options.out / "variants.png")


def main() -> None:
    options = arguments()
    options.out.mkdir(parents=True, exist_ok=True)
    if options.corpus is None:
        print("skipped: give a corpus (--corpus FILE)\n0 passed, 0 failed, 1 skipped", flush=True)
        os._exit(0)
    addon_utils.enable("reachcast")
    bpy.context.preferences.view.show_splash = False
    bpy.app.timers.register(player(story(options)), first_interval=1.0)


if __name__ == "__main__":
    main()
