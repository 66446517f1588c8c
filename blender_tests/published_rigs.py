# SPDX-License-Identifier: GPL-3.0-or-later
"""Rigs of other tools, built from their published bone names and hierarchies on the joints of our mannequin.

A rig is a list of (bone, parent, place of its head). Places are names of joints, or (joint, joint, part of the way).
A bone's tail is the head of its first child that lies elsewhere; a bone without one goes on as its parent does.
"""
from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import bpy
import fake_core
import numpy as np
from mathutils import Matrix, Vector
from reachcast.rigs.joints import JOINTS

Place = str | tuple[str, str, float]
Row = tuple[str, str | None, Place]
_STATURE = 1.75


def _trunk(names: list[str], parent: str) -> list[Row]:
    """Bones one after the other from l5s1 to c7t1."""
    rows, above = [], parent
    for number, name in enumerate(names):
        rows.append((name, above, ("l5s1", "c7t1", number / len(names))))
        above = name
    return rows


def _head(names: list[str], parent: str) -> list[Row]:
    rows, above = [], parent
    for number, name in enumerate(names):
        rows.append((name, above, ("c7t1", "tragion", 0.8 * number / max(1, len(names) - 1))))
        above = name
    return rows


def _limb(names: list[tuple[str, Place]], parent: str) -> list[Row]:
    rows, above = [], parent
    for name, place in names:
        rows.append((name, above, place))
        above = name
    return rows


def _sides(parent_arm: str, parent_leg: str, arm: Callable[[str], list[str]], leg: Callable[[str], list[str]],
           words: tuple[tuple[str, str], ...], *, twists: bool = False) -> Iterator[Row]:
    """Arms (clavicle, upper arm, forearm, hand, finger) and legs (thigh, shin, foot, toe); with twist bones halfway."""
    for word, side in words:
        at = [f"{side}_{joint}" for joint in ("clavicle", "shoulder", "elbow", "wrist", "grip")]
        places: list[Place] = list(at)
        if twists:
            places[2:2] = [(at[1], at[2], 0.5)]
            places[4:4] = [(at[2], at[3], 0.5)]
        yield from _limb(list(zip(arm(word), places)), parent_arm)
        down = [f"{side}_{joint}" for joint in ("hip", "knee", "ankle", "ball")]
        places = list(down)
        if twists:
            places[1:1] = [(down[0], down[1], 0.5)]
        yield from _limb(list(zip(leg(word), places)), parent_leg)


_LR, _lr = (("L", "left"), ("R", "right")), (("l", "left"), ("r", "right"))
_WORDS, _words = (("Left", "left"), ("Right", "right")), (("left", "left"), ("right", "right"))
_ROOT: Row = ("root", None, "floor")


def _motionbuilder(prefix: str, spine: list[str]) -> list[Row]:
    name = prefix.__add__
    return [(name("Hips"), None, "pelvis"), *_trunk([name(bone) for bone in spine], name("Hips")),
            *_head([name("Neck"), name("Head")], name(spine[-1])),
            *_sides(name(spine[-1]), name("Hips"),
                    lambda w: [name(w + part) for part in ("Shoulder", "Arm", "ForeArm", "Hand", "HandMiddle1")],
                    lambda w: [name(w + part) for part in ("UpLeg", "Leg", "Foot", "ToeBase")], _WORDS)]


def _cmu() -> list[Row]:
    """Each thigh hangs on a bone of its own that starts where the pelvis does."""
    hips, *others = _motionbuilder("", ["LowerBack", "Spine", "Spine1"])
    return [hips, *((f"{word[0]}HipJoint", "Hips", "pelvis") for word, _ in _WORDS),
            *((bone, f"{bone[0]}HipJoint" if bone.endswith("UpLeg") else parent, place)
              for bone, parent, place in others)]


def _unreal() -> list[Row]:
    spine = [f"spine_0{number}" for number in range(1, 6)]
    return [_ROOT, ("pelvis", "root", "pelvis"), *_trunk(spine, "pelvis"),
            *_head(["neck_01", "neck_02", "head"], spine[-1]),
            *_sides(spine[-1], "pelvis",
                    lambda s: [f"{bone}_{s}" for bone in ("clavicle", "upperarm", "lowerarm", "hand", "middle_01")],
                    lambda s: [f"{bone}_{s}" for bone in ("thigh", "calf", "foot", "ball")], _lr),
            *[(f"{bone}_twist_01_{s}", f"{bone}_{s}", (f"{side}_{a}", f"{side}_{b}", 0.5)) for s, side in _lr
              for bone, a, b in (("upperarm", "shoulder", "elbow"), ("lowerarm", "elbow", "wrist"),
                                 ("thigh", "hip", "knee"), ("calf", "knee", "ankle"))]]


