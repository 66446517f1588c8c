# SPDX-License-Identifier: GPL-3.0-or-later
"""The worker, the box, the shelf and the room of the examples. The add-on itself draws none of this.

World: the worker stands at the origin and faces +y, so x is to the worker's right, y ahead, z up. Metres.
"""
from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import bmesh
import bpy
from mathutils import Matrix, Vector
from mathutils.geometry import tessellate_polygon
from reachcast import native
from reachcast.rigs.skeleton import Skeleton
from reachcast.scene.mannequin import build_mannequin, standing_posture
from reachcast.scene.read_rig import read_rig

HOME = (0.0, 0.42, 0.10)
BOX_SIZE = (0.36, 0.28, 0.24)
BOX_MASS_KG = 6.0
HANDLE_HEIGHT = 0.14
#: The mannequin's fingertips lie in the plane of its grip: its hands meet the walls with this much between them.
GRIP_CLEARANCE = 0.012
HANDLE_WIDTH, HANDLE_TALL, HANDLE_DEPTH = 0.095, 0.032, 0.014
BOARD_SIZE = (0.56, 0.40, 0.028)
POST = 0.04
PAPER = 0.0004  # tape and print lie this much over the cardboard

Colour = tuple[float, float, float]


# ---------------------------------------------------------------- worker


def add_worker(kind: str, stature: float) -> bpy.types.Object:
    """The armature `Worker`, standing at the origin and facing +y: "mannequin" or "rigify" (the human metarig)."""
    worker = {"mannequin": _add_mannequin, "rigify": _add_metarig}[kind](stature)
    worker.name = worker.data.name = "Worker"
    bpy.context.view_layer.update()
    away = read_rig(worker).origin  # between the ankles, on the floor
    worker.location -= Vector((away[0], away[1], away[2]))
    bpy.context.view_layer.update()
    return worker


def _add_mannequin(stature: float) -> bpy.types.Object:
    worker = build_mannequin(bpy.context.collection, standing_posture(stature, None), None, name="Worker", stature=stature)
    worker.rotation_euler.z = math.pi
    return worker


def _add_metarig(stature: float) -> bpy.types.Object:
    bpy.ops.preferences.addon_enable(module="rigify")
    bpy.ops.object.armature_human_metarig_add()
    worker = bpy.context.object
    size = stature / read_rig(worker).height
    worker.scale = (size, size, size)
    bpy.ops.object.transform_apply(location=False, rotation=False, scale=True)
    worker.rotation_euler.z = math.pi
    bpy.context.view_layer.update()
    dress(worker, read_rig(worker), stature)
    return worker


def dress(rig: bpy.types.Object, skeleton: Skeleton, stature: float) -> None:
    """Hangs the mannequin's body, made for this rig's joints, on the rig's bones, so that a bare rig can be seen."""
    joints = {name: tuple(map(float, place)) for name, place in
              zip(native.core().JOINTS, skeleton.to_body(skeleton.joints))}
    helper = build_mannequin(bpy.context.collection, joints, None, name=rig.name, stature=stature)
    helper.matrix_world = _body_to_world(skeleton) @ Matrix.Rotation(math.pi, 4, "Z")
    bpy.context.view_layer.update()
    own = read_rig(helper)
    segment_of = {own.bones.names[bone]: segment for segment, bone in own.segments.items()}
    for piece in list(helper.children):
        segment = segment_of.get(piece.parent_bone, "")
        bone = skeleton.segments.get(segment, skeleton.segments.get(segment.replace("toe", "foot")))
        if bone is None and piece.parent_bone == "ribs":   # no segment of its own: it hangs below the chest
            chest = rig.data.bones[skeleton.bones.names[skeleton.segments["chest"]]]
            bone = skeleton.bones.names.index((chest.parent or chest).name)
        if bone is None:
            raise ValueError(f"Rig '{rig.name}' has no bone for the mannequin's {piece.parent_bone}")
        place = piece.matrix_world.copy()
        piece.parent, piece.parent_type, piece.parent_bone = rig, "BONE", skeleton.bones.names[bone]
        piece.matrix_parent_inverse = Matrix()
        piece.matrix_world = place
    armature = helper.data
    bpy.data.objects.remove(helper)
    bpy.data.armatures.remove(armature)


