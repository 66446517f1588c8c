# SPDX-License-Identifier: GPL-3.0-or-later
"""The installed zip in a real window: built, installed into a clean user folder, enabled, its buttons pressed, the
Empty dragged in live mode; pictures of every part of the panel.

    xvfb-run -a -s "-screen 0 1280x900x24" blender --factory-startup --enable-event-simulate \\
        --window-geometry 0 0 1280 800 --python blender_tests/test_installed_window.py -- [--out DIR]

Writes installed_task.png, installed_bones.png, installed_parts.png, installed_corpus.png, installed_result.png (the
sidebar as it is scrolled down), installed_live.png (the window in live mode) and installed_preferences.png; exit status
1 when something is not as it should be.
"""
from __future__ import annotations

import importlib.util
import os
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

HERE = Path(__file__).resolve().parent
ADDON = HERE.parent / "addon"
sys.path.insert(0, os.fspath(HERE))
sys.dont_write_bytecode = True

import addon_utils  # noqa: E402
import bpy  # noqa: E402
import numpy as np  # noqa: E402
from mathutils import Vector  # noqa: E402
from test_panel_window import arguments, look_at_all, open_tab, picture, player, view_3d  # noqa: E402

sys.path[:] = [path for path in sys.path if Path(path) != ADDON]  # the installed copy, not the source, is imported

STEP_PX, MOST_STEPS = 2, 25
LEAST_UPDATES, PATIENCE_S = 5, 120.0   #: of live mode; software OpenGL on a busy machine draws a few times a second
LANDED_M = 1e-3
SCROLL_PX = 40          #: what one turn of the wheel scrolls
BUTTON_PX = (95, 286)   #: from the sidebar's upper left corner to the middle of Predict Motion, at a scale of 1


def install(folder: Path) -> None:
    """Builds the zip and installs it where this Blender's user folder now is."""
    spec = importlib.util.spec_from_file_location("make_zip", ADDON / "make_zip.py")
    make_zip = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(make_zip)
    suffix = f"cpython-{sys.version_info[0]}{sys.version_info[1]}-"
    module = next(path for path in make_zip.PACKAGE.glob("reachcast_core.*.so") if suffix in path.name)
    bpy.ops.preferences.addon_install(filepath=os.fspath(make_zip.make_zip(module, folder)))
    from reachcast import registration
    for cls in registration.CLASSES:
        if issubclass(cls, bpy.types.Panel):
            cls.bl_options = set()  # all parts open, for the pictures
    bpy.ops.preferences.addon_enable(module="reachcast")
    import reachcast
    assert Path(reachcast.__file__).resolve().is_relative_to(folder.resolve()), reachcast.__file__


def sidebar() -> dict[str, object]:
    area, region = view_3d()
    window = bpy.context.window_manager.windows[0]
    return {"window": window, "screen": window.screen, "area": area, "region": region}


def view() -> dict[str, object]:
    area, _ = view_3d()
    return {**sidebar(), "region": next(region for region in area.regions if region.type == "WINDOW")}


def send(kind: str, value: str, place: tuple[int, int]) -> None:
    bpy.context.window_manager.windows[0].event_simulate(type=kind, value=value, x=int(place[0]), y=int(place[1]))


def click(place: tuple[int, int]) -> None:
    for kind, value in (("MOUSEMOVE", "NOTHING"), ("LEFTMOUSE", "PRESS"), ("LEFTMOUSE", "RELEASE")):
        send(kind, value, place)


def picture_of_sidebar(path: Path) -> None:
    """The sidebar alone."""
    picture(path)
    _, region = view_3d()
    whole = bpy.data.images.load(os.fspath(path))
    width, height = whole.size
    pixels = np.empty(width * height * 4, dtype=np.float32)
    whole.pixels.foreach_get(pixels)
    part = pixels.reshape(height, width, 4)[region.y:region.y + region.height, region.x:region.x + region.width]
    image = bpy.data.images.new("Sidebar", region.width, region.height)
    image.pixels.foreach_set(np.ascontiguousarray(part).ravel())
    image.filepath_raw, image.file_format = os.fspath(path), "PNG"
    image.save()
    for item in (whole, image):
        bpy.data.images.remove(item)


def scroll(pages: float) -> None:
    """Down, by parts of the sidebar's height."""
    with bpy.context.temp_override(**sidebar()):
        for _ in range(int(abs(pages) * view_3d()[1].height / SCROLL_PX)):
            (bpy.ops.view2d.scroll_down if pages > 0 else bpy.ops.view2d.scroll_up)()


def furnish() -> None:
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()
    bpy.ops.reachcast.add_mannequin(stature=1.72)
    settings = bpy.context.scene.reachcast
    for name, place in (("Shelf", (0.0, -0.42, 1.2)), ("Home", (0.0, -0.4, 0.85))):
        item = bpy.data.objects.new(name, None)
        item.location, item.empty_display_size = place, 0.1
        bpy.context.collection.objects.link(item)
        setattr(settings, name.lower(), item)
    bpy.ops.mesh.primitive_cube_add(size=0.3, location=(0.0, -0.4, 1.0))
    settings.box, settings.errand = bpy.context.object, "REACH_LIFT_RETURN"
    settings.box.name = "Box"


def landing() -> float:
    """Metres between the box and the shelf's mark in the evaluated scene, when it is placed."""
    settings, scene = bpy.context.scene.reachcast, bpy.context.scene
    frame, action = scene.frame_current, settings.rig.animation_data.action
    scene.frame_set(action["placed"])
    box = settings.box.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world.translation.copy()
    scene.frame_set(frame)
    return (box - settings.shelf.matrix_world.translation - Vector((0.0, 0.0, 0.15))).length


