# SPDX-License-Identifier: GPL-3.0-or-later
"""Which bone of a rig is which segment of a body. A map is data: a preset of ours or a JSON file of the user's.

    {"name": "My rig",
     "segments": {"pelvis": "Hips", "spine": "Spine", ..., "hand.L": "LeftHand"},
     "grips": {"L": {"bone": "LeftPalm", "along": 0.5}}}        (optional; 0 = the bone's head, 1 = its tail)
"""
from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType

#: Each segment and the segments that may be its nearest mapped ancestor. The order is parents first.
PARENTS: Mapping[str, tuple[str, ...]] = MappingProxyType({
    "pelvis": (), "spine": ("pelvis",), "chest": ("spine",), "neck": ("chest", "spine"), "head": ("neck",),
    **{f"{name}.{side}": tuple(f"{parent}.{side}" if parent not in ("chest", "spine", "pelvis") else parent
                               for parent in parents)
       for side in "LR"
       for name, parents in (("clavicle", ("chest", "spine")), ("upper_arm", ("clavicle",)),
                             ("forearm", ("upper_arm",)), ("hand", ("forearm",)), ("thigh", ("pelvis",)),
                             ("shin", ("thigh",)), ("foot", ("shin",)), ("toe", ("foot",)))},
})
OPTIONAL = frozenset({"toe.L", "toe.R"})
PRESETS_FOLDER = Path(__file__).parent / "presets"


@dataclass(frozen=True)
class GripPlace:
    """Where a hand holds: a point on `bone`, `along` from its head (0) to its tail (1)."""

    bone: str
    along: float = 1.0


@dataclass(frozen=True)
class BoneMap:
    """`segments` maps a segment (a key of PARENTS) to a bone's name; `grips` overrides the grip of side "L" or "R"."""

    name: str
    segments: Mapping[str, str]
    grips: Mapping[str, GripPlace] = field(default_factory=dict)

    def grip(self, side: str) -> GripPlace:
        return self.grips.get(side, GripPlace(self.segments[f"hand.{side}"]))

    def gaps(self, bones: Collection[str]) -> list[str]:
        """What keeps this map from fitting a rig with these bones, one entry per segment."""
        found = []
        for segment in PARENTS:
            bone = self.segments.get(segment)
            if bone is None and segment not in OPTIONAL:
                found.append(f"{segment} is not mapped")
            elif bone is not None and bone not in bones and segment not in OPTIONAL:
                found.append(f"{segment} (bone '{bone}' is missing)")
        found += [f"grip.{side} (bone '{grip.bone}' is missing)"
                  for side, grip in self.grips.items() if grip.bone not in bones]
        return found

    def fitted(self, bones: Collection[str], rig: str) -> BoneMap:
        """The map without optional bones that the rig lacks; ValueError names every gap and every bone used twice."""
        if gaps := self.gaps(bones):
            raise ValueError(f"Rig '{rig}' does not fit the bone map '{self.name}': {', '.join(gaps)}")
        segments = {segment: bone for segment, bone in self.segments.items() if bone in bones}
        owners: dict[str, str] = {}
        for segment, bone in segments.items():
            other = owners.setdefault(bone, segment)
            if other != segment and {other, segment} != {"spine", "chest"}:
                raise ValueError(f"Bone map '{self.name}' uses bone '{bone}' for both {other} and {segment}")
        return BoneMap(self.name, segments, self.grips)


def parse_bone_map(text: str, source: str) -> BoneMap:
    """A bone map from JSON; ValueError says what in `source` is wrong."""
    try:
        data = json.loads(text)
    except json.JSONDecodeError as error:
        raise ValueError(f"Bone map '{source}' is not JSON: line {error.lineno}: {error.msg}") from error
    segments = data.get("segments") if isinstance(data, dict) else None
    if not isinstance(segments, dict) or not all(isinstance(bone, str) for bone in segments.values()):
        raise ValueError(f"Bone map '{source}' needs an object 'segments' of segment names and bone names")
    if unknown := [name for name in segments if name not in PARENTS]:
        raise ValueError(f"Bone map '{source}' names unknown segments: {', '.join(unknown)}; "
                         f"known are {', '.join(PARENTS)}")
    return BoneMap(str(data.get("name", source)), segments, _parse_grips(data.get("grips", {}), source))


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


def load_bone_map(path: str | Path) -> BoneMap:
    path = Path(path)
    try:
        return parse_bone_map(path.read_text(encoding="utf-8"), path.name)
    except (OSError, UnicodeDecodeError) as error:
        raise ValueError(f"Bone map '{path}' cannot be read: {error}") from error


_presets: dict[str, BoneMap] = {}


def presets() -> list[BoneMap]:
    """The maps that ship with the add-on, read once."""
    if not _presets:
        _presets.update((path.stem, load_bone_map(path)) for path in sorted(PRESETS_FOLDER.glob("*.json")))
    return list(_presets.values())


def detect(bones: Collection[str], rig: str) -> BoneMap:
    """The preset that fits these bones; ValueError lists what the closest one lacks."""
    names = frozenset(bones)
    closest = min(presets(), key=lambda preset: len(preset.gaps(names)))
    return closest.fitted(names, rig)
