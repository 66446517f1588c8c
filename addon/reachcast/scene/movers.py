# SPDX-License-Identifier: GPL-3.0-or-later
"""What besides its own location, rotation and scale, or the keys of a new Action, decides where an object is."""
from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import bpy

from .action_writer import curves_of

#: Whether a property that an F-curve animates is one of those that matter, by its data path.
Touches = Callable[[str], bool]
#: Custom property of the Empties that go with the hands of a rig: which hands; see carry.py.
HOLD = "reachcast_hold"
#: Custom property of predicted Actions on rigs, which names their events, and of those on the boxes that they carry.
PREDICTED, CARRIED = "reachcast_events", "reachcast_carried_by"
_CHANNELS = ("location", "rotation", "scale")


@dataclass(frozen=True)
class Mover:
    """`what` moves an object, in words that follow "follows"; `remedy` says what to do about it."""

    what: str
    remedy: str


def is_carrier(constraint: bpy.types.Constraint) -> bool:
    """Whether it puts a box into a rig's hands. A new Action on the box keys its influence."""
    return constraint.type == "CHILD_OF" and constraint.target is not None and HOLD in constraint.target


def moves_object(path: str) -> bool:
    """Whether a data path of an object is a transform of the object itself, deltas included."""
    return path.removeprefix("delta_").startswith(_CHANNELS)


def moves_bones(names: frozenset[str]) -> Touches:
    """Whether a data path of an armature object is a transform of the object or of one of these bones."""
    def touches(path: str) -> bool:
        bone, _, channel = path.removeprefix('pose.bones["').partition('"].')
        return moves_object(path) or (bpy.utils.unescape_identifier(bone) in names and channel.startswith(_CHANNELS))
    return touches


def refuse_moved(item: bpy.types.Object, kind: str, other: bpy.types.Object | None, touches: Touches) -> None:
    """ValueError when a new Action on `item`, a `kind` ("Rig" or "Box"), would not alone decide where it is.

    `other` is the second object that gets an Action. The Action that `item` has now does not matter: it is replaced.
    """
    if mover := next(movers(item, touches, own_action=False), None):
        raise ValueError(f"{kind} '{item.name}' would not follow its keys alone but also {mover.what}; {mover.remedy}")
    child, parent = item, item.parent
    while parent is not None:
        if parent == other:
            raise ValueError(f"{kind} '{item.name}' is parented to '{parent.name}', which moves itself; "
                             f"clear its parent (Alt P)")
        mover = next(_bone_movers(parent, child.parent_bone), None) if child.parent_type == "BONE" else None
        if mover := mover or next(movers(parent, moves_object), None):
            raise ValueError(f"{kind} '{item.name}' is parented to '{parent.name}', which follows {mover.what}; "
                             f"{mover.remedy}, or clear the parent (Alt P)")
        child, parent = parent, parent.parent


def movers(item: bpy.types.Object, touches: Touches, own_action: bool = True) -> Iterator[Mover]:
    """All that moves `item` through the properties that `touches` picks, apart from its parents' movements."""
    for constraint in item.constraints:
        ours = is_carrier(constraint) and (not own_action or constraint.influence == 0.0)
        if not constraint.mute and not ours:
            yield Mover(f"its constraint '{constraint.name}'", "mute or remove it")
    if item.parent and item.parent_type in {"VERTEX", "VERTEX_3"}:
        yield Mover(f"the vertices of its parent '{item.parent.name}'", "parent it to the object instead")
    if item.parent and _leads_along_path(item.parent):
        yield Mover(f"the animated path of its parent '{item.parent.name}'", "switch Path Animation off")
    if item.rigid_body and item.rigid_body.type == "ACTIVE" and item.rigid_body.enabled \
            and not item.rigid_body.kinematic:
        yield Mover("its active rigid body", "make it passive or animated")
    yield from _animation(item, touches, own_action)


def _animation(item: bpy.types.Object, touches: Touches, own_action: bool) -> Iterator[Mover]:
    data = item.animation_data
    if data is None:
        return
    for curve in data.drivers:
        if not curve.mute and touches(curve.data_path):
            yield Mover(f"the driver on its {curve.data_path}", "mute or remove it")
    if own_action and data.action and any(touches(curve.data_path) for curve in curves_of(data.action)):
        yield Mover(f"its Action '{data.action.name}'", "unlink it")
    if data.use_nla:
        for track in data.nla_tracks:
            yield from _track(track, touches, own_action)


def _track(track: bpy.types.NlaTrack, touches: Touches, own_action: bool) -> Iterator[Mover]:
    if track.is_solo:
        yield Mover(f"its NLA track '{track.name}', which plays solo", "switch the track's solo off")
    if not track.mute:
        for strip in _live_strips(track.strips):
            action = strip.action
            if action is None or (not own_action and _is_covered(action)):
                continue
            if any(touches(curve.data_path) for curve in curves_of(action)):
                yield Mover(f"its NLA strip '{strip.name}'", f"mute the track '{track.name}'")


def _is_covered(action: bpy.types.Action) -> bool:
    """Whether a new Action above a strip of this one keys all that it does."""
    return CARRIED in action or (PREDICTED in action and not any(moves_object(curve.data_path)
                                                                 for curve in curves_of(action)))


def _live_strips(strips: object) -> Iterator[bpy.types.NlaStrip]:
    """These strips and those inside meta strips."""
    for strip in strips:  # type: ignore[attr-defined]
        if not strip.mute:
            yield strip
            yield from _live_strips(strip.strips)


def _bone_movers(armature: bpy.types.Object, name: str) -> Iterator[Mover]:
    """What moves a bone that carries a child object: its own animation or that of a bone above it."""
    bone = armature.pose.bones.get(name) if armature.pose else None
    chain = [bone, *bone.parent_recursive] if bone else []
    for link in chain:
        for constraint in link.constraints:
            if not constraint.mute:
                yield Mover(f"the constraint '{constraint.name}' of its bone '{link.name}'", "mute or remove it")
    yield from _animation(armature, moves_bones(frozenset(link.name for link in chain)), own_action=True)


def _leads_along_path(parent: bpy.types.Object) -> bool:
    data = parent.data if parent.type == "CURVE" and parent.data.use_path else None
    return bool(data and data.animation_data and (data.animation_data.action or data.animation_data.drivers))