def drag_in_live_mode(options) -> Iterator[float]:  # type: ignore[no-untyped-def]
    from reachcast import path_editing
    settings = bpy.context.scene.reachcast
    with bpy.context.temp_override(**view()):
        bpy.ops.ed.undo_push(message="before live")
        assert bpy.ops.reachcast.follow_targets("INVOKE_DEFAULT", True) == {"FINISHED"}
        for item in bpy.context.selected_objects:
            item.select_set(False)
        settings.shelf.select_set(True)
        bpy.context.view_layer.objects.active = settings.shelf
        bpy.ops.ed.undo_push(message="select")
    session, before = path_editing.active(), settings.shelf.location.copy()
    bpy.context.scene.frame_set(settings.rig.animation_data.action["placed"])
    region = view()["region"]
    place = [region.x + region.width // 2, region.y + region.height // 2]
    send("MOUSEMOVE", "NOTHING", tuple(place))
    yield 0.2
    for value in ("PRESS", "RELEASE"):
        send("G", value, tuple(place))
    yield 0.2
    began, solves, moves = time.perf_counter(), session.solves, 0
    while session.solves < solves + LEAST_UPDATES and time.perf_counter() - began < PATIENCE_S:
        place[1] += STEP_PX if moves < MOST_STEPS else -STEP_PX if moves % 2 else STEP_PX
        moves += 1
        send("MOUSEMOVE", "NOTHING", tuple(place))
        yield 1.0 / 60.0
    print(f"live, in the window: {session.solves - solves} updates in {time.perf_counter() - began:.1f} s", flush=True)
    picture(options.out / "installed_live.png")
    assert session.solves >= solves + LEAST_UPDATES, f"{session.solves - solves} updates while the mouse moved"
    assert (settings.shelf.location - before).length > 0.01, "the drag moved nothing"
    send("LEFTMOUSE", "PRESS", tuple(place))
    send("LEFTMOUSE", "RELEASE", tuple(place))
    yield 0.5
    assert landing() < LANDED_M, f"{landing()} m off after the drag"
    with bpy.context.temp_override(**view()):
        bpy.ops.ed.undo()
    yield 0.5
    settings = bpy.context.scene.reachcast
    assert (settings.shelf.location - before).length < 1e-6, "one undo does not take the drag back"
    assert landing() < LANDED_M, f"{landing()} m off after undo"
    with bpy.context.temp_override(**view()):
        assert bpy.ops.reachcast.finish_hand_path("INVOKE_DEFAULT", True) == {"FINISHED"}


def story(options, folder: Path) -> Iterator[float | None]:  # type: ignore[no-untyped-def]
    install(folder)
    view_3d()[0].spaces.active.show_region_ui = True
    yield None
    open_tab()
    yield None
    with bpy.context.temp_override(**view()):
        furnish()
    look_at_all()
    yield None
    scale, (_, region) = bpy.context.preferences.system.ui_scale, view_3d()
    settings = bpy.context.scene.reachcast
    click((region.x + BUTTON_PX[0] * scale, region.y + region.height - BUTTON_PX[1] * scale))
    yield 1.0
    animation = settings.rig.animation_data
    picture_of_sidebar(options.out / "installed_task.png")
    assert animation is not None and animation.action is not None, "a click on Predict Motion predicts nothing"
    assert landing() < LANDED_M, f"{landing()} m off"
    with bpy.context.temp_override(**view()):
        assert bpy.ops.reachcast.list_motions("INVOKE_DEFAULT") == {"FINISHED"}
        assert bpy.ops.reachcast.edit_bone_map("INVOKE_DEFAULT", True) == {"FINISHED"}
        assert bpy.ops.reachcast.forget_bone_map("INVOKE_DEFAULT", True) == {"FINISHED"}
    for name in ("bones", "parts", "corpus", "result"):
        scroll(0.9)
        yield None
        picture_of_sidebar(options.out / f"installed_{name}.png")
    scroll(-10.0)
    yield from drag_in_live_mode(options)
    yield from preferences(options)


def preferences(options) -> Iterator[None]:  # type: ignore[no-untyped-def]
    from reachcast.preferences import of_addon
    bpy.ops.reachcast.add_corpus_folder(directory="/home/me/corpora")
    of_addon().stature, of_addon().units = 1.68, "CENTIMETRES"
    area = next(area for area in bpy.context.window_manager.windows[0].screen.areas if area.type == "VIEW_3D")
    area.type = "PREFERENCES"
    bpy.context.preferences.active_section = "ADDONS"
    bpy.data.window_managers[0].addon_search = "Reachcast"
    module = next(module for module in addon_utils.modules() if module.__name__ == "reachcast")
    addon_utils.module_bl_info(module)["show_expanded"] = True
    yield
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=area, region=area.regions[-1]):
        bpy.ops.screen.screenshot_area(filepath=os.fspath(options.out / "installed_preferences.png"))


def main() -> None:
    options = arguments()
    options.out.mkdir(parents=True, exist_ok=True)
    main.folder = tempfile.TemporaryDirectory()  # kept until the process ends
    folder = Path(main.folder.name)
    for kind in ("SCRIPTS", "CONFIG", "DATAFILES"):
        os.environ[f"BLENDER_USER_{kind}"] = os.fspath(folder)
    bpy.context.preferences.view.show_splash = False
    bpy.app.timers.register(player(story(options, folder)), first_interval=1.0)


if __name__ == "__main__":
    main()
