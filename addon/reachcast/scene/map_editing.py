# SPDX-License-Identifier: GPL-3.0-or-later
"""A rig's own bone map, edited by hand and kept on the armature object, and the user's folder of presets."""
from __future__ import annotations

import functools
import re
from dataclasses import replace
from pathlib import Path

import bpy

from ..rigs.bone_map import OPTIONAL, PARENTS, BoneMap
from ..rigs.rig_presets import RigPreset, closest, load_preset, parse_preset, preset_text

FOLDER = ("reachcast", "rigs")    #: below Blender's own folder for presets


class SegmentBone(bpy.types.PropertyGroup):
    """`name` is a segment (a key of PARENTS); an empty bone means that there is none."""

    bone: bpy.props.StringProperty(name="Bone", description="The bone that is this part of the body")


def edited_map(rig: bpy.types.Object) -> BoneMap | None:
    """The map that was edited on this rig, None when there is none."""
    rows = getattr(rig, "reachcast_bones", ())
    if not rows:
        return None
    base = parse_preset(rig.reachcast_map, rig.name).on([bone.name for bone in rig.data.bones])
    return replace(base, segments={row.name: row.bone for row in rows if row.bone})


def edit_map(rig: bpy.types.Object, found: BoneMap) -> None:
    """Puts a map on the rig to be edited; from then on it is the one that counts."""
    rig.reachcast_map = preset_text(found)
    rig.reachcast_bones.clear()
    names = {bone.name for bone in rig.data.bones}
    for segment in PARENTS:
        row = rig.reachcast_bones.add()
        row.name, bone = segment, found.segments.get(segment, "")
        row.bone = bone if bone in names else ""


def start_editing(rig: bpy.types.Object, recognised: BoneMap | None) -> None:
    """Begins with the recognised map, else with the closest preset, whose missing bones are then empty."""
    edit_map(rig, recognised or closest([bone.name for bone in rig.data.bones], user_presets()))


def forget_map(rig: bpy.types.Object) -> None:
    """The rig's bones are recognised by themselves again."""
    rig.reachcast_bones.clear()
    rig.reachcast_map = ""


def lacking(rig: bpy.types.Object) -> list[str]:
    """Segments of the edited map that have no bone although they need one."""
    names = rig.data.bones
    return [row.name for row in rig.reachcast_bones
            if (row.bone not in names if row.bone else row.name not in OPTIONAL)]


def preset_folder(create: bool = False) -> Path | None:
    """Where the user's presets are; None when there is no such folder yet."""
    folder = bpy.utils.user_resource("SCRIPTS", path="/".join(("presets", *FOLDER)), create=create)
    return Path(folder) if folder and Path(folder).is_dir() else None


def user_presets() -> list[RigPreset]:
    """The user's presets by file name. A file that is none is left out here, and the console says why, once."""
    folder = preset_folder()
    read = (_read(path, path.stat().st_mtime_ns) for path in sorted(folder.glob("*.json") if folder else ()))
    return [preset for preset in read if preset is not None]


@functools.lru_cache(maxsize=256)
def _read(path: Path, _changed_ns: int) -> RigPreset | None:
    """Panels ask at every redraw; a file is read again when it has changed."""
    try:
        return load_preset(path)
    except ValueError as error:
        print(f"Reachcast: {error}")
        return None


def save_preset(rig: bpy.types.Object, name: str) -> Path:
    """The rig's edited map in the user's folder, recognised on other rigs from now on."""
    name = name.strip()
    stem = re.sub(r"[^\w.-]+", "_", name).strip("._")
    if not stem:
        raise ValueError(f"The preset's name is {name!r}; it needs a letter or a digit")
    folder = preset_folder(create=True)
    if folder is None:
        raise ValueError("Blender has no folder for the user's presets, so the bone map cannot be saved; export it")
    return export_map(rig, folder / f"{stem}.json", name)


def export_map(rig: bpy.types.Object, path: str | Path, name: str | None = None) -> Path:
    """The rig's edited map as a JSON file. ValueError when there is none, it has gaps or the file cannot be written."""
    found, path = edited_map(rig), Path(path)
    if found is None:
        raise ValueError(f"Rig '{rig.name}' has no edited bone map; press Edit Bone Map first")
    found = found.fitted({bone.name for bone in rig.data.bones}, rig.name)
    try:
        path.write_text(preset_text(replace(found, name=name or found.name)), encoding="utf-8")
    except OSError as error:
        raise ValueError(f"Bone map '{path}' cannot be written: {error}") from error
    return path


def import_map(rig: bpy.types.Object, path: str | Path) -> None:
    """A JSON preset onto the rig, to be edited; ValueError says what is wrong with the file."""
    edit_map(rig, load_preset(path).on([bone.name for bone in rig.data.bones]))
