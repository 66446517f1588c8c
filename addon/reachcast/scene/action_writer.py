# SPDX-License-Identifier: GPL-3.0-or-later
"""The one file that makes F-curves: numbers over frames become a new Action, in bulk, and nothing is overwritten.

It is also the only file that knows that an Action has slots and channel bags from Blender 4.4 on.
"""
from __future__ import annotations

import functools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import bpy
import numpy as np

from ..rigs.rotations import Array


#: Keys on every frame: straight between them; handles for who makes them curved later.
_KEY_STYLE = (("interpolation", "LINEAR"), ("handle_left_type", "AUTO_CLAMPED"), ("handle_right_type", "AUTO_CLAMPED"))
_STEP_STYLE = (("interpolation", "CONSTANT"), *_KEY_STYLE[1:])
#: By whether keys are steps: what new keys do not have by themselves.
Styles = dict[bool, list[tuple[str, str]]]


@dataclass(frozen=True)
class Channel:
    """One animated property. `values` is (frames, width); keys stand at `first_frame` + 0, 1, 2, ...

    A column that never changes gets its first key only. steps: with these the keys stand at `first_frame` + each of
    them, and every key holds until the next.
    """

    data_path: str
    values: Array
    group: str
    steps: tuple[int, ...] | None = None


#: Writes channels as an Action for an object: owner, name, channels, first frame.
WriteAction = Callable[[bpy.types.Object, str, Sequence[Channel], int], bpy.types.Action]


def write_action(owner: bpy.types.Object, name: str, channels: Sequence[Channel], first_frame: int) -> bpy.types.Action:
    """A new Action with these channels, made the active one of `owner`. The Action it replaces is kept in the file."""
    action, _ = new_action(owner, name, channels, first_frame)
    if owner.animation_data is None:
        owner.animation_data_create()
    _assign(owner, action)
    return action


def new_action(owner: bpy.types.Object, name: str, channels: Sequence[Channel],
               first_frame: int) -> tuple[bpy.types.Action, list[bpy.types.FCurve]]:
    """With its F-curves in the order of the channels. It is not assigned."""
    action, made = bpy.data.actions.new(name), []
    curves, group_of = _curve_makers(owner, action)
    unlike: Styles = {}
    for channel, columns in keys_of(channels, first_frame):
        group = group_of(channel.group)
        for index, keys in enumerate(columns):
            curve = curves.new(channel.data_path, index=index)
            curve.group = group
            _fill(curve, keys, channel.steps is not None, unlike)
            made.append(curve)
    return action, made


def _assign(owner: bpy.types.Object, action: bpy.types.Action) -> None:
    """Once all curves are there: only then does Blender see that drivers read what they animate."""
    replaced = owner.animation_data.action
    owner.animation_data.action = action
    if hasattr(action, "slots"):
        owner.animation_data.action_slot = action.slots[0]
    if replaced is not None and replaced.users == 0:
        replaced.use_fake_user = True


def rewrite_action(action: bpy.types.Action, channels: Sequence[Channel], first_frame: int) -> None:
    """Other keys for the channels that `write_action` gave this Action; everything else in it stays."""
    curves = {(curve.data_path, curve.array_index): curve for curve in curves_of(action)}
    unlike: Styles = {}
    for channel, columns in keys_of(channels, first_frame):
        for index, keys in enumerate(columns):
            curve = curves.get((channel.data_path, index))
            if curve is None:
                raise ValueError(f"Action '{action.name}' has lost its channel {channel.data_path}[{index}]; "
                                 f"predict the motion again")
            if 2 * len(curve.keyframe_points) == len(keys):
                _place(curve, keys)
            else:
                curve.keyframe_points.clear()
                _fill(curve, keys, channel.steps is not None, unlike)
    action.update_tag()


