# SPDX-License-Identifier: GPL-3.0-or-later
"""An armature object as a skeleton in world metres, or one sentence about what on it cannot be animated."""
from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np

from ..rigs.bone_map import BoneMap
from ..rigs.implied_bones import with_clavicles
from ..rigs.rig_presets import detect, known_part, load_preset
from ..rigs.rig_shape import shape_map
from ..rigs.rigify_controls import as_body
from ..rigs.rotations import orthonormal
from ..rigs.skeleton import Bones, Skeleton, build_skeleton
from .control_rig import refuse_unusable
from .map_editing import edited_map, user_presets
from .transforms import Placement, described, even_placement


def read_rig(rig: bpy.types.Object, bone_map: BoneMap | str | Path | None = None,
             layer: bpy.types.ViewLayer | None = None) -> Skeleton:
    """The rest skeleton of `rig` where `layer` (the user's own by default) shows it.

    bone_map: a map, a JSON file's path, or None to recognise the bones' names.
    """
    if not isinstance(rig, bpy.types.Object) or rig.type != "ARMATURE":
        raise ValueError(f"The rig must be an armature object, not {described(rig)}")
    if rig.mode == "EDIT":
        raise ValueError(f"Rig '{rig.name}' is in Edit Mode; leave it first (Tab)")
    if rig.data.pose_position == "REST":
        raise ValueError(f"Rig '{rig.name}' is shown in its rest position; set its Skeleton to Pose Position")
    names = [bone.name for bone in rig.data.bones]
    if bone_map is None:
        bone_map = recognise(rig)
    elif not isinstance(bone_map, BoneMap):
        bone_map = load_preset(bpy.path.abspath(str(bone_map))).on(names)
    bones = _bones(rig, even_placement(rig, layer))
    if bone_map.controls:
        refuse_unusable(rig)
        return build_skeleton(rig.name, as_body(bones, bone_map), bone_map)
    bone_map = bone_map.fitted(frozenset(names), rig.name)
    skeleton = build_skeleton(rig.name, *with_clavicles(bones, bone_map))
    _refuse_what_overrides_keys(rig, skeleton)
    return skeleton


def recognise(rig: bpy.types.Object) -> BoneMap:
    """The map that was edited on the rig; else by the bones' names, the user's presets first; by the skeleton's shape
    when no known rig has even half of these names.

    Cheap enough for every redraw. ValueError says what is missing.
    """
    names = [bone.name for bone in rig.data.bones]
    if (edited := edited_map(rig)) is not None:
        return edited.fitted(frozenset(names), rig.name)
    try:
        return detect(names, rig.name, user_presets())
    except ValueError:
        if known_part(names) >= 0.5:
            raise  # a known rig that lacks a bone
    matrix = np.array(rig.matrix_world, dtype=float)
    scale = np.linalg.norm(matrix[:3, :3], axis=0)
    if not np.all(np.isfinite(matrix)) or np.any(scale < 1e-9):
        raise ValueError(f"Rig '{rig.name}' has a transform by which no bone can be placed")
    return shape_map(_bones(rig, Placement(matrix[:3, 3], matrix[:3, :3] / scale, scale)), rig.name)


def _bones(rig: bpy.types.Object, place: Placement) -> Bones:
    bones = rig.data.bones  # Blender lists parents before their children
    index = {bone.name: number for number, bone in enumerate(bones)}
    rest, tails = np.empty(16 * len(index), dtype=np.float32), np.empty(3 * len(index), dtype=np.float32)
    bones.foreach_get("matrix_local", rest)
    bones.foreach_get("tail_local", tails)
    columns = rest.reshape(-1, 4, 4).astype(float)  # a matrix comes column by column
    parents = [bone.parent for bone in bones]
    return Bones(
        names=tuple(index), parents=tuple(index[parent.name] if parent else -1 for parent in parents),
        heads=place.to_world(columns[:, 3, :3]), tails=place.to_world(tails.reshape(-1, 3)),
        rotations=place.rotation @ orthonormal(columns[:, :3, :3].transpose(0, 2, 1)),  # from single precision
        origin=place.origin, axes=place.rotation, scale=float(np.mean(place.scale)))


def _refuse_what_overrides_keys(rig: bpy.types.Object, skeleton: Skeleton) -> None:
    names = [name for bone in skeleton.keyed if (name := skeleton.bones.names[bone]) not in skeleton.bones.implied]
    held = [f"'{constraint.name}' on {name}" for name in names for constraint in rig.pose.bones[name].constraints
            if not constraint.mute and constraint.influence > 0.0]
    if held:
        raise ValueError(f"Rig '{rig.name}' has constraints on bones that must move freely: {', '.join(held)}; "
                         f"mute or remove them")
    loose = [name for name in names if not rig.data.bones[name].use_inherit_rotation]
    if loose:
        raise ValueError(f"Rig '{rig.name}' has bones that do not inherit rotation: {', '.join(loose)}; "
                         f"switch Inherit Rotation on")
    unscaled = [name for name in names if rig.data.bones[name].inherit_scale in {"NONE", "NONE_LEGACY"}]
    if unscaled:
        raise ValueError(f"Rig '{rig.name}' has bones that do not inherit scale: {', '.join(unscaled)}; "
                         f"set Inherit Scale to Full")
    pelvis = rig.data.bones[skeleton.bones.names[skeleton.segments["pelvis"]]]
    if pelvis.use_connect and pelvis.parent is not None:
        raise ValueError(f"Rig '{rig.name}': pelvis bone '{pelvis.name}' is connected to '{pelvis.parent.name}' "
                         f"and cannot move; switch Connected off")
    for side in "LR":
        arm = rig.data.bones[skeleton.bones.names[skeleton.segments[f"upper_arm.{side}"]]]
        is_free = skeleton.bones.names[skeleton.segments[f"clavicle.{side}"]] not in skeleton.bones.implied
        if not is_free and (arm.use_connect or not arm.use_local_location):
            raise ValueError(f"Rig '{rig.name}' has no clavicle above '{arm.name}', which must then move by itself; "
                             f"switch its Connected off and its Local Location on")
    if skeleton_drivers := _driven(rig, set(names)):
        raise ValueError(f"Rig '{rig.name}' has drivers on bones that must move freely: {', '.join(skeleton_drivers)}; "
                         f"remove them")


def _driven(rig: bpy.types.Object, names: set[str]) -> list[str]:
    if rig.animation_data is None:
        return []
    found = set()
    for curve in rig.animation_data.drivers:
        if curve.data_path.startswith('pose.bones["') and not curve.mute:
            bone, _, channel = curve.data_path[len('pose.bones["'):].partition('"].')
            if bone in names and channel.split("_")[0] in {"location", "rotation", "scale"}:
                found.add(bone)
    return sorted(found)
