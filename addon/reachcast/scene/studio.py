# SPDX-License-Identifier: GPL-3.0-or-later
"""A quiet studio for a scene that has no light of its own: floor, backdrop, three lights. World axes, metres."""
from __future__ import annotations

import math

import bpy
from mathutils import Matrix, Vector

from .blender_versions import set_sun

BACKDROP = (0.19, 0.235, 0.28)
FLOOR = (0.20, 0.235, 0.27)
SKY = (0.30, 0.34, 0.38)
LINE_M = 0.5  #: between the floor's lines
NAME = "Studio"


#: Lights of a worker who faces +y, with the camera to the left: from what they are for, metres.
_PLACES = {"Key Sun": (-2.0, 2.0, 4.2), "Fill": (2.5, 3.5, 1.5), "Rim": (1.2, -3.5, 2.6)}


def studio_of(scene: bpy.types.Scene) -> bpy.types.Collection | None:
    return scene.collection.children.get(NAME)


def add_studio(scene: bpy.types.Scene) -> bpy.types.Collection:
    """Floor, background and light, in a collection of the scene; `place_studio` puts them where they belong."""
    collection = bpy.data.collections.new(NAME)
    scene.collection.children.link(collection)
    _set_world(scene)
    for item in (_light("Key Sun", "SUN", 3.2, math.radians(5.0), (1.0, 0.96, 0.90)),
                 _light("Fill", "AREA", 55.0, 3.0, (0.85, 0.92, 1.0)),
                 _light("Rim", "AREA", 120.0, 1.5, (0.9, 0.95, 1.0)), _floor()):
        collection.objects.link(item)
    return collection


def place_studio(studio: bpy.types.Collection, centre: Vector, ahead: Vector, toward_left: bool,
                 floor_height: float = 0.0) -> None:
    """centre: what the light is for. ahead: level, the way the worker faces; the key light comes from the camera's side,
    as `camera.direction` has it. The floor's lines stay where they are in the world."""
    turn = Matrix.Rotation(math.atan2(-ahead.x, ahead.y), 3, "Z")
    for item in studio.objects:
        if item.type == "LIGHT":
            x, y, z = next(place for name, place in _PLACES.items() if item.name.startswith(name))
            offset = turn @ Vector((x if toward_left else -x, y, z))
            item.location = centre + offset
            item.rotation_euler = (-offset).to_track_quat("-Z", "Y").to_euler()
        else:
            item.location = [2.0 * LINE_M * round(part / (2.0 * LINE_M)) for part in centre[:2]] + [floor_height]


def _set_world(scene: bpy.types.Scene) -> None:
    """The camera sees the backdrop, darker towards the top; everything else is lit by an even sky."""
    world = scene.world or bpy.data.worlds.new(NAME)
    scene.world = world
    world.use_nodes = True
    world.color = (0.19, 0.23, 0.27)  # what Workbench shows
    nodes, links = world.node_tree.nodes, world.node_tree.links
    place, parts, ramp, path, mix = (nodes.new(kind) for kind in (
        "ShaderNodeTexCoord", "ShaderNodeSeparateXYZ", "ShaderNodeValToRGB", "ShaderNodeLightPath",
        "ShaderNodeMixRGB"))
    links.new(place.outputs["Generated"], parts.inputs["Vector"])
    links.new(parts.outputs["Z"], ramp.inputs["Fac"])
    low, high = ramp.color_ramp.elements
    low.position, low.color = 0.0, (*BACKDROP, 1.0)
    high.position, high.color = 0.35, (*(0.45 * part for part in BACKDROP), 1.0)
    links.new(path.outputs["Is Camera Ray"], mix.inputs["Fac"])
    mix.inputs["Color1"].default_value = (*SKY, 1.0)
    links.new(ramp.outputs["Color"], mix.inputs["Color2"])
    links.new(mix.outputs["Color"], nodes["Background"].inputs["Color"])