def _makehuman() -> list[Row]:
    spine = [f"spine0{number}" for number in range(5, 0, -1)]
    rows: list[Row] = [("root", None, "pelvis"), *_trunk(spine, "root"),
                       *_head(["neck01", "neck02", "neck03", "head"], "spine01")]
    for s, side in _LR:
        at = {joint: f"{side}_{joint}" for joint in ("clavicle", "shoulder", "elbow", "wrist", "grip", "hip", "knee",
                                                      "ankle", "ball")}
        rows += _limb([(f"clavicle.{s}", at["clavicle"]), (f"shoulder01.{s}", (at["clavicle"], at["shoulder"], 0.8)),
                       (f"upperarm01.{s}", at["shoulder"]), (f"upperarm02.{s}", (at["shoulder"], at["elbow"], 0.5)),
                       (f"lowerarm01.{s}", at["elbow"]), (f"lowerarm02.{s}", (at["elbow"], at["wrist"], 0.5)),
                       (f"wrist.{s}", at["wrist"]), (f"metacarpal2.{s}", at["grip"])], "spine01")
        rows += _limb([(f"pelvis.{s}", "pelvis"), (f"upperleg01.{s}", at["hip"]),
                       (f"upperleg02.{s}", (at["hip"], at["knee"], 0.5)), (f"lowerleg01.{s}", at["knee"]),
                       (f"lowerleg02.{s}", (at["knee"], at["ankle"], 0.5)), (f"foot.{s}", at["ankle"]),
                       (f"toe1-1.{s}", at["ball"])], "root")
    return rows


def _vroid() -> list[Row]:
    name = "J_Bip_C_{}".format
    return [("Root", None, "floor"), (name("Hips"), "Root", "pelvis"),
            *_trunk([name("Spine"), name("Chest"), name("UpperChest")], name("Hips")),
            *_head([name("Neck"), name("Head")], name("UpperChest")),
            *_sides(name("UpperChest"), name("Hips"),
                    lambda s: [f"J_Bip_{s}_{part}" for part in ("Shoulder", "UpperArm", "LowerArm", "Hand", "Middle1")],
                    lambda s: [f"J_Bip_{s}_{part}" for part in ("UpperLeg", "LowerLeg", "Foot", "ToeBase")], _LR)]


def _vrm() -> list[Row]:
    return [("hips", None, "pelvis"), *_trunk(["spine", "chest", "upperChest"], "hips"),
            *_head(["neck", "head"], "upperChest"),
            *_sides("upperChest", "hips",
                    lambda w: [w + part for part in ("Shoulder", "UpperArm", "LowerArm", "Hand", "MiddleProximal")],
                    lambda w: [w + part for part in ("UpperLeg", "LowerLeg", "Foot", "Toes")], _words)]


def _smpl(prefix: str = "") -> list[Row]:
    name = prefix.__add__
    return [(name("Pelvis"), None, "pelvis"), *_trunk([name(f"Spine{number}") for number in (1, 2, 3)], name("Pelvis")),
            *_head([name("Neck"), name("Head")], name("Spine3")),
            *_sides(name("Spine3"), name("Pelvis"),
                    lambda s: [name(f"{s}_{part}") for part in ("Collar", "Shoulder", "Elbow", "Wrist", "Hand")],
                    lambda s: [name(f"{s}_{part}") for part in ("Hip", "Knee", "Ankle", "Foot")], _LR)]


def _daz() -> list[Row]:
    spine = ["abdomenLower", "abdomenUpper", "chestLower", "chestUpper"]
    return [("hip", None, "pelvis"), ("pelvis", "hip", "pelvis"), *_trunk(spine, "hip"),
            *_head(["neckLower", "neckUpper", "head"], "chestUpper"),
            *_sides("chestUpper", "pelvis",
                    lambda s: [s + part for part in ("Collar", "ShldrBend", "ShldrTwist", "ForearmBend", "ForearmTwist",
                                                     "Hand", "Mid1")],
                    lambda s: [s + part for part in ("ThighBend", "ThighTwist", "Shin", "Foot", "Metatarsals")], _lr,
                    twists=True),
            *[(f"{s}Toe", f"{s}Metatarsals", f"{side}_toe") for s, side in _lr]]


def _auto_rig_pro() -> list[Row]:
    return [("root.x", None, "pelvis"), *_trunk(["spine_01.x", "spine_02.x", "spine_03.x"], "root.x"),
            *_head(["neck.x", "head.x"], "spine_03.x"),
            *_sides("spine_03.x", "root.x",
                    lambda s: [f"{part}.{s}" for part in ("shoulder", "arm_stretch", "forearm_stretch", "hand",
                                                          "middle1_base")],
                    lambda s: [f"{part}.{s}" for part in ("thigh_stretch", "leg_stretch", "foot", "toes_01")], _lr)]


def _biped(start: str) -> list[Row]:
    name = (start + " {}").format
    return [(start, None, "pelvis"), (name("Pelvis"), start, "pelvis"),
            *_trunk([name("Spine"), name("Spine1"), name("Spine2")], name("Pelvis")),
            *_head([name("Neck"), name("Head")], name("Spine2")),
            *_sides(name("Spine2"), name("Pelvis"),
                    lambda s: [name(f"{s} {part}") for part in ("Clavicle", "UpperArm", "Forearm", "Hand", "Finger2")],
                    lambda s: [name(f"{s} {part}") for part in ("Thigh", "Calf", "Foot", "Toe0")], _LR)]


