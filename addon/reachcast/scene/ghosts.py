# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies of a rig, of what it wears and of its box, that do another motion beside it."""
from __future__ import annotations

import itertools

import bpy

from .carry import forget_carriers, write_box_action
from .predict_action import PredictionResult, describe
from .prepare import Prepared, Solved
from .write_motion import write_rig_action


def add_ghost(prepared: Prepared, solved: Solved, rig: bpy.types.Object, box: bpy.types.Object | None, what: str,
              first: int, aside: float, collection: bpy.types.Collection,
              layer: bpy.types.ViewLayer) -> PredictionResult:
    """A copy of rig and box, `aside` metres to the subject's right, with Actions that begin at frame `first`."""
    copy = _copied(rig, collection)
    for worn in worn_by(rig):
        _dress(_copied(worn, collection), rig, copy)
    copy.matrix_world = rig.matrix_world.copy()
    return perform_aside(prepared, solved, copy, box, what, first, aside, collection, layer, name=rig.name)


def perform_aside(prepared: Prepared, solved: Solved, rig: bpy.types.Object, box: bpy.types.Object | None, what: str,
                  first: int, aside: float, collection: bpy.types.Collection, layer: bpy.types.ViewLayer, *,
                  name: str | None = None) -> PredictionResult:
    """Moves `rig` by `aside` metres to the subject's right and gives it the motion; a copy of the box goes along.

    The Action is called after `name`, or the rig, and `what`.
    """
    offset = aside * prepared.skeleton.axes[0]
    matrix = rig.matrix_world.copy()
    matrix.translation = matrix.translation + type(matrix.translation)(offset)
    rig.matrix_world = matrix
    action = write_rig_action(rig, prepared.skeleton, solved.pose, f"{name or rig.name} {what}", first)
    box_action = None
    if box is not None:
        carried = _copied(box, collection)
        box_action = write_box_action(prepared, solved, rig, carried, f"{box.name} {what}", first, layer, offset)
    return describe(solved, rig.name, action, box_action, first)


def _copied(item: bpy.types.Object, collection: bpy.types.Collection) -> bpy.types.Object:
    copy = item.copy()
    copy.name = _free_name(f"{item.name} ghost")
    collection.objects.link(copy)
    forget_carriers(copy)
    return copy


def _free_name(name: str) -> str:
    """A name that is given twice would be taken from the object that has it."""
    return next(free for free in (f"{name} {number}" for number in itertools.count(1)) if free not in bpy.data.objects)


def worn_by(rig: bpy.types.Object) -> list[bpy.types.Object]:
    """Meshes that the rig moves: its children and those that it deforms."""
    deformed = (item for item in bpy.data.objects
                if any(modifier.type == "ARMATURE" and modifier.object == rig for modifier in item.modifiers))
    return list(dict.fromkeys([item for item in rig.children if item.type == "MESH"] + list(deformed)))


def _dress(worn: bpy.types.Object, rig: bpy.types.Object, copy: bpy.types.Object) -> None:
    if worn.parent == rig:
        inverse = worn.matrix_parent_inverse.copy()
        worn.parent = copy
        worn.matrix_parent_inverse = inverse
    for modifier in worn.modifiers:
        if modifier.type == "ARMATURE" and modifier.object == rig:
            modifier.object = copy
