# SPDX-License-Identifier: GPL-3.0-or-later
"""How far what a camera sees is from it, per pixel, as OpenEXR beside the pictures."""
from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import bpy

from .blender_versions import ENGINES, set_file_format
from .render import kept_render, render_frames

_NAME = "Reachcast Depth"


def render_depth(folder: Path, frames: Sequence[int], scene: bpy.types.Scene | None = None) -> dict[int, Path]:
    """`folder`/0001.exr and so on, through the scene's camera and in its size: 32-bit floats, metres along the camera's
    axis at the middle of each pixel, the same in red, green and blue; 0 where nothing is.

    Cycles draws every surface in the brightness of its depth, with one ray a pixel: every version of Blender can.
    """
    scene = scene or bpy.context.scene
    with kept_render(scene), _depth_world(scene):
        scene.render.engine = ENGINES["CYCLES"]
        settings = scene.render.image_settings
        set_file_format(settings, "OPEN_EXR")
        settings.color_mode, settings.color_depth = "RGB", "32"
        return render_frames(folder, frames, scene, suffix="exr")


@contextmanager
def _depth_world(scene: bpy.types.Scene) -> Iterator[None]:
    """Everything is made of depth and the sky is black; then all is as it was."""
    cycles, layers = scene.cycles, list(scene.view_layers)
    names = ("samples", "use_denoising", "use_adaptive_sampling", "pixel_filter_type", "filter_width")
    kept, worlds = {name: getattr(cycles, name) for name in names}, scene.world
    overrides = [layer.material_override for layer in layers]
    settings = scene.render.image_settings
    form, mode, bits = settings.file_format, settings.color_mode, settings.color_depth
    material, world = _material(), bpy.data.worlds.new(_NAME)
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.0
    try:
        cycles.samples, cycles.use_denoising, cycles.use_adaptive_sampling = 1, False, False
        cycles.pixel_filter_type, cycles.filter_width = "BOX", 0.01
        scene.world = world
        for layer in layers:
            layer.material_override = material
        yield
    finally:
        for layer, override in zip(layers, overrides):
            layer.material_override = override
        scene.world = worlds
        for name, value in kept.items():
            setattr(cycles, name, value)
        set_file_format(settings, form)
        settings.color_mode, settings.color_depth = mode, bits
        bpy.data.materials.remove(material)
        bpy.data.worlds.remove(world)


def _material() -> bpy.types.Material:
    material = bpy.data.materials.new(_NAME)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    seen, glow, output = (tree.nodes.new(kind) for kind in (
        "ShaderNodeCameraData", "ShaderNodeEmission", "ShaderNodeOutputMaterial"))
    tree.links.new(seen.outputs["View Z Depth"], glow.inputs["Strength"])
    glow.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    tree.links.new(glow.outputs["Emission"], output.inputs["Surface"])
    return material
