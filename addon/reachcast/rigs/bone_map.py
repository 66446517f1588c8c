# SPDX-License-Identifier: GPL-3.0-or-later
"""Which bone of a rig is which segment of a body, as plain names. See rig_presets.py for where maps come from."""
from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

#: Each segment and the segments that may be its nearest mapped ancestor. The order is parents first.
PARENTS: Mapping[str, tuple[str, ...]] = MappingProxyType({
    "pelvis": (), "spine": ("pelvis",), "chest": ("spine",), "neck": ("chest", "spine"), "head": ("neck",),
    **{f"{name}.{side}": tuple(f"{parent}.{side}" if parent not in ("chest", "spine", "pelvis") else parent
                               for parent in parents)
       for side in "LR"
       for name, parents in (("clavicle", ("chest", "spine")), ("upper_arm", ("clavicle", "chest", "spine")),
                             ("forearm", ("upper_arm",)), ("hand", ("forearm",)), ("thigh", ("pelvis",)),
                             ("shin", ("thigh",)), ("foot", ("shin",)), ("toe", ("foot",)))},
})
OPTIONAL = frozenset({"toe.L", "toe.R", "clavicle.L", "clavicle.R"})


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
    controls: str = ""   #: "rigify" when the bones follow the controls of a generated Rigify rig, which get the keys

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
        return BoneMap(self.name, segments, self.grips, self.controls)