def _body_to_world(skeleton: Skeleton) -> Matrix:
    turn = Matrix([tuple(map(float, row)) for row in skeleton.axes]).transposed().to_4x4()
    return Matrix.Translation([float(part) for part in skeleton.origin]) @ turn


# ---------------------------------------------------------------- task


def facing_yaw(x: float, y: float) -> float:
    """The turn about z at which something at (x, y) faces the worker's feet."""
    return -math.atan2(x, y) if math.hypot(x, y) > 1e-6 else 0.0


def add_empty(name: str, place: Sequence[float], yaw: float = 0.0) -> bpy.types.Object:
    empty = bpy.data.objects.new(name, None)
    empty.location, empty.rotation_euler.z = place, yaw
    empty.empty_display_type, empty.empty_display_size = "PLAIN_AXES", 0.15
    bpy.context.collection.objects.link(empty)
    return empty


def add_box(place: Sequence[float]) -> bpy.types.Object:
    """The mesh `Box`: a taped carton with a hand hole in either side; its origin is the centre of its base."""
    mesh = bpy.data.meshes.new("Box")
    form = bmesh.new()
    _carton(form)
    _add_tape(form)
    _add_print(form, f"{BOX_MASS_KG:g} kg")
    form.to_mesh(mesh)
    form.free()
    for material in (cardboard(), plain("Hand Hole", (0.05, 0.028, 0.014), 0.9),
                     plain("Tape", (0.62, 0.45, 0.25), 0.3), plain("Print", (0.09, 0.045, 0.02), 0.8)):
        mesh.materials.append(material)
    box = bpy.data.objects.new("Box", mesh)
    box.location = place
    box["reachcast_handle_height"] = HANDLE_HEIGHT
    box["reachcast_grip_distance"] = BOX_SIZE[0] + GRIP_CLEARANCE
    box["reachcast_mass"] = BOX_MASS_KG
    bpy.context.collection.objects.link(box)
    return box


def _carton(form: bmesh.types.BMesh) -> None:
    """Rounded edges; the two sides along x are cut anew around a hole."""
    bmesh.ops.create_cube(form, size=1.0)
    for vertex in form.verts:
        vertex.co = (Vector((0.0, 0.0, 0.5)) + vertex.co) * Vector(BOX_SIZE)
    bmesh.ops.bevel(form, geom=form.edges[:], offset=0.005, segments=2, profile=0.5, affect="EDGES")
    for sign in (-1.0, 1.0):
        side = max(form.faces, key=lambda face: sign * face.normal.x * face.calc_area())
        _cut_hand_hole(form, side, sign)


def _cut_hand_hole(form: bmesh.types.BMesh, side: bmesh.types.BMFace, sign: float) -> None:
    rim = list(side.verts)
    bmesh.ops.delete(form, geom=[side], context="FACES_ONLY")
    x = rim[0].co.x
    hole = [form.verts.new((x, y, z)) for y, z in _slot()]
    bottom = [form.verts.new((x - sign * HANDLE_DEPTH, vertex.co.y, vertex.co.z)) for vertex in hole]
    corners = rim + hole
    for triangle in tessellate_polygon([[vertex.co for vertex in rim], [vertex.co for vertex in hole]]):
        form.faces.new([corners[index] for index in triangle])
    for index, vertex in enumerate(hole):
        after = (index + 1) % len(hole)
        form.faces.new((vertex, hole[after], bottom[after], bottom[index])).material_index = 1
    form.faces.new(bottom).material_index = 1
    form.normal_update()
    for face in form.faces:
        if any(vertex in bottom for vertex in face.verts):
            inward = Vector((x, 0.0, HANDLE_HEIGHT)) - face.calc_center_median()
            if face.normal.dot(inward + Vector((sign * 1e-3, 0.0, 0.0))) < 0.0:
                face.normal_flip()
        elif abs(face.calc_center_median().x - x) < 1e-5 and face.normal.x * sign < 0.0:
            face.normal_flip()


