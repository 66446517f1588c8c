# SPDX-License-Identifier: GPL-3.0-or-later
"""Build the mannequin in Blender: an armature and one mesh object per bone, parented to it.

The figure stands on z = 0 of the armature object, faces -y and has its left side (.L) at +x. In rest the palms face
each other (left: local +x of hand.L, right: local -x of hand.R), the thumbs point forward (local +z), and the tail
of each hand bone is the centre of its grip. Positive rotation about local x flexes every elbow, knee and spine bone.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy
from mathutils import Matrix, Vector

from .. import native
from ..rigs import mannequin_shape as shape
from ..rigs.mannequin_tables import MATERIALS

GROUPS = {
    "Trunk": ("hips", "spine", "ribs", "chest", "neck", "head"),
    "Arm.L": ("shoulder.L", "upper_arm.L", "forearm.L", "hand.L"),
    "Arm.R": ("shoulder.R", "upper_arm.R", "forearm.R", "hand.R"),
    "Leg.L": ("thigh.L", "shin.L", "foot.L", "toe.L"),
    "Leg.R": ("thigh.R", "shin.R", "foot.R", "toe.R"),
}


def standing_posture(stature: float, sex: str | None) -> shape.Posture:
    """Published proportions of a stature (metres) and sex ("female", "male" or None), for `build_mannequin`. ValueError
    for a stature without any."""
    core = native.core()
    posture = core.Body.from_stature(stature, sex=sex).posture
    return {name: tuple(map(float, place)) for name, place in zip(core.JOINTS, posture)}


def build_mannequin(collection: bpy.types.Collection, posture: shape.Posture, sex: str | None, name: str = "Worker",
                    *, stature: float | None = None, dressed: bool = True) -> bpy.types.Object:
    """Add a mannequin to `collection`; returns its armature object, active and selected where it is visible.

    `posture`: joint centres of the standing person, canonical name -> (x, y, z), metres, body frame.
    `sex`: "female", "male" or None (in between). `stature`: metres; without it, read off the nasion's height.
    `dressed`: with its surfaces; without, `dress_mannequin` can add them later.
    Leaves edit or pose mode. Whatever goes wrong, the exception passes on and nothing of the figure stays behind.
    """
    stature = shape.estimated_stature(posture) if stature is None else float(stature)
    bones = shape.skeleton(posture, stature)
    with _all_or_nothing() as created:
        armature = _add_armature(collection, bones, name, created)
        armature["reachcast_stature"] = stature
        armature["reachcast_sex"] = (sex or "").lower()
        if dressed:
            _dress(collection, armature, posture, created)
        _make_active(armature)
    return armature


def remove_with_meshes(item: bpy.types.Object) -> None:
    """A mannequin with its surfaces, or any object with the meshes on it, and what was made for them alone."""
    items = [*(child for child in item.children if child.type == "MESH"), item]
    data = [each.data for each in items]
    bpy.data.batch_remove(items)
    bpy.data.batch_remove([each for each in data if each.users == 0])


def dress_mannequin(armature: bpy.types.Object, posture: shape.Posture) -> None:
    """Adds the surfaces of a mannequin that was built without them, where its armature is. `posture`: as it was built."""
    with _all_or_nothing() as created:
        _dress(armature.users_collection[0], armature, posture, created)


def _dress(collection: bpy.types.Collection, armature: bpy.types.Object, posture: shape.Posture,
           created: list[bpy.types.ID]) -> None:
    surfaces = shape.surfaces(posture, armature["reachcast_stature"], armature["reachcast_sex"] or None)
    materials = [_material(*row, created) for row in MATERIALS]
    for bone in armature.data.bones:
        _add_segment(collection, armature, bone.name, surfaces[bone.name], materials, created)


@contextmanager
def _all_or_nothing() -> Iterator[list[bpy.types.ID]]:
    """Hands out a list for new datablocks and, on failure, removes them and restores the selection."""
    layer = bpy.context.view_layer
    if layer.objects.active is not None and layer.objects.active.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    active, selected = layer.objects.active, [o for o in layer.objects if o.select_get()]
    created: list[bpy.types.ID] = []
    try:
        yield created
    except BaseException:
        bpy.data.batch_remove(created)
        layer.update()  # until then the layer lists what was removed
        for item in layer.objects:
            item.select_set(item in selected)
        layer.objects.active = active
        raise


def _add_armature(collection: bpy.types.Collection, bones: tuple[shape.Bone, ...], name: str,
                  created: list[bpy.types.ID]) -> bpy.types.Object:
    """The armature object in its rest pose."""
    data = bpy.data.armatures.new(name)
    created.append(data)
    armature = bpy.data.objects.new(name, data)
    created.append(armature)
    with _edit_mode(armature):
        for bone in bones:
            edit = data.edit_bones.new(bone.name)
            edit.head, edit.tail = bone.head, bone.tail
            edit.align_roll(bone.z_hint)
            if bone.parent is not None:
                edit.parent = data.edit_bones[bone.parent]
                edit.use_connect = bone.connected
    collection.objects.link(armature)
    for pose_bone in armature.pose.bones:
        pose_bone.rotation_mode = "QUATERNION"
    data.display_type = "STICK"
    armature.show_in_front = True
    _group_bones(data)
    return armature


@contextmanager
def _edit_mode(armature: bpy.types.Object) -> Iterator[None]:
    """Edit mode for an object that is in no collection yet: the target may be hidden, the scene's root never is."""
    root, layer = bpy.context.scene.collection, bpy.context.view_layer
    root.objects.link(armature)
    layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    try:
        yield
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")
        root.objects.unlink(armature)


