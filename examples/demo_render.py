# SPDX-License-Identifier: GPL-3.0-or-later
"""Light, camera and pictures of the examples: a quiet studio, frames by EEVEE, film and contact sheet by ffmpeg."""
from __future__ import annotations

import math
import os
import subprocess
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector

WIDTH, HEIGHT = 960, 720
QUICK_PERCENT, QUICK_STEP = 40, 8
SAMPLES = 5  # without a graphics card every one costs about a second of processor time
BACKDROP = (0.19, 0.235, 0.28)
FLOOR = (0.20, 0.235, 0.27)
SKY = (0.30, 0.34, 0.38)
LENS_MM = 50.0
CAMERA_SIDE_DEG, CAMERA_UP_DEG = 62.0, 14.0  # from straight ahead of the worker; above the horizon
MARGIN_M = 0.13
FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"
LAST_FRAME_SECONDS = 0.8  # the film rests on its last frame


@dataclass(frozen=True)
class Moment:
    """A picture of the contact sheet."""

    frame: int
    label: str


# ---------------------------------------------------------------- studio


def add_studio(centre: Vector, toward_left: bool) -> None:
    """Floor, background and light. `centre`: what the light is for, world metres; the key comes from the camera's
    side."""
    side = 1.0 if toward_left else -1.0
    _set_world()
    _add_floor()
    _add_light("Key Sun", "SUN", centre + Vector((-2.0 * side, 2.0, 4.2)), centre, 3.2, size=math.radians(5.0),
               shadow=True, colour=(1.0, 0.96, 0.90))
    _add_light("Fill", "AREA", centre + Vector((2.5 * side, 3.5, 1.5)), centre, 55.0, size=3.0, shadow=False,
               colour=(0.85, 0.92, 1.0))
    _add_light("Rim", "AREA", centre + Vector((1.2 * side, -3.5, 2.6)), centre, 120.0, size=1.5, shadow=False,
               colour=(0.9, 0.95, 1.0))


def _set_world() -> None:
    """The camera sees the backdrop, darker towards the top; everything else is lit by an even sky."""
    world = bpy.context.scene.world or bpy.data.worlds.new("Studio")
    bpy.context.scene.world = world
    world.use_nodes = True
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


def _add_floor() -> None:
    """A wide floor with a thin line every half metre, which dissolves into the background."""
    mesh = bpy.data.meshes.new("Floor")
    mesh.from_pydata([(-40, -40, 0), (40, -40, 0), (40, 40, 0), (-40, 40, 0)], [], [(0, 1, 2, 3)])
    floor = bpy.data.objects.new("Floor", mesh)
    bpy.context.collection.objects.link(floor)
    material = bpy.data.materials.new("Floor")
    material.use_nodes = True
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
    """The floor's colour: lighter within 4 mm of a multiple of half a metre."""
    place, parts, mix = (tree.nodes.new(kind) for kind in (
        "ShaderNodeTexCoord", "ShaderNodeSeparateXYZ", "ShaderNodeMixRGB"))
    tree.links.new(place.outputs["Object"], parts.inputs["Vector"])
    near = [_math(tree, "PINGPONG", parts.outputs[axis], 0.25) for axis in "XY"]
    line = _math(tree, "LESS_THAN", _math(tree, "MINIMUM", *near), 0.004)
    tree.links.new(_math(tree, "MULTIPLY", line, 0.35), mix.inputs["Fac"])
    mix.inputs["Color1"].default_value = (*FLOOR, 1.0)
    mix.inputs["Color2"].default_value = (0.55, 0.60, 0.65, 1.0)
    return mix.outputs["Color"]