def _slot() -> list[tuple[float, float]]:
    """(y, z) around a slot with round ends."""
    radius, points = 0.5 * HANDLE_TALL, []
    for end in (1.0, -1.0):
        for step in range(9):
            angle = end * 0.5 * math.pi * (1.0 - step / 4.0)
            points.append((end * (0.5 * HANDLE_WIDTH - radius) + end * radius * math.cos(angle),
                           HANDLE_HEIGHT + radius * math.sin(angle)))
    return points


def _add_tape(form: bmesh.types.BMesh) -> None:
    """A strip over the seam of the flaps, and a little way down both sides."""
    half_width, height = 0.5 * BOX_SIZE[0] + PAPER, BOX_SIZE[2] + PAPER
    outline = [(-half_width, height - 0.055), (-half_width, height), (half_width, height), (half_width, height - 0.055)]
    rows = [[form.verts.new((x, y, z)) for y in (-0.024, 0.024)] for x, z in outline]
    for (a, b), (c, d) in zip(rows, rows[1:]):
        form.faces.new((a, c, d, b)).material_index = 2


def _add_print(form: bmesh.types.BMesh, text: str) -> None:
    """The mass on the front and the back."""
    curve = bpy.data.curves.new("Print", "FONT")
    curve.body, curve.size, curve.align_x, curve.align_y = text, 0.06, "CENTER", "CENTER"
    letters = bpy.data.objects.new("Print", curve)
    for turn in (0.0, math.pi):
        place = (Matrix.Rotation(turn, 4, "Z") @ Matrix.Translation((0.0, -0.5 * BOX_SIZE[1] - PAPER, 0.075))
                 @ Matrix.Rotation(0.5 * math.pi, 4, "X"))
        mesh = letters.to_mesh()
        mesh.transform(place)
        before = len(form.faces)
        form.from_mesh(mesh)
        form.faces.ensure_lookup_table()
        for face in form.faces[before:]:
            face.material_index = 3
        letters.to_mesh_clear()
    bpy.data.objects.remove(letters)
    bpy.data.curves.remove(curve)


# ---------------------------------------------------------------- furniture


@dataclass(frozen=True)
class Beam:
    """A cuboid by its lowest and its highest corner."""

    low: tuple[float, float, float]
    high: tuple[float, float, float]
    material: int = 0


def add_shelf_board(shelf: bpy.types.Object) -> bpy.types.Object:
    """The mesh `Shelf Board`: its top lies under the Empty and turns with it; two posts stand at its far side."""
    width, depth, thick = BOARD_SIZE
    top = float(shelf.location.z)
    thick = min(thick, max(0.5 * top, 0.004))
    beams = [Beam((-0.5 * width, -0.5 * depth, -thick), (0.5 * width, 0.5 * depth, 0.0))]
    for side in (-1.0, 1.0):
        middle = side * (0.5 * width - 1.5 * POST)
        beams.append(Beam((middle - 0.5 * POST, 0.5 * depth, -top), (middle + 0.5 * POST, 0.5 * depth + POST, 0.12), 1))
        beams.append(Beam((middle - 0.4 * POST, -0.25 * depth, -thick - 0.03),
                          (middle + 0.4 * POST, 0.5 * depth, -thick), 1))
    board = add_beams("Shelf Board", beams, (wood(), plain("Steel", (0.055, 0.065, 0.08), 0.45)))
    board.location, board.rotation_euler.z = shelf.location, shelf.rotation_euler.z
    return board


