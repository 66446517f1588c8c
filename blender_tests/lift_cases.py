# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes of a lift: a rig of a stature, a shelf, a home and a box; and what the evaluated scene shows of them, read
from bones' heads and tails and objects' matrices alone."""
from __future__ import annotations

import itertools
import math
import random
from collections.abc import Iterator
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix
from reachcast.scene.predict_action import PredictionResult, predict_motion
from reachcast.scene.read_rig import read_rig
from rig_cases import RIGS, metarig

STATURES = (1.50, 1.60, 1.72, 1.85, 1.95)
HEIGHTS = (0.1, 0.4, 0.7, 1.0, 1.3, 1.6, 1.9)   #: metres, of the shelf
BEARINGS = (60, 0, -60)                         #: degrees from straight ahead, to the left
DISTANCES = (0.40, 0.55)                        #: metres from the middle of the ankles
HOMES = {"floor": (0.42, 0.0), "waist": (0.40, 0.9)}  #: metres ahead and up
BOX_SIZE = (0.36, 0.28, 0.24)
GRIP_DISTANCE = BOX_SIZE[0] + 0.04              #: that read_box assumes
HANDLE_HEIGHT = 0.5 * BOX_SIZE[2]


@dataclass(frozen=True)
class Place:
    """Where a shelf is, seen from the body."""

    height: float
    bearing: float   #: degrees to the left
    distance: float
    facing: bool     #: the box is turned to face the body; else it stands as at home

    @property
    def is_sane(self) -> bool:
        """Anyone of these statures can put a box there."""
        return 0.4 <= self.height <= 1.3 and self.distance <= 0.55

    def matrix(self) -> Matrix:
        """In the space of a rig at the origin, which faces -y and has its left at +x."""
        angle = math.radians(self.bearing)
        turn = angle if self.facing else 0.0
        return Matrix.Translation((self.distance * math.sin(angle), -self.distance * math.cos(angle), self.height)) \
            @ Matrix.Rotation(turn, 4, "Z")

    def __str__(self) -> str:
        side = "left" if self.bearing > 0 else "right" if self.bearing < 0 else "ahead"
        return f"{self.height} m high, {self.distance} m {side}{', turned' if self.facing and self.bearing else ''}"


@dataclass(frozen=True)
class Case:
    rig: str
    stature: float
    place: Place
    home: str

    def __str__(self) -> str:
        return f"{self.rig} {self.stature} m, home {self.home}, shelf {self.place}"


def all_cases(rig: str) -> Iterator[Case]:
    for stature, height, bearing, distance, home in itertools.product(STATURES, HEIGHTS, BEARINGS, DISTANCES, HOMES):
        yield Case(rig, stature, Place(height, bearing, distance, facing=distance > 0.5), home)


def drawn_cases(rig: str, count: int, seed: int) -> list[Case]:
    """Every shelf height and bearing for the shortest and the tallest, then `count` others at random."""
    cases = list(all_cases(rig))
    draw = random.Random(seed)
    corners = [case for case in cases if case.stature in (STATURES[0], STATURES[-1])
               and case.home == ("floor" if case.place.bearing else "waist")
               and case.place.distance == (DISTANCES[0] if case.place.height in (0.4, 1.3, 1.9) else DISTANCES[1])]
    others = [case for case in cases if case not in corners]
    return corners + draw.sample(others, min(count, len(others)))


def rig_of(name: str, stature: float) -> bpy.types.Object:
    """The mannequin as the menu makes it, or the metarig scaled to the stature."""
    if name == "mannequin":
        bpy.ops.reachcast.add_mannequin(stature=stature)
        return bpy.context.object
    rig = metarig() if name == "metarig" else RIGS[name]()
    bpy.context.view_layer.update()
    rig.scale = (stature / read_rig(rig).height,) * 3
    bpy.context.view_layer.update()
    return rig


def empty(name: str, matrix: Matrix) -> bpy.types.Object:
    item = bpy.data.objects.new(name, None)
    bpy.context.collection.objects.link(item)
    item.matrix_world = matrix
    return item


def cuboid(name: str, size: tuple[float, float, float]) -> bpy.types.Object:
    """A box whose origin is the middle of its base."""
    mesh = bpy.data.meshes.new(name)
    corners = [(a * size[0] / 2, b * size[1] / 2, c * size[2]) for a in (-1, 1) for b in (-1, 1) for c in (0, 1)]
    mesh.from_pydata(corners, [], [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
    item = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(item)
    return item


@dataclass(frozen=True)
class LiftScene:
    """One worker and what is carried where; the same objects serve many cases."""

    rig: bpy.types.Object
    shelf: bpy.types.Object
    home: bpy.types.Object
    box: bpy.types.Object

    def arrange(self, place: Place, home: str, around: Matrix = Matrix()) -> None:
        """Puts shelf, home and box where they belong around a rig that stands at `around`; drops earlier Actions."""
        for item in (self.rig, self.box):
            if item.animation_data and item.animation_data.drivers:
                item.animation_data.action = None  # the drivers are the rig's own
            else:
                item.animation_data_clear()
        for bone in self.rig.pose.bones:
            bone.matrix_basis = Matrix()
        ahead, up = HOMES[home]
        self.shelf.matrix_world = around @ place.matrix()
        self.home.matrix_world = around @ Matrix.Translation((0.0, -ahead, up))
        self.box.matrix_world = self.home.matrix_world
        for action in list(bpy.data.actions):
            bpy.data.actions.remove(action)
        bpy.context.view_layer.update()

    def predict(self, corpus: object, **options: object) -> PredictionResult:
        return predict_motion(self.rig, self.shelf, corpus=corpus, home=self.home, box=self.box, **options)


def lift_scene(rig: bpy.types.Object) -> LiftScene:
    return LiftScene(rig, empty("Shelf", Matrix()), empty("Home", Matrix()), cuboid("Box", BOX_SIZE))


@dataclass(frozen=True)
class Seen:
    """World positions over frames, metres: rows are frames."""

    grips: np.ndarray    #: (F, 2, 3) left, right: tails of the hand bones
    handles: np.ndarray  #: (F, 2, 3) left, right
    boxes: np.ndarray    #: (F, 4, 4)
    feet: np.ndarray     #: (F, 4, 3) left foot's head and tail, right foot's
    lengths: np.ndarray  #: (F, B) of all bones, as parts of their rest length in the world


def see(scene: LiftScene, frames: range) -> Seen:
    """Steps through the frames and reads Blender's own results. Hands and feet are `hand.L`, ..., `foot.R`."""
    shown = []
    for frame in frames:
        bpy.context.scene.frame_set(frame)
        graph = bpy.context.evaluated_depsgraph_get()
        rig, box = scene.rig.evaluated_get(graph), scene.box.evaluated_get(graph)
        world, bones = rig.matrix_world, rig.pose.bones
        grips = [world @ bones[f"hand.{side}"].tail for side in "LR"]
        handles = [box.matrix_world @ Matrix.Translation((side * GRIP_DISTANCE, 0.0, HANDLE_HEIGHT)).translation
                   for side in (0.5, -0.5)]
        feet = [world @ end for side in "LR" for end in (bones[f"foot.{side}"].head, bones[f"foot.{side}"].tail)]
        size = world.to_scale()[0]
        lengths = [(world @ bone.tail - world @ bone.head).length / (size * bone.bone.length) for bone in bones]
        shown.append((grips, handles, np.array(box.matrix_world), feet, lengths))
    grips, handles, boxes, feet, lengths = zip(*shown)
    handles = np.array(handles)
    if np.linalg.norm(np.array(grips)[0] - handles[0]) > np.linalg.norm(np.array(grips)[0] - handles[0, ::-1]):
        handles = handles[:, ::-1]  # the box stands with its x the other way
    return Seen(np.array(grips), handles, np.array(boxes), np.array(feet), np.array(lengths))