def _distance(tree: bpy.types.NodeTree, near: float, far: float) -> bpy.types.NodeSocket:
    """0 within `near` metres of the origin, rising smoothly to 1 at `far`."""
    place, length, ramp = (tree.nodes.new(kind) for kind in (
        "ShaderNodeTexCoord", "ShaderNodeVectorMath", "ShaderNodeMapRange"))
    length.operation, ramp.interpolation_type = "LENGTH", "SMOOTHSTEP"
    tree.links.new(place.outputs["Object"], length.inputs[0])
    tree.links.new(length.outputs["Value"], ramp.inputs["Value"])
    ramp.inputs["From Min"].default_value, ramp.inputs["From Max"].default_value = near, far
    return ramp.outputs["Result"]


def _add_light(name: str, kind: str, place: Vector, target: Vector, energy: float, *, size: float, shadow: bool,
               colour: tuple[float, float, float]) -> None:
    data = bpy.data.lights.new(name, kind)
    data.energy, data.color, data.use_shadow = energy, colour, shadow
    if kind == "SUN":
        data.angle, data.shadow_cascade_max_distance = size, 12.0
        data.use_contact_shadow = True
        data.contact_shadow_distance, data.contact_shadow_thickness = 0.06, 0.03
    else:
        data.size = size
    light = bpy.data.objects.new(name, data)
    light.location = place
    light.rotation_euler = (target - place).to_track_quat("-Z", "Y").to_euler()
    bpy.context.collection.objects.link(light)


# ---------------------------------------------------------------- camera


def bounds_over(objects: Sequence[bpy.types.Object], frames: Iterable[int]) -> np.ndarray:
    """(N, 3) world: the corners of every object's bounds in every frame."""
    scene, corners = bpy.context.scene, []
    kept = scene.frame_current
    for frame in frames:
        scene.frame_set(frame)
        graph = bpy.context.evaluated_depsgraph_get()
        for item in objects:
            shown = item.evaluated_get(graph)
            corners += [tuple(shown.matrix_world @ Vector(corner)) for corner in shown.bound_box]
    scene.frame_set(kept)
    return np.unique(np.round(corners, 3), axis=0)


def add_camera(points: np.ndarray, toward_left: bool) -> bpy.types.Object:
    """A camera ahead of the worker, to the left or to the right, that sees all `points` with some room around."""
    scene = bpy.context.scene
    data = bpy.data.cameras.new("Camera")
    data.lens = LENS_MM
    camera = bpy.data.objects.new("Camera", data)
    scene.collection.objects.link(camera)
    scene.camera = camera
    side, up = math.radians(CAMERA_SIDE_DEG) * (-1.0 if toward_left else 1.0), math.radians(CAMERA_UP_DEG)
    away = Vector((math.sin(side) * math.cos(up), math.cos(side) * math.cos(up), math.sin(up)))
    camera.rotation_euler = (-away).to_track_quat("-Z", "Y").to_euler()
    bpy.context.view_layer.update()
    room = MARGIN_M * np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    spread = (points[:, None, :] + room).reshape(-1, 3)
    place, _ = camera.camera_fit_coords(bpy.context.evaluated_depsgraph_get(), spread.ravel().tolist())
    camera.location = place
    return camera


def look_through_camera() -> None:
    """Whoever opens the file sees the scene as it is rendered."""
    for area in bpy.data.screens["Layout"].areas:
        if area.type == "VIEW_3D":
            area.spaces.active.region_3d.view_perspective = "CAMERA"
            area.spaces.active.shading.type = "MATERIAL"
            area.spaces.active.show_region_ui = True


# ---------------------------------------------------------------- frames


def set_render(quick: bool) -> None:
    scene = bpy.context.scene
    render, eevee = scene.render, scene.eevee
    render.engine = "BLENDER_EEVEE"
    render.resolution_x, render.resolution_y = WIDTH, HEIGHT
    render.resolution_percentage = QUICK_PERCENT if quick else 100
    render.image_settings.file_format, render.image_settings.compression = "PNG", 15
    eevee.taa_render_samples = 4 if quick else SAMPLES
    eevee.use_soft_shadows, eevee.use_shadow_high_bitdepth = True, True
    eevee.shadow_cascade_size = "2048"
    eevee.use_gtao, eevee.gtao_distance, eevee.gtao_factor = True, 0.35, 1.2
    eevee.gi_cubemap_resolution, eevee.gi_filter_quality = "128", 1.0  # made anew for every frame: the sky is plain
    eevee.use_ssr = eevee.use_bloom = eevee.use_motion_blur = False
    scene.view_settings.view_transform = "Filmic"
    scene.view_settings.look = "Medium High Contrast"


