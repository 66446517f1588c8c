# SPDX-License-Identifier: GPL-3.0-or-later
"""The controls of a generated Rigify human: which of them carries which segment, and against what it is turned.

The deform bones, which a bone map of such a rig names, hang on mechanisms and not on each other. They are read as a body
all the same (`as_body`), and what moves is written on the controls:

    torso turns and places the trunk; spine_fk turns the pelvis about l5s1, where its head lies; neck, head, shoulders and
    the FK limbs turn on what is above them; IK hands and feet and their poles are placed in the space of the root.

Read from rigs that Rigify made itself, in Blender 3.4 and later.
"""
from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from .bone_map import PARENTS, BoneMap
from .skeleton import Bones

ROOT = ""   #: stands for the armature's own space, in which the root control rests


@dataclass(frozen=True)
class Control:
    """`bone` goes rigidly with `segment`; its parent goes with the segment `above`, or rests (ROOT)."""

    bone: str
    segment: str
    above: str
    places: bool = False   #: location is keyed too


@dataclass(frozen=True)
class Pole:
    """`bone` is placed so that the joint of upper and lower bends where the motion bends it."""

    bone: str
    upper: str
    lower: str
    end: str


@dataclass(frozen=True)
class Plan:
    """What is written: controls over time, poles, controls that rest, and switches as (bone, property, value)."""

    controls: tuple[Control, ...]
    poles: tuple[Pole, ...]
    resting: tuple[str, ...]
    switches: tuple[tuple[str, str, float], ...]
    #: Links of IK limbs that must keep their lengths: Blender's solver would stretch them although it could reach.
    stiff: tuple[str, ...]

    @property
    def bones(self) -> tuple[str, ...]:
        return (*(control.bone for control in self.controls), *(pole.bone for pole in self.poles), *self.resting)


def plan(hands: str, feet: str) -> Plan:
    """hands, feet: "FK" or "IK", else ValueError."""
    for what, kind in (("hands", hands), ("feet", feet)):
        if kind not in {"FK", "IK"}:
            raise ValueError(f"The {what} of a control rig are {kind!r}; they must be 'FK' or 'IK'")
    controls = [Control("torso", "chest", ROOT, True), Control("spine_fk", "pelvis", "chest"),
                Control("tweak_spine.001", "chest", "pelvis"), Control("neck", "neck", "chest"),
                Control("head", "head", "neck")]
    poles: list[Pole] = []
    resting = ["root", "hips", "chest", "spine_fk.001", "spine_fk.002", "spine_fk.003", "tweak_spine", "tweak_spine.002",
               "tweak_spine.003", "tweak_spine.004", "tweak_spine.005"]
    switches: list[tuple[str, str, float]] = [("torso", "neck_follow", 1.0), ("torso", "head_follow", 1.0)]
    stiff: list[str] = []
    for side in "LR":
        controls.append(Control(f"shoulder.{side}", f"clavicle.{side}", "chest"))
        for kind, parts, above in ((hands, ("upper_arm", "forearm", "hand"), f"clavicle.{side}"),
                                   (feet, ("thigh", "shin", "foot"), "pelvis")):
            upper, lower, end = parts
            resting += [f"{upper}_tweak.{side}", f"{upper}_tweak.{side}.001", f"{lower}_tweak.{side}",
                        f"{lower}_tweak.{side}.001", f"{end}_tweak.{side}"]
            switches.append((f"{upper}_parent.{side}", "IK_FK", float(kind == "FK")))
            if kind == "FK":
                switches.append((f"{upper}_parent.{side}", "FK_limb_follow", 0.0))
                line = [above, *(f"{part}.{side}" for part in parts)]
                controls += [Control(f"{part}_fk.{side}", f"{part}.{side}", up) for part, up in zip(parts, line)]
            else:
                switches += [(f"{upper}_parent.{side}", name, value) for name, value in
                             (("IK_parent", 1.0), ("pole_parent", 1.0), ("pole_vector", 1.0), ("IK_Stretch", 0.0))]
                controls.append(Control(f"{end}_ik.{side}", f"{end}.{side}", ROOT, True))
                poles.append(Pole(f"{upper}_ik_target.{side}", *(f"{part}.{side}" for part in parts)))
                resting.append(f"{upper}_ik.{side}")
                stiff += [f"{upper}_ik.{side}", f"MCH-{lower}_ik.{side}"]
        if feet == "IK":
            resting += [f"foot_spin_ik.{side}", f"foot_heel_ik.{side}"]
        controls.append(Control(f"toe_{feet.lower()}.{side}", f"toe.{side}", f"foot.{side}"))
    return Plan(tuple(controls), tuple(poles), tuple(resting), tuple(switches), tuple(stiff))


def as_body(bones: Bones, bone_map: BoneMap) -> Bones:
    """The mapped bones alone, each below the bone of the segment above it, and with the bones of the grips."""
    at = {segment: bones.index(bone) for segment, bone in bone_map.segments.items() if bone in bones.names}
    order = [segment for segment in PARENTS if segment in at]
    kept = [at[segment] for segment in order]
    parents = [next((order.index(above) for above in PARENTS[segment] if above in order), -1) for segment in order]
    for side, number in _grips(bones, bone_map):
        if number not in kept and f"hand.{side}" in order:
            kept.append(number)
            parents.append(order.index(f"hand.{side}"))
    return replace(bones, names=tuple(bones.names[number] for number in kept), parents=tuple(parents),
                   heads=bones.heads[kept], tails=bones.tails[kept], rotations=bones.rotations[np.array(kept, int)])


def _grips(bones: Bones, bone_map: BoneMap) -> Iterator[tuple[str, int]]:
    for side, grip in bone_map.grips.items():
        if grip.bone in bones.names:
            yield side, bones.index(grip.bone)
