# SPDX-License-Identifier: GPL-3.0-or-later
"""Run by test_zip.py inside Blender, in a clean user folder: installs the zip and does a lift with the installed copy.

    blender -b --factory-startup --python-exit-code 1 --python installed_checks.py -- ZIP [CORPUS]
"""
from __future__ import annotations

import os
import sys

import bpy

ROUNDS = 5


def main() -> None:
    archive, *corpus = sys.argv[sys.argv.index("--") + 1:]
    bpy.ops.preferences.addon_install(filepath=archive)
    before = known()
    for _ in range(ROUNDS):
        bpy.ops.preferences.addon_enable(module="reachcast")
        assert hasattr(bpy.types.Scene, "reachcast")
        bpy.ops.preferences.addon_disable(module="reachcast")
        assert known() == before, f"left behind: {sorted(known() ^ before)}"
    bpy.ops.preferences.addon_enable(module="reachcast")
    import reachcast
    folder = os.path.dirname(os.path.realpath(reachcast.__file__))
    scripts = os.path.realpath(os.environ["BLENDER_USER_SCRIPTS"])
    assert folder.startswith(scripts), f"{folder} is not the installed copy"
    assert {"LICENSE", "blender_manifest.toml"} <= set(os.listdir(folder))
    if corpus:
        lift(corpus[0])
    print("installed copy works", flush=True)


def known() -> set[str]:
    """All that an add-on may leave behind: classes, properties, handlers and menu entries."""
    names = {name for name in dir(bpy.types) if "REACHCAST" in name.upper()}
    names |= {f"{owner.__name__}.{name}" for owner in (bpy.types.Scene, bpy.types.WindowManager) for name in dir(owner)
              if "reachcast" in name}
    names |= {f"{name}:{handler}" for name in dir(bpy.app.handlers) for handler in
              (getattr(bpy.app.handlers, name) if isinstance(getattr(bpy.app.handlers, name), list) else ())
              if "reachcast" in getattr(handler, "__module__", "")}
    entries = getattr(bpy.types.VIEW3D_MT_armature_add.draw, "_draw_funcs", [])
    return names | {f"menu:{entry.__name__}" for entry in entries if "reachcast" in entry.__module__}


def lift(corpus: str) -> None:
    from mathutils import Vector
    bpy.ops.reachcast.add_mannequin(stature=1.7)
    settings = bpy.context.scene.reachcast
    for name, place in (("home", (0.0, -0.4, 0.8)), ("shelf", (0.1, -0.5, 1.2))):
        item = bpy.data.objects.new(name, None)
        bpy.context.collection.objects.link(item)
        item.location = place
        setattr(settings, name, item)
    bpy.ops.mesh.primitive_cube_add(size=0.3, location=(0.0, -0.4, 0.95))
    settings.box, settings.corpus = bpy.context.object, corpus
    assert bpy.ops.reachcast.predict_motion() == {"FINISHED"}
    action = settings.rig.animation_data.action
    bpy.context.scene.frame_set(action["placed"])
    placed = settings.box.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world.translation
    off = (placed - Vector((0.1, -0.5, 1.35))).length
    assert off < 1e-3, f"the box is {off} m off"


main()
