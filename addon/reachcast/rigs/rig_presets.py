# SPDX-License-Identifier: GPL-3.0-or-later
"""Bone maps as data: presets of ours and JSON files of the user's, and which of them fits a rig.

    {"name": "My rig",
     "segments": {"pelvis": "Hips", "spine": ["LowerBack", "Spine"], ..., "hand.L": "LeftHand"},
     "prefix": "mixamorig[0-9]*:",                              (optional)
     "grips": {"L": {"bone": "LeftPalm", "along": 0.5}},        (optional; 0 = the bone's head, 1 = its tail)
     "controls": "rigify"}                                      (optional; keys go to the controls of such a rig)

A segment has one name or several to choose from, of which the first that the rig has is taken. `prefix` is a regular
expression for what may stand before every name, such as a namespace; upper and lower case are alike.
"""
from __future__ import annotations

import json
import re
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from .bone_map import PARENTS, BoneMap, GripPlace

CONTROLS = ("", "rigify")
PRESETS_FOLDER = Path(__file__).parent / "presets"


@dataclass(frozen=True)
class RigPreset:
    """`choices` maps a segment (a key of PARENTS) to the names that its bone may have, best first."""

    name: str
    choices: Mapping[str, tuple[str, ...]]
    prefix: str = ""
    grips: Mapping[str, GripPlace] = field(default_factory=dict)
    controls: str = ""

    def on(self, bones: Collection[str]) -> BoneMap:
        """The map with the names that these bones have; a segment whose bone is not there keeps its first choice."""
        return max((self._with(start, bones) for start in self._starts(bones)),
                   key=lambda found: sum(bone in bones for bone in found.segments.values()))

    def _starts(self, bones: Iterable[str]) -> list[str]:
        """What stands before names, each once, none first."""
        if not self.prefix:
            return [""]
        found = (re.match(self.prefix, bone, re.IGNORECASE) for bone in bones)
        return list(dict.fromkeys(["", *(match.group() for match in found if match)]))

    def _with(self, start: str, bones: Collection[str]) -> BoneMap:
        known = {bone.lower(): bone for bone in bones}

        def bone_of(names: tuple[str, ...]) -> str:
            here = (known.get((start + name).lower()) for name in names)
            return next((bone for bone in here if bone is not None), start + names[0])

        grips = {side: GripPlace(bone_of((grip.bone,)), grip.along) for side, grip in self.grips.items()}
        return BoneMap(self.name, {segment: bone_of(names) for segment, names in self.choices.items()}, grips,
                       self.controls)


def parse_preset(text: str, source: str) -> RigPreset:
    """A preset from JSON; ValueError says what in `source` is wrong."""
    try:
        data = json.loads(text)
    except json.JSONDecodeError as error:
        raise ValueError(f"Bone map '{source}' is not JSON: line {error.lineno}: {error.msg}") from error
    segments = data.get("segments") if isinstance(data, dict) else None
    if not isinstance(segments, dict):
        raise ValueError(f"Bone map '{source}' needs an object 'segments' of segment names and bone names")
    if unknown := [name for name in segments if name not in PARENTS]:
        raise ValueError(f"Bone map '{source}' names unknown segments: {', '.join(unknown)}; "
                         f"known are {', '.join(PARENTS)}")
    choices = {segment: _parse_names(names, segment, source) for segment, names in segments.items()}
    return RigPreset(str(data.get("name", source)), choices, _parse_prefix(data.get("prefix", ""), source),
                     _parse_grips(data.get("grips", {}), source), _parse_controls(data.get("controls", ""), source))


def _parse_names(names: object, segment: str, source: str) -> tuple[str, ...]:
    listed = [names] if isinstance(names, str) else names
    if not isinstance(listed, list) or not listed or not all(isinstance(name, str) and name for name in listed):
        raise ValueError(f"Bone map '{source}': the bone of {segment} is {names!r}; it must be a name or a "
                         f"list of names")
    return tuple(listed)


def _parse_prefix(prefix: object, source: str) -> str:
    try:
        re.compile(prefix)  # type: ignore[arg-type, call-overload]
    except (TypeError, re.error) as error:
        raise ValueError(f"Bone map '{source}': prefix {prefix!r} is no regular expression: {error}") from error
    return str(prefix)


def _parse_grips(data: object, source: str) -> dict[str, GripPlace]:
    if not isinstance(data, dict) or not set(data) <= {"L", "R"}:
        raise ValueError(f"Bone map '{source}': 'grips' must be an object with the keys L and R")
    grips = {}
    for side, grip in data.items():
        if not isinstance(grip, dict) or not isinstance(grip.get("bone"), str):
            raise ValueError(f"Bone map '{source}': grips.{side} needs a 'bone'")
        along = grip.get("along", 1.0)
        if isinstance(along, bool) or not isinstance(along, (int, float)) or not 0.0 <= along <= 1.0:
            raise ValueError(f"Bone map '{source}': grips.{side}.along is {along!r}; it must be from 0 to 1")
        grips[side] = GripPlace(grip["bone"], float(along))
    return grips


def _parse_controls(controls: object, source: str) -> str:
    if controls not in CONTROLS:
        raise ValueError(f"Bone map '{source}': controls is {controls!r}; it must be 'rigify' or be left out")
    return str(controls)


def load_preset(path: str | Path) -> RigPreset:
    path = Path(path)
    try:
        return parse_preset(path.read_text(encoding="utf-8"), path.name)
    except (OSError, UnicodeDecodeError) as error:
        raise ValueError(f"Bone map '{path}' cannot be read: {error}") from error


def preset_text(bone_map: BoneMap) -> str:
    """A map as the JSON that `parse_preset` reads."""
    data: dict[str, object] = {"name": bone_map.name, "segments": dict(bone_map.segments)}
    if bone_map.controls:
        data["controls"] = bone_map.controls
    if bone_map.grips:
        data["grips"] = {side: {"bone": grip.bone, "along": grip.along} for side, grip in bone_map.grips.items()}
    return json.dumps(data, indent=2, ensure_ascii=False) + "\n"


_presets: dict[str, RigPreset] = {}


def presets() -> list[RigPreset]:
    """The presets that ship with the add-on, read once."""
    if not _presets:
        _presets.update((path.stem, load_preset(path)) for path in sorted(PRESETS_FOLDER.glob("*.json")))
    return list(_presets.values())


def known_part(bones: Collection[str]) -> float:
    """The largest part of a preset's segments whose bones are there by name, 0 to 1."""
    names = frozenset(bones)
    maps = [preset.on(names).segments for preset in presets()]
    return max(sum(bone in names for bone in found.values()) / len(found) for found in maps)


def closest(bones: Collection[str], own: Iterable[RigPreset] = ()) -> BoneMap:
    """The map that lacks least of these bones, which need not fit."""
    names = frozenset(bones)
    maps = [preset.on(names) for preset in (*own, *presets())]
    return min(maps, key=lambda found: (len(found.gaps(names)), -len(names & set(found.segments.values()))))


def detect(bones: Collection[str], rig: str, own: Iterable[RigPreset] = ()) -> BoneMap:
    """The map that fits these bones, the user's own presets first; ValueError lists what the closest one lacks."""
    names = frozenset(bones)
    return closest(names, own).fitted(names, rig)
