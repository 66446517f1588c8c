# SPDX-License-Identifier: GPL-3.0-or-later
"""Who does a task and with what, in Blender's scene. A rig is read once for all the tasks of its person."""
from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import bpy
import numpy as np
from mathutils import Vector

from .. import native
from ..rigs.rig_presets import PRESETS_FOLDER
from ..rigs.rotations import Array
from ..rigs.skeleton import Skeleton
from ..scene.carry import remove_holds
from ..scene.mannequin import build_mannequin, dress_mannequin, remove_with_meshes, standing_posture
from ..scene.prepare import Prepared, refuse_owners
from ..scene.read_rig import read_rig
from ..scene.read_task import BOX_MASS, ONE_HAND_MASS, ONE_HAND_SIZE, BoxShape, lift_between, read_box, standing
from ..scene.reused_actions import ReusedActions
from ..scene.transforms import Placement, above_matrix, placement
from .tasks import Task, Unit

DEFAULT_STATURE = 1.75
DEFAULT_BOX = (0.35, 0.30, 0.25)
MOST_KEPT_BOXES = 8   #: that were made for tasks and stay in the scene
MANNEQUIN_BONES = PRESETS_FOLDER / "mannequin.json"   #: to recognise them anew takes longer than a motion
WITHOUT_SURFACES = frozenset({"csv", "bvh", "action"})   #: outputs for which a mannequin is an armature only


@dataclass(frozen=True)
class Worker:
    rig: bpy.types.Object
    skeleton: Skeleton


@dataclass(frozen=True)
class Load:
    box: bpy.types.Object
    shape: BoxShape
    above: Array      #: (4, 4): world = above @ the box's own transform


Person = tuple[object, ...]


def person_of(task: Task) -> Person:
    """Tasks with the same one are done by the same rig."""
    return (task.rig, None if task.rig else (task.stature or DEFAULT_STATURE), None if task.rig else task.sex)


def carried_by(task: Task) -> tuple[tuple[float, ...] | str, float | None]:
    """Size or name of what is carried, and its mass; None: what the mesh says, else 5 kg."""
    if task.object is None and task.hands != "both":
        return ONE_HAND_SIZE, ONE_HAND_MASS if task.load is None else task.load
    return task.object or DEFAULT_BOX, task.load