def add_pallet(home: bpy.types.Object) -> bpy.types.Object:
    """The mesh `Pallet` under the box's first place."""
    top, width, depth = float(home.location.z), 0.56, 0.40
    plank = min(0.022, 0.3 * top)
    beams = [Beam((-0.5 * width, y - 0.034, -plank), (0.5 * width, y + 0.034, 0.0))
             for y in (-0.166, -0.083, 0.0, 0.083, 0.166)]
    beams += [Beam((x - 0.035, -0.5 * depth, plank - top), (x + 0.035, 0.5 * depth, -plank))
              for x in (-0.245, 0.0, 0.245)]
    beams += [Beam((-0.5 * width, y - 0.034, -top), (0.5 * width, y + 0.034, plank - top))
              for y in (-0.166, 0.0, 0.166)]
    pallet = add_beams("Pallet", beams, (wood(),))
    pallet.location, pallet.rotation_euler.z = home.location, home.rotation_euler.z
    return pallet


def add_beams(name: str, beams: Iterable[Beam], materials: Sequence[bpy.types.Material]) -> bpy.types.Object:
    """One mesh of cuboids with softened edges."""
    form = bmesh.new()
    for beam in beams:
        low, high = Vector(beam.low), Vector(beam.high)
        place = Matrix.Translation(0.5 * (low + high)) @ Matrix.Diagonal((*(high - low), 1.0))
        made = bmesh.ops.create_cube(form, size=1.0, matrix=place)
        for face in {face for vertex in made["verts"] for face in vertex.link_faces}:
            face.material_index = beam.material
    mesh = bpy.data.meshes.new(name)
    form.to_mesh(mesh)
    form.free()
    for material in materials:
        mesh.materials.append(material)
    item = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(item)
    edges = item.modifiers.new("Soft Edges", "BEVEL")
    edges.width, edges.segments, edges.limit_method = 0.003, 2, "ANGLE"
    return item


# ---------------------------------------------------------------- materials


def _material(name: str, make: Callable[[bpy.types.Material], None]) -> bpy.types.Material:
    material = bpy.data.materials.get(name)
    if material is None:
        material = bpy.data.materials.new(name)
        material.use_nodes = True
        make(material)
    return material


def plain(name: str, colour: Colour, roughness: float) -> bpy.types.Material:
    def make(material: bpy.types.Material) -> None:
        shader = material.node_tree.nodes["Principled BSDF"]
        shader.inputs["Base Color"].default_value = (*colour, 1.0)
        shader.inputs["Roughness"].default_value = roughness
        material.diffuse_color = (*colour, 1.0)
    return _material(name, make)


def grained(name: str, dark: Colour, light: Colour, scale: tuple[float, float, float]) -> bpy.types.Material:
    """Two colours mixed by noise that is stretched along the object's axes."""
    def make(material: bpy.types.Material) -> None:
        nodes, links = material.node_tree.nodes, material.node_tree.links
        place, stretch, noise, ramp = (nodes.new(kind) for kind in (
            "ShaderNodeTexCoord", "ShaderNodeMapping", "ShaderNodeTexNoise", "ShaderNodeValToRGB"))
        stretch.inputs["Scale"].default_value = scale
        noise.inputs["Scale"].default_value, noise.inputs["Detail"].default_value = 1.0, 1.0
        ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[0].position = (*dark, 1.0), 0.3
        ramp.color_ramp.elements[1].color, ramp.color_ramp.elements[1].position = (*light, 1.0), 0.7
        shader = nodes["Principled BSDF"]
        shader.inputs["Roughness"].default_value = 0.75
        links.new(place.outputs["Object"], stretch.inputs["Vector"])
        links.new(stretch.outputs["Vector"], noise.inputs["Vector"])
        links.new(noise.outputs["Fac"], ramp.inputs["Fac"])
        links.new(ramp.outputs["Color"], shader.inputs["Base Color"])
        material.diffuse_color = (*light, 1.0)
    return _material(name, make)


def cardboard() -> bpy.types.Material:
    return grained("Cardboard", (0.33, 0.185, 0.085), (0.40, 0.23, 0.11), (30.0, 30.0, 4.0))


def wood() -> bpy.types.Material:
    return grained("Wood", (0.42, 0.29, 0.16), (0.56, 0.41, 0.25), (3.0, 45.0, 45.0))
