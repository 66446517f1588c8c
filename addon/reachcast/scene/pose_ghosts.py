# SPDX-License-Identifier: GPL-3.0-or-later
"""Still copies of what a rig wears and of its box at chosen frames of its motion, as an onion skin."""
from __future__ import annotations

from collections.abc import Sequence

import bpy

from .ghosts import worn_by
from .transforms import layer_of

_MATERIAL, _COLOUR = "Reachcast Ghost", (0.35, 0.6, 0.9, 0.3)
MOST_GHOSTS = 100


def event_frames(action: bpy.types.Action) -> list[int]:
    """The scene frames of the events of a predicted Action; ValueError for any other."""
    if "reachcast_events" not in action:
        raise ValueError(f"Action '{action.name}' was not predicted by Reachcast; name the frames of the ghosts")
    return sorted({int(action[event]) for event in action["reachcast_events"].split(", ")})


def add_pose_ghosts(rig: bpy.types.Object, frames: Sequence[int], *, box: bpy.types.Object | None = None,
                    scene: bpy.types.Scene | None = None) -> str:
    """Meshes of what `rig` wears and of `box`, as shown at each frame, in a new collection, whose name is returned.

    They do not move and are not rendered; the current frame is put back. ValueError when there is nothing to copy.
    """
    wanted = list(dict.fromkeys(frames))
    if not 1 <= len(wanted) <= MOST_GHOSTS:
        raise ValueError(f"The ghosts are wanted at {len(wanted)} frames; it must be from 1 to {MOST_GHOSTS}")
    items = [*worn_by(rig), *([box] if box else [])]
    if not items:
        raise ValueError(f"Rig '{rig.name}' wears no mesh, so it has no ghost")
    scene = scene or bpy.context.scene
    layer, now = layer_of(scene), (scene.frame_current, scene.frame_subframe)
    collection = bpy.data.collections.new(f"Ghosts of {rig.name}")
    scene.collection.children.link(collection)
    try:
        for frame in wanted:
            scene.frame_set(frame)
            for item in items:
                _still(item, f"{item.name} at {frame}", collection, layer.depsgraph)
    finally:
        scene.frame_set(now[0], subframe=now[1])
    return collection.name


def _still(item: bpy.types.Object, name: str, collection: bpy.types.Collection, graph: bpy.types.Depsgraph) -> None:
    shown = item.evaluated_get(graph)
    mesh = bpy.data.meshes.new_from_object(shown, preserve_all_data_layers=False, depsgraph=graph)
    mesh.name = name
    mesh.materials.clear()
    mesh.materials.append(_material())
    copy = bpy.data.objects.new(name, mesh)
    copy.matrix_world = shown.matrix_world
    copy.hide_render = copy.hide_select = True
    collection.objects.link(copy)


def _material() -> bpy.types.Material:
    material = bpy.data.materials.get(_MATERIAL) or bpy.data.materials.new(_MATERIAL)
    material.diffuse_color = _COLOUR
    return material
