# SPDX-License-Identifier: GPL-3.0-or-later
"""The same task done by people of other sizes, side by side: a mannequin for each, where the rig stands."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
from mathutils import Matrix

from ..people import FAMILY, Person
from ..rigs.skeleton import Skeleton
from .ghosts import perform_aside
from .mannequin import build_mannequin, remove_with_meshes, standing_posture
from .predict_action import PredictionResult
from .prepare import prepare, solve
from .read_rig import read_rig
from .steps import Progress, Steps, run_to_end
from .transforms import layer_of


@dataclass(frozen=True)
class FamilyResult:
    results: tuple[tuple[Person, PredictionResult], ...]   #: in the order of the members
    failed: tuple[tuple[Person, str], ...]                 #: who cannot do it, and why
    collection: str


def predict_family(rig: bpy.types.Object, shelf: bpy.types.Object, **options: object) -> FamilyResult:
    """All of `family_steps` at once."""
    return run_to_end(family_steps(rig, shelf, **options))  # type: ignore[arg-type]


def family_steps(rig: bpy.types.Object, shelf: bpy.types.Object, *, members: Sequence[Person] = FAMILY,
                 spacing: float = 1.2, box: bpy.types.Object | None = None, start_frame: int | None = None,
                 scene: bpy.types.Scene | None = None, bone_map: object = None, stature: float | None = None,
                 sex: str | None = None, mass: float | None = None, **options: object) -> Steps[FamilyResult]:
    """Predicts the task of `predict_motion` for every member, on a mannequin of its stature and sex.

    Each is predicted where `rig` stands, with the same shelf and home, and then shown `spacing` metres farther to the
    rig's right, with a copy of the box, in a new collection; `rig` itself, its stature, sex and body mass are left out.
    Who cannot do it is named in `failed` with the reason and leaves nothing behind; ValueError when that is true of
    all, or for bad input. A step is a member.
    """
    if not members:
        raise ValueError("The family has no members; name at least one")
    if not 0.0 <= spacing <= 100.0:
        raise ValueError(f"The spacing of the family is {spacing!r} m; it must be from 0 to 100")
    scene = scene or bpy.context.scene
    layer = layer_of(scene)
    stand = read_rig(rig, bone_map, layer)
    first = scene.frame_current if start_frame is None else int(start_frame)
    collection = bpy.data.collections.new(f"Family to {shelf.name}")
    scene.collection.children.link(collection)
    results, failed = [], []
    for number, person in enumerate(members):
        if (yield Progress(number, len(members))):
            break
        worker = _mannequin(person, stand, collection)
        try:
            prepared = prepare(worker, shelf, box=box, scene=scene, stature=person.stature, sex=person.sex, **options)
            solved = solve(prepared)
        except ValueError as error:
            remove_with_meshes(worker)
            failed.append((person, str(error)))
            continue
        aside = (len(results) + 1) * spacing
        results.append((person, perform_aside(prepared, solved, worker, box, f"to {shelf.name}", first, aside,
                                              collection, layer)))
    if not results:
        bpy.data.collections.remove(collection)
        if not failed:
            raise ValueError("The family was stopped before its first member was finished")
        raise ValueError(f"Nobody of the family can do it; the {failed[0][0]}: {failed[0][1]}")
    return FamilyResult(tuple(results), tuple(failed), collection.name)


def _mannequin(person: Person, stand: Skeleton, collection: bpy.types.Collection) -> bpy.types.Object:
    """At the rig's place and facing where it does; its name is shown in the view."""
    worker = build_mannequin(collection, standing_posture(person.stature, person.sex), person.sex, name=str(person).capitalize(), stature=person.stature)
    right, forward, up = stand.axes
    worker.matrix_world = Matrix((*zip(-right, -forward, up, stand.origin), (0.0, 0.0, 0.0, 1.0)))
    worker.show_name = True
    return worker