def render_frames(folder: Path, frames: Sequence[int]) -> dict[int, Path]:
    """One PNG per frame; says now and then how far it is."""
    scene, pictures = bpy.context.scene, {}
    kept = scene.render.filepath
    for number, frame in enumerate(frames):
        scene.frame_set(frame)
        pictures[frame] = folder / f"{frame:04d}.png"
        scene.render.filepath = os.fspath(pictures[frame])
        with quiet(folder / "blender.log"):
            bpy.ops.render.render(write_still=True)
        if (number + 1) % 10 == 0 or number + 1 == len(frames):
            print(f"Rendered {number + 1} of {len(frames)} frames", flush=True)
    scene.render.filepath = kept
    return pictures


@contextmanager
def quiet(log: Path) -> Iterator[None]:
    """What Blender prints meanwhile goes to a file."""
    sys.stdout.flush()
    kept = [os.dup(stream) for stream in (1, 2)]
    with log.open("ab") as file:
        for stream in (1, 2):
            os.dup2(file.fileno(), stream)
    try:
        yield
    finally:
        sys.stdout.flush()  # an operator's report is still in Python's buffer
        for stream, copy in zip((1, 2), kept):
            os.dup2(copy, stream)
            os.close(copy)


# ---------------------------------------------------------------- film and contact sheet


def ffmpeg(*arguments: str) -> None:
    done = subprocess.run(["ffmpeg", "-nostdin", "-v", "error", "-y", *arguments], capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"ffmpeg failed: {done.stderr.strip()}")


def write_film(pictures: Sequence[Path], frame_rate: float, path: Path) -> None:
    """H.264 that every player opens: even size, 4:2:0, index at the front."""
    listing = path.with_suffix(".txt")
    listing.write_text("".join(f"file '{picture.name}'\nduration {1.0 / frame_rate:.6f}\n" for picture in pictures))
    rest = f"tpad=stop_mode=clone:stop_duration={LAST_FRAME_SECONDS},fps={frame_rate:g}"
    ffmpeg("-f", "concat", "-i", os.fspath(listing), "-vf", rest, "-c:v", "libx264", "-preset", "slow", "-crf", "18",
           "-pix_fmt", "yuv420p", "-movflags", "+faststart", os.fspath(path))
    listing.unlink()


def write_contact_sheet(moments: Sequence[Moment], pictures: dict[int, Path], path: Path) -> None:
    """Three columns, two rows; under each picture what it shows."""
    inputs = [part for moment in moments for part in ("-i", os.fspath(pictures[moment.frame]))]
    chains = []
    for number, moment in enumerate(moments):
        text = f"drawtext=fontfile={FONT}:text='{moment.label}':fontsize=19:fontcolor=0x202830:x=10:y=h-30"
        chains.append(f"[{number}]scale=480:360:flags=lanczos,pad=480:400:0:0:0xf2f4f6,{text},"
                      f"pad=492:412:6:6:0xf2f4f6[p{number}]")
    rows = ["".join(f"[p{number}]" for number in row) for row in ((0, 1, 2), (3, 4, 5))]
    chains += [f"{rows[0]}hstack=3[upper]", f"{rows[1]}hstack=3[lower]", "[upper][lower]vstack,pad=iw:ih:0:0[sheet]"]
    ffmpeg(*inputs, "-filter_complex", ";".join(chains), "-map", "[sheet]", "-frames:v", "1", os.fspath(path))
