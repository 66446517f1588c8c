# SPDX-License-Identifier: GPL-3.0-or-later
"""What the undo test presses, the state of a file that undo must give back, and another add-on that listens meanwhile."""
from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import bpy
from reachcast.corpora import default_corpus
from reachcast.scene.action_writer import curves_of
from test_action import cuboid


@dataclass(frozen=True)
class Press:
    """A button: its operator's name, what it is called with, and what is done before, which is a step of its own."""

    operator: str
    options: dict[str, Any]
    before: Callable[[], object] = lambda: None

    def __str__(self) -> str:
        return f"{self.operator}({', '.join(f'{name}={value!r}' for name, value in self.options.items())})"


def in_window(number: int = 0) -> Any:
    """The context of a 3D view in one of Blender's windows."""
    window = bpy.context.window_manager.windows[number]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    region = next(region for region in area.regions if region.type == "WINDOW")
    return bpy.context.temp_override(window=window, screen=window.screen, area=area, region=region)


def furnish(scene: bpy.types.Scene | None = None) -> None:
    """A task for the panel: mannequin, box, two Empties; what else there was goes."""
    scene = scene or bpy.context.scene
    for item in list(scene.objects):
        bpy.data.objects.remove(item)
    bpy.data.batch_remove([action for action in bpy.data.actions if action.users == 0])
    scene.reachcast.rig = None
    bpy.ops.reachcast.add_mannequin(stature=1.72)
    settings = scene.reachcast
    for name, place in (("Shelf", (0.1, -0.42, 1.2)), ("Home", (0.0, -0.4, 0.9)), ("Other", (-0.1, -0.4, 1.0))):
        item = bpy.data.objects.new(name, None)
        item.location = place
        scene.collection.objects.link(item)
    objects = scene.collection.objects
    settings.shelf, settings.home = (next(item for item in objects if item.name.startswith(name))
                                     for name in ("Shelf", "Home"))
    settings.box = cuboid("Box", (0.36, 0.28, 0.24))
    settings.box.location = settings.home.location
    settings.corpus, settings.markers, settings.assets = "", True, True


def select_targets() -> None:
    for item in bpy.context.scene.objects:
        item.select_set(item.type == "EMPTY" and item.name.startswith(("Shelf", "Other")))


def setting(**values: Any) -> Callable[[], None]:
    def put() -> None:
        for name, value in values.items():
            setattr(bpy.context.scene.reachcast, name, value)
    return put


def presses(folder: Path) -> Iterator[Press]:
    """Every button that changes the file, each in the state that those before have left."""
    yield Press("add_mannequin", {"stature": 1.6})
    yield Press("choose_percentile", {"percentile": 95.0}, setting(sex="MALE"))
    yield Press("choose_corpus", {"path": os.fspath(default_corpus())}, setting(stature=0.0, sex="ANY"))
    yield Press("predict_motion", {})
    yield Press("predict_motion", {}, setting(strips=True, errand="REACH_LIFT_RETURN"))
    yield Press("edit_hand_path", {}, setting(strips=False, errand="LIFT"))
    yield Press("finish_hand_path", {})
    yield Press("follow_targets", {})
    yield Press("finish_hand_path", {})
    yield Press("play_motion", {}, lambda: bpy.ops.reachcast.list_motions())
    yield Press("edit_bone_map", {})
    yield Press("export_bone_map", {"filepath": os.fspath(folder / "map.json")})
    yield Press("save_bone_map", {"preset": "Undone"})
    yield Press("forget_bone_map", {})
    yield Press("import_bone_map", {"filepath": os.fspath(folder / "map.json")})
    yield Press("predict_variants", {}, setting(variants=2))
    yield Press("predict_targets", {}, select_targets)
    yield Press("pose_ghosts", {})
    yield Press("predict_variants", {}, setting(variants_as="GHOSTS"))
    yield Press("predict_family", {})
    yield Press("capture_motion", {}, setting(corpus=os.fspath(folder / "own.sqlite")))


def state() -> dict[str, Any]:
    """All of the file that Reachcast's buttons change, by value."""
    animated = [item for item in bpy.data.objects if item.animation_data]
    return {
        "objects": sorted((item.name, item.type, _rounded(item.matrix_basis), [c.name for c in item.constraints])
                          for item in bpy.data.objects),
        "actions": sorted((action.name, sum(len(curve.keyframe_points) for curve in curves_of(action)),
                           round(sum(curve.evaluate(20.0) for curve in curves_of(action)), 3), bool(action.asset_data))
                          for action in bpy.data.actions),
        "played": sorted((item.name, item.animation_data.action.name if item.animation_data.action else "",
                          [track.name for track in item.animation_data.nla_tracks]) for item in animated),
        "collections": sorted((group.name, len(group.objects)) for group in bpy.data.collections),
        "markers": sorted((marker.name, marker.frame) for scene in bpy.data.scenes for marker in scene.timeline_markers),
        "maps": {item.name: [(row.name, row.bone) for row in item.reachcast_bones] for item in bpy.data.objects
                 if item.type == "ARMATURE"},
        "settings": {scene.name: _settings(scene.reachcast) for scene in bpy.data.scenes},
        "data": {kind: sum(item.users > 0 for item in getattr(bpy.data, kind)) for kind in ("meshes", "curves", "armatures")},
        "texts": {text.name: text.as_string() for text in bpy.data.texts},
    }


def _settings(settings: bpy.types.PropertyGroup) -> dict[str, Any]:
    values = {name: getattr(settings, name) for name in settings.bl_rna.properties.keys() if name != "rna_type"}
    return {name: value.name if isinstance(value, bpy.types.ID) else value for name, value in values.items()}


def _rounded(matrix: Any) -> list[float]:
    return [round(value, 4) for row in matrix for value in row]


def difference(left: dict[str, Any], right: dict[str, Any]) -> str:
    """The parts that differ, shortened."""
    return "; ".join(f"{name}: {str(_only(left[name], right[name]))[:300]} became "
                     f"{str(_only(right[name], left[name]))[:300]}" for name in left if left[name] != right[name])


def _only(values: Any, others: Any) -> Any:
    if isinstance(values, list):
        return [value for value in values if value not in others]
    return {key: value for key, value in values.items() if others.get(key) != value}


class Listener:
    """Another add-on: it reads everything at every change and writes a property at every frame."""

    KINDS = ("depsgraph_update_post", "frame_change_pre", "frame_change_post", "undo_post", "redo_post", "load_post")

    def __init__(self) -> None:
        self.calls = dict.fromkeys(self.KINDS, 0)
        for kind in self.KINDS:
            getattr(bpy.app.handlers, kind).append(self._handler(kind))

    def _handler(self, kind: str) -> Callable[..., None]:
        @bpy.app.handlers.persistent
        def listen(*_arguments: object) -> None:
            self.calls[kind] += 1
            for item in bpy.data.objects:
                _ = item.matrix_world.translation, item.animation_data and item.animation_data.action
            if kind == "frame_change_post":
                bpy.context.scene["listener_frame"] = bpy.context.scene.frame_current
        return listen


class Console:
    """What Blender prints, from the process's own output; shown at the end."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._shown = [os.dup(number) for number in (1, 2)]
        self._file = os.open(path, os.O_CREAT | os.O_WRONLY | os.O_APPEND)
        for number in (1, 2):
            os.dup2(self._file, number)

    def give_back(self) -> str:
        """Prints again to where it did before; returns all that was printed meanwhile."""
        for number, shown in zip((1, 2), self._shown):
            os.dup2(shown, number)
        text = self.path.read_text(errors="replace")
        print(text, flush=True)
        return text
