# SPDX-License-Identifier: GPL-3.0-or-later
"""The box in the hands: a Child Of constraint, switched by keys, to an Empty that goes with both hands of a rig.

The Empty, the rig's hold, lies midway between the grips; its x points from the left grip to the right, its z up. While
the constraint's influence is 1 the box's own keys say how it lies in the hold; while it is 0, where it stands in the
world. All Actions of a rig and a box share one hold and one constraint, so that any of them can be taken up again.
"""
from __future__ import annotations

import bpy
import numpy as np
from bpy.utils import escape_identifier
from mathutils import Matrix

from ..rigs.bone_map import GripPlace
from ..rigs.rotations import Array
from ..rigs.skeleton import Skeleton
from .action_writer import Channel, WriteAction, write_action
from .movers import HOLD, is_carrier
from .prepare import Prepared, Solved
from .read_task import Lift
from .transforms import above_matrix
from .write_motion import box_channels

_SHOWN_M = 0.05   #: size of a hold that is made visible


def write_box_action(prepared: Prepared, solved: Solved, rig: bpy.types.Object, box: bpy.types.Object, name: str,
                     first: int, layer: bpy.types.ViewLayer, aside: Array | None = None,
                     above: Array | None = None, write: WriteAction = write_action) -> bpy.types.Action:
    """A new Action on `box`, carried by `rig` from every grasp to the release after it; first key at frame `first`.

    aside: (3,) metres in the world by which all places are moved. above: (4, 4) `above_matrix` of the box where it is
    known; else the layer is evaluated for it.
    """
    above = above_matrix(box, layer) if above is None else above
    ready_carrier(box, rig, prepared.skeleton)
    return write(box, name, carried_channels(box, rig, above, prepared.lift, solved, aside), first)


def carried_channels(box: bpy.types.Object, rig: bpy.types.Object, above: Array, lift: Lift, solved: Solved,
                     aside: Array | None = None) -> list[Channel]:
    """Places of `box` and influences of its carriers, as steps. above: (4, 4), `transforms.above_matrix`."""
    spans = held_spans(solved.motion)
    steps = sorted({0, *(frame for span in spans for frame in span if frame is not None)})
    held = np.array([any(start <= step and (end is None or step < end) for start, end in spans) for step in steps])
    half = np.diag([-1.0, -1.0, 1.0]) if lift.half_turn else np.eye(3)
    offset, turn = half @ np.array(lift.box.origin_offset), half @ np.array(lift.box.turn)
    bases, frames = (values[steps] for values in solved.places)
    origins = bases + frames @ offset + (0.0 if aside is None else aside)
    turns = frames @ turn
    origins[held] = offset - [0.0, 0.0, lift.box.handle_height]
    turns[held] = turn
    channels = box_channels(box, above, origins, turns, tuple(steps))
    for constraint in filter(is_carrier, box.constraints):
        own = rig_of_hold(constraint.target) == rig
        channels.append(Channel(f'constraints["{escape_identifier(constraint.name)}"].influence',
                                held[:, None].astype(float) if own else np.zeros((1, 1)), "Carried",
                                tuple(steps) if own else (0,)))
    return channels


def held_spans(motion: object) -> list[tuple[int, int | None]]:
    """(grasp, release) frames of a reachcast_core.Motion; None when the box is not let go."""
    spans: list[tuple[int, int | None]] = []
    for event, frame in motion.events.items():  # type: ignore[attr-defined]
        if event.startswith("grasp"):
            spans.append((frame, None))
        elif event.startswith("release") and spans:
            spans[-1] = (spans[-1][0], frame)
    return spans


def ready_carrier(box: bpy.types.Object, rig: bpy.types.Object, skeleton: Skeleton) -> bpy.types.Constraint:
    """The constraint by which `rig` carries `box`; made, like the rig's hold, when there is none yet."""
    hold = ready_hold(rig, skeleton, box)
    found = next((item for item in box.constraints if is_carrier(item) and item.target == hold), None)
    if found is None:
        found = box.constraints.new("CHILD_OF")
        found.name, found.target = f"Carried by {rig.name}", hold
        found.use_scale_x = found.use_scale_y = found.use_scale_z = False
        found.influence = 0.0
    found.inverse_matrix = Matrix()  # Blender fills it in when the target is chosen in the interface
    return found


def ready_hold(rig: bpy.types.Object, skeleton: Skeleton, beside: bpy.types.Object) -> bpy.types.Object:
    """The Empty midway between the grips of `rig`; a new one is linked where the object `beside` is, and hidden."""
    hold = next((item for item in bpy.data.objects if HOLD in item and rig_of_hold(item) == rig), None)
    if hold is None:
        hold = bpy.data.objects.new(f"{rig.name} Hold", None)
        hold[HOLD] = True
        hold.empty_display_size, hold.hide_viewport, hold.hide_render = _SHOWN_M, True, True
        _collection_of(beside).objects.link(hold)
        for kind in ("COPY_LOCATION", "COPY_LOCATION", "LOCKED_TRACK"):
            hold.constraints.new(kind).target = rig
        hold.constraints[1].influence = 0.5
        hold.constraints[2].track_axis, hold.constraints[2].lock_axis = "TRACK_X", "LOCK_Z"
    for constraint, side in zip(hold.constraints, "LRR"):
        grip: GripPlace = skeleton.bone_map.grip(side)
        constraint.subtarget, constraint.head_tail = grip.bone, grip.along
    return hold


def rig_of_hold(hold: bpy.types.Object | None) -> bpy.types.Object | None:
    return hold.constraints[0].target if hold is not None and len(hold.constraints) == 3 else None


def carriers_of(box: bpy.types.Object) -> list[bpy.types.Constraint]:
    return list(filter(is_carrier, box.constraints))


def remove_holds(rig: bpy.types.Object) -> None:
    """Before a rig is removed: what goes with its hands."""
    for hold in [item for item in bpy.data.objects if HOLD in item and rig_of_hold(item) == rig]:
        bpy.data.objects.remove(hold)


def forget_carriers(box: bpy.types.Object) -> None:
    """Takes the constraints off a copy of a box that was carried."""
    for constraint in carriers_of(box):
        box.constraints.remove(constraint)


def _collection_of(item: bpy.types.Object) -> bpy.types.Collection:
    """One that this file may link objects into."""
    own = (place for place in item.users_collection if place.library is None and place.override_library is None)
    return next(own, bpy.context.scene.collection)