def keys_of(channels: Sequence[Channel], first_frame: int) -> Iterator[tuple[Channel, list[Array]]]:
    """For every channel its columns as frame, value, frame, value, ...: one key for what does not change."""
    alike: dict[tuple[object, int], list[int]] = {}  # a rig has a hundred columns: numpy is called for all at once
    for number, channel in enumerate(channels):
        alike.setdefault((channel.steps, len(channel.values)), []).append(number)
    columns: dict[int, list[Array]] = {}
    for (steps, count), numbers in alike.items():
        values = np.concatenate([channels[number].values for number in numbers], axis=1).T
        moves = np.any(values != values[:, :1], axis=1).tolist()
        keys = np.empty((len(values), count, 2), dtype=np.float32)
        keys[:, :, 0] = first_frame + (np.arange(count) if steps is None else np.array(steps[:count]))
        keys[:, :, 1] = values
        flat = [row if moving else row[:2] for row, moving in zip(keys.reshape(len(values), -1), moves)]
        for number in numbers:
            width = channels[number].values.shape[1]
            columns[number], flat = flat[:width], flat[width:]
    return ((channel, columns[number]) for number, channel in enumerate(channels))


def refuse_unwritable(owner: bpy.types.Object) -> None:
    """ValueError when a new Action on `owner` would not be possible, or would not be what the viewport shows."""
    if owner.library is not None and owner.override_library is None:
        raise ValueError(f"Object '{owner.name}' is linked from another file; make a library override of it first")
    animation = owner.animation_data
    if animation is None:
        return
    if animation.use_tweak_mode:
        raise ValueError(f"Object '{owner.name}' is being tweaked in the NLA editor; leave tweak mode first (Tab)")
    if animation.action_influence < 1.0 or animation.action_blend_type != "REPLACE":
        raise ValueError(f"Object '{owner.name}' blends its Action ({animation.action_blend_type.lower()}, influence "
                         f"{animation.action_influence:g}); it must replace with influence 1")


def curves_of(action: bpy.types.Action) -> Iterator[bpy.types.FCurve]:
    """The F-curves of an Action that are not muted, of all its slots."""
    bags = [bag for layer in action.layers for strip in layer.strips for bag in strip.channelbags] \
        if hasattr(action, "layers") else [action]
    return (curve for bag in bags for curve in bag.fcurves if not curve.mute)


def _fill(curve: bpy.types.FCurve, keys: Array, stepped: bool, unlike: Styles) -> None:
    add_keys(curve.keyframe_points, len(keys) // 2, stepped, unlike)
    _place(curve, keys)


def add_keys(points: bpy.types.bpy_prop_collection, count: int, stepped: bool, unlike: Styles) -> None:
    """To a curve without keys. unlike: what has been found in other curves of the same call: an Action has a hundred."""
    points.add(count)
    if stepped not in unlike:  # new keys have the style of the user's preferences
        first = points[0]
        unlike[stepped] = [style for style in (_STEP_STYLE if stepped else _KEY_STYLE)
                           if getattr(first, style[0]) != style[1]]
    for attribute, identifier in unlike[stepped]:
        points.foreach_set(attribute, _enum_values(attribute, identifier, count))


def _place(curve: bpy.types.FCurve, keys: Array) -> None:
    curve.keyframe_points.foreach_set("co", keys)
    curve.update()


def _curve_makers(owner: bpy.types.Object, action: bpy.types.Action):  # type: ignore[no-untyped-def]
    """The collection that makes F-curves for `owner`, and a function from a group's name to the group."""
    bag = action
    if hasattr(action, "slots"):  # Blender 4.4 and later
        slot = action.slots.new(id_type="OBJECT", name=owner.name)
        strip = action.layers.new("Layer").strips.new(type="KEYFRAME")
        bag = strip.channelbag(slot, ensure=True)
    else:
        action.id_root = "OBJECT"  # which it otherwise is from the first time that it is assigned

    def group_of(name: str) -> bpy.types.ActionGroup:
        return bag.groups.get(name) or bag.groups.new(name)

    return bag.fcurves, group_of


@functools.lru_cache(maxsize=64)
def _enum_values(attribute: str, identifier: str, count: int) -> Array:
    value = bpy.types.Keyframe.bl_rna.properties[attribute].enum_items[identifier].value
    return np.full(count, value, dtype=np.int32)