def _floor() -> bpy.types.Object:
    """A wide floor with a thin line every half metre, which dissolves into the background."""
    mesh = bpy.data.meshes.new("Floor")
    mesh.from_pydata([(-40, -40, 0), (40, -40, 0), (40, 40, 0), (-40, 40, 0)], [], [(0, 1, 2, 3)])
    floor = bpy.data.objects.new("Floor", mesh)
    material = bpy.data.materials.new("Floor")
    material.use_nodes = True
    material.diffuse_color = (0.36, 0.41, 0.46, 1.0)  # what Workbench shows
    mesh.materials.append(material)
    tree = material.node_tree
    tree.nodes.remove(tree.nodes["Principled BSDF"])
    shader = tree.nodes.new("ShaderNodeBsdfDiffuse")  # most of the picture is floor, and this costs less
    tree.links.new(_lined(tree), shader.inputs["Color"])
    haze, mix = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeMixShader")
    haze.inputs["Color"].default_value = (*BACKDROP, 1.0)
    tree.links.new(_distance(tree, 2.0, 7.0), mix.inputs["Fac"])
    tree.links.new(shader.outputs["BSDF"], mix.inputs[1])
    tree.links.new(haze.outputs["Emission"], mix.inputs[2])
    tree.links.new(mix.outputs["Shader"], tree.nodes["Material Output"].inputs["Surface"])
    return floor


def _math(tree: bpy.types.NodeTree, operation: str, *values: object) -> bpy.types.NodeSocket:
    node = tree.nodes.new("ShaderNodeMath")
    node.operation = operation
    for slot, value in zip(node.inputs, values):
        if isinstance(value, bpy.types.NodeSocket):
            tree.links.new(value, slot)
        else:
            slot.default_value = value
    return node.outputs["Value"]


def _lined(tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    """The floor's colour: lighter within 4 mm of a line."""
    place, parts, mix = (tree.nodes.new(kind) for kind in (
        "ShaderNodeTexCoord", "ShaderNodeSeparateXYZ", "ShaderNodeMixRGB"))
    tree.links.new(place.outputs["Object"], parts.inputs["Vector"])
    near = [_math(tree, "PINGPONG", parts.outputs[axis], 0.5 * LINE_M) for axis in "XY"]
    line = _math(tree, "LESS_THAN", _math(tree, "MINIMUM", *near), 0.004)
    tree.links.new(_math(tree, "MULTIPLY", line, 0.35), mix.inputs["Fac"])
    mix.inputs["Color1"].default_value = (*FLOOR, 1.0)
    mix.inputs["Color2"].default_value = (0.55, 0.60, 0.65, 1.0)
    return mix.outputs["Color"]


def _distance(tree: bpy.types.NodeTree, near: float, far: float) -> bpy.types.NodeSocket:
    """0 within `near` metres of the floor's middle, rising smoothly to 1 at `far`."""
    place, length, ramp = (tree.nodes.new(kind) for kind in (
        "ShaderNodeTexCoord", "ShaderNodeVectorMath", "ShaderNodeMapRange"))
    length.operation, ramp.interpolation_type = "LENGTH", "SMOOTHSTEP"
    tree.links.new(place.outputs["Object"], length.inputs[0])
    tree.links.new(length.outputs["Value"], ramp.inputs["Value"])
    ramp.inputs["From Min"].default_value, ramp.inputs["From Max"].default_value = near, far
    return ramp.outputs["Result"]


def _light(name: str, kind: str, energy: float, size: float, colour: tuple[float, float, float]) -> bpy.types.Object:
    """size: metres, or radians of a sun. Only the sun throws shadows."""
    data = bpy.data.lights.new(name, kind)
    data.energy, data.color, data.use_shadow = energy, colour, kind == "SUN"
    if kind == "SUN":
        set_sun(data, size)
    else:
        data.size = size
    return bpy.data.objects.new(name, data)