@dataclass(frozen=True)
class PublishedRig:
    """What a tool makes: its bones, the name of the preset that knows them, how far the arms hang from the body at rest
    (degrees; 90 is a T pose), and how the importer leaves the object."""

    rows: list[Row]
    preset: str
    arms: float
    scale: float = 1.0
    lies: bool = False      #: the bones are y up and the object is turned by a quarter, as FBX comes in


_SPINES = ["Spine", "Spine1", "Spine2", "Spine3"]
PUBLISHED: dict[str, PublishedRig] = {
    "mixamo": PublishedRig(_motionbuilder("mixamorig:", _SPINES[:3]), "Mixamo", 90.0, 0.01, True),
    "mixamo without prefix": PublishedRig(_motionbuilder("", _SPINES[:3]), "Mixamo", 90.0, 0.01, True),
    "cmu": PublishedRig(_cmu(), "CMU", 90.0),
    "motionbuilder": PublishedRig(_motionbuilder("Actor:", _SPINES), "MotionBuilder", 90.0),
    "makehuman": PublishedRig(_makehuman(), "MakeHuman", 45.0, 0.1),
    "unreal": PublishedRig(_unreal(), "Unreal", 50.0, 0.01),
    "vroid": PublishedRig(_vroid(), "VRoid", 90.0),
    "vrm": PublishedRig(_vrm(), "VRM", 90.0),
    "smpl": PublishedRig(_smpl(), "SMPL", 90.0),
    "smpl with sex": PublishedRig(_smpl("m_avg_"), "SMPL", 90.0, 0.01, True),
    "daz": PublishedRig(_daz(), "Daz", 80.0, 0.01, True),
    "auto-rig pro": PublishedRig(_auto_rig_pro(), "Auto-Rig Pro", 40.0),
    "biped": PublishedRig(_biped("Bip001"), "Biped", 60.0),
    "biped of old": PublishedRig(_biped("Bip01"), "Biped", 60.0, 0.0254),
}


def build(name: str, seed: int = 0) -> bpy.types.Object:
    """The rig, standing at the world's origin and facing -y, with rolls drawn from the seed."""
    made = PUBLISHED[name]
    places = _places(made.arms)
    above = Matrix.Rotation(math.radians(90.0), 4, "X") if made.lies else Matrix()
    above = above @ Matrix.Scale(made.scale, 4)
    rig = bpy.data.objects.new(name, bpy.data.armatures.new(name))
    bpy.context.collection.objects.link(rig)
    rig.matrix_world = above
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    heads = {bone: _between(places, place) for bone, _, place in made.rows}
    rolls = np.random.default_rng(seed).uniform(-math.pi, math.pi, len(made.rows))
    into = above.inverted()
    for (bone, parent, _), roll in zip(made.rows, rolls):
        edit = rig.data.edit_bones.new(bone)
        edit.head, edit.tail = into @ Vector(heads[bone]), into @ Vector(_tail(made.rows, heads, bone))
        edit.parent = rig.data.edit_bones[parent] if parent else None
        edit.roll = float(roll)
    bpy.ops.object.mode_set(mode="OBJECT")
    return rig


def _places(arms_deg: float) -> dict[str, np.ndarray]:
    """Joints in the world, metres: x to the person's left, facing -y; arms straight, this far from hanging."""
    posture = np.array(fake_core.Body.from_stature(_STATURE).posture)
    places = dict(zip(JOINTS, posture * (-1.0, -1.0, 1.0)))  # the body frame has x to the right and y ahead
    angle = math.radians(arms_deg)
    for side, sign in (("left", 1.0), ("right", -1.0)):
        along = np.array([sign * math.sin(angle), 0.0, -math.cos(angle)])
        for start, end in (("shoulder", "elbow"), ("elbow", "wrist"), ("wrist", "grip")):
            length = np.linalg.norm(np.subtract(posture[JOINTS.index(f"{side}_{end}")],
                                                posture[JOINTS.index(f"{side}_{start}")]))
            places[f"{side}_{end}"] = places[f"{side}_{start}"] + length * along
        places[f"{side}_toe"] = places[f"{side}_ball"] + (0.0, -0.05, 0.0)
    places["pelvis"] = 0.5 * (places["left_hip"] + places["right_hip"]) + (0.0, 0.0, 0.02)
    places["floor"] = np.zeros(3)
    return places


def _between(places: dict[str, np.ndarray], place: Place) -> np.ndarray:
    if isinstance(place, str):
        return places[place]
    start, end, part = place
    return (1.0 - part) * places[start] + part * places[end]


def _tail(rows: list[Row], heads: dict[str, np.ndarray], bone: str) -> np.ndarray:
    for child, parent, _ in rows:
        if parent == bone and np.linalg.norm(heads[child] - heads[bone]) > 0.01:
            return heads[child]
    parent = next(parent for name, parent, _ in rows if name == bone)
    along = heads[bone] - heads[parent] if parent else np.array([0.0, 0.0, 1.0])
    length = np.linalg.norm(along)
    return heads[bone] + (along / length * 0.08 if length > 1e-6 else (0.0, 0.0, 0.08))