class Stage:
    """Rigs and boxes by task. `corpus` is an opened reachcast_core.Corpus."""

    def __init__(self, corpus: Any) -> None:
        self.corpus, self.scene = corpus, bpy.context.scene
        self.frame_rate = self.scene.render.fps / self.scene.render.fps_base
        self.actions = ReusedActions()
        self._workers: dict[Person, Worker] = {}
        self._loads: dict[tuple[Person, object, float | None], Load] = {}
        self._checked: set[tuple[str, str]] = set()
        self._places: dict[str, Placement] = {}

    def prepared(self, unit: Unit) -> tuple[Prepared, Worker, Load]:
        """Everything `solve` needs. ValueError in one sentence."""
        task = unit.task
        worker, load = self._worker(task), self._load(task)
        skeleton = worker.skeleton
        self._show_only(worker, load)
        if task.rig is not None or isinstance(task.object, str):
            self._refuse_unwritable(worker, load)
        if task.home is not None:
            home = self._placed(task.home, skeleton)
        else:
            home = standing(load.box, load.shape) if isinstance(task.object, str) else None
        lift = lift_between(skeleton, load.shape, home, self._placed(task.target, skeleton),
                            stands=task.home is None, hands=task.hands)
        subject = native.core().Subject(task.stature or skeleton.height, sex=task.sex, age=task.age, mass=task.mass)
        options: dict[str, object] = {"frame_rate": self.frame_rate, "phases": list(task.phases)}
        if unit.seed is not None:
            options["variation"] = {"seed": unit.seed}
        return Prepared(skeleton, lift, subject, self.corpus, options), worker, load

    def close(self) -> None:
        """Takes what was made for tasks out of the scene."""
        for person in {key[0] for key in self._loads}:
            self._drop_loads(person)
        self._drop_made()
        self.actions.close()

    def _show_only(self, worker: Worker, load: Load) -> None:
        """Of what was made for tasks, pictures have only this."""
        made = [each.rig for person, each in self._workers.items() if person[0] is None]
        made += [each.box for key, each in self._loads.items() if not isinstance(key[1], str)]
        for item in made:
            hidden = item not in (worker.rig, load.box)
            if item.hide_render != hidden:
                for part in (item, *item.children):
                    part.hide_render = hidden

    def _refuse_unwritable(self, worker: Worker, load: Load) -> None:
        """ValueError when an Action would not be all that moves the scene's own rig or box; looked at once a pair."""
        pair = (worker.rig.name, load.box.name)
        if pair not in self._checked:
            refuse_owners(worker.rig, worker.skeleton, load.box, bpy.context.view_layer)
            self._checked.add(pair)

    def _worker(self, task: Task) -> Worker:
        key = person_of(task)
        if key not in self._workers:
            if task.rig is not None:
                rig = _named(task.rig, "rig")
            else:
                self._drop_made()  # tasks come person by person; what else is in the scene makes evaluating it slower
                stature = task.stature or DEFAULT_STATURE
                rig = add_mannequin(stature, task.sex, " ".join(filter(None, ["Worker", f"{stature:g}", task.sex])),
                                    dressed=False)
            self._workers[key] = Worker(rig, read_rig(rig, None if task.rig else MANNEQUIN_BONES))
        worker = self._workers[key]
        if task.rig is None and not WITHOUT_SURFACES.issuperset(task.outputs) and not worker.rig.children:
            dress_mannequin(worker.rig, standing_posture(task.stature or DEFAULT_STATURE, task.sex))
        return worker

    def _load(self, task: Task) -> Load:
        what, mass = carried_by(task)
        key = (person_of(task), what, mass)
        if key not in self._loads:
            if isinstance(what, str):
                box = _named(what, "object")
                shape = read_box(box)
                if mass is not None:
                    shape = replace(shape, mass=mass)
            else:
                if len(self._loads) >= MOST_KEPT_BOXES:
                    self._drop_loads(next(iter(self._loads))[0])
                heavy = "" if mass is None else f" {mass:g} kg"
                box = add_cuboid(what, f"Box {'x'.join(map('{:g}'.format, what))}{heavy}")
                if mass is not None:
                    box[BOX_MASS] = mass
                shape = read_box(box)
            self._loads[key] = Load(box, shape, above_matrix(box))
        return self._loads[key]

    def _drop_made(self) -> None:
        for person in [person for person in self._workers if person[0] is None]:
            self._drop_loads(person)
            rig = self._workers.pop(person).rig
            self.actions.forget(rig)
            remove_made(rig)

    def _drop_loads(self, person: Person) -> None:
        """A box that was made goes with its worker: the order of objects in the scene is the same for every task."""
        for key in [key for key in self._loads if key[0] == person]:
            load = self._loads.pop(key)
            if not isinstance(key[1], str):
                self.actions.forget(load.box)
                remove_made(load.box)

    def _placed(self, place: tuple[float, ...] | str, skeleton: Skeleton) -> Placement:
        """Numbers without a turn face the worker's feet."""
        if isinstance(place, str):
            if place not in self._places:  # nothing moves while a batch runs, and evaluating the scene takes long
                self._places[place] = placement(_named(place, "place"))
            return self._places[place]
        origin = np.array(place[:3])
        if len(place) == 4:
            return Placement(origin, _about_z(math.radians(place[3])), np.ones(3))
        x, y, _ = skeleton.to_body(origin)
        facing = -math.atan2(x, y) if math.hypot(x, y) > 1e-6 else 0.0
        return Placement(origin, skeleton.axes.T @ _about_z(facing), np.ones(3))


def add_mannequin(stature: float, sex: str | None, name: str = "Worker", *, dressed: bool = True) -> bpy.types.Object:
    """Standing at the origin, facing +y."""
    rig = build_mannequin(bpy.context.scene.collection, standing_posture(stature, sex), sex, name=name, stature=stature,
                          dressed=dressed)
    rig.rotation_euler.z = math.pi
    bpy.context.view_layer.update()
    rig.location -= Vector(read_rig(rig, MANNEQUIN_BONES).origin.tolist())
    bpy.context.view_layer.update()
    return rig


def add_cuboid(size: tuple[float, ...], name: str = "Box") -> bpy.types.Object:
    """A box whose origin is the middle of its base."""
    mesh = bpy.data.meshes.new(name)
    corners = [(a * size[0] / 2, b * size[1] / 2, c * size[2]) for a in (-1, 1) for b in (-1, 1) for c in (0, 1)]
    mesh.from_pydata(corners, [], [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
    mesh.materials.append(_cardboard())
    box = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(box)
    return box


def _cardboard() -> bpy.types.Material:
    material = bpy.data.materials.get("Cardboard")
    if material is None:
        material = bpy.data.materials.new("Cardboard")
        material.use_nodes = True
        material.diffuse_color = material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (
            0.40, 0.23, 0.11, 1.0)
    return material


def _about_z(angle: float) -> Array:
    cosine, sine = math.cos(angle), math.sin(angle)
    return np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])


def _named(name: str, what: str) -> bpy.types.Object:
    item = bpy.context.scene.objects.get(name)
    if item is None:
        raise ValueError(f"The {what} '{name}' is not in the scene")
    return item


def remove_made(rig_or_box: bpy.types.Object) -> None:
    """What was made for tasks, and what goes with its hands."""
    remove_holds(rig_or_box)
    remove_with_meshes(rig_or_box)