def _group_bones(data: bpy.types.Armature) -> None:
    """Bones by limb: in bone collections, or in the first five layers before Blender 4.0."""
    for index, (title, names) in enumerate(GROUPS.items()):
        if hasattr(data, "collections"):
            group = data.collections.new(title)
            for name in names:
                group.assign(data.bones[name])
        else:
            data.layers[index] = True
            for name in names:
                data.bones[name].layers = [layer == index for layer in range(32)]


def _material(name: str, colour: tuple[float, float, float], roughness: float,
              created: list[bpy.types.ID]) -> bpy.types.Material:
    """The material of that name; mannequins share it, so that it is tuned in one place."""
    material = bpy.data.materials.get(name)
    if material is not None:
        return material
    material = bpy.data.materials.new(name)
    created.append(material)
    material.diffuse_color = (*colour, 1.0)
    material.roughness = roughness
    material.use_nodes = True
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Base Color"].default_value = (*colour, 1.0)
    shader.inputs["Roughness"].default_value = roughness
    return material


def _add_segment(collection: bpy.types.Collection, armature: bpy.types.Object, bone_name: str, surface: shape.Surface,
                 materials: list[bpy.types.Material], created: list[bpy.types.ID]) -> None:
    """One mesh object with its origin at the bone's head and its axes along the bone's."""
    bone = armature.data.bones[bone_name]
    to_bone = bone.matrix_local.inverted()
    name = f"{armature.name} {bone_name}"
    mesh = bpy.data.meshes.new(name)
    created.append(mesh)
    mesh.from_pydata([to_bone @ Vector(vertex) for vertex in surface.vertices], [], surface.faces)
    for material in materials:
        mesh.materials.append(material)
    mesh.polygons.foreach_set("use_smooth", [True] * len(surface.faces))
    mesh.polygons.foreach_set("material_index", surface.materials.tolist())
    mesh.update()
    item = bpy.data.objects.new(name, mesh)
    created.append(item)
    collection.objects.link(item)
    item.parent, item.parent_type, item.parent_bone = armature, "BONE", bone_name
    item.matrix_parent_inverse = Matrix.Translation((0.0, -bone.length, 0.0))  # children hang on a bone's tail


def _make_active(armature: bpy.types.Object) -> None:
    """Select only the armature, unless its collection is out of sight."""
    layer = bpy.context.view_layer
    for item in layer.objects:
        item.select_set(False)
    if armature.name in layer.objects:
        armature.select_set(True)
        layer.objects.active = armature
