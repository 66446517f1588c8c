# SPDX-License-Identifier: GPL-3.0-or-later
"""Actions that hold one motion after another, for thousands that are saved one by one."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bpy

from ..rigs.rotations import Array
from .action_writer import Channel, Styles, add_keys, keys_of, new_action


class ReusedActions:
    """One Action an owner that holds one motion after another, for those that are saved at once and then let go of.

    They are assigned to nobody. To make a hundred F-curves anew would take longer than to give them other keys.
    """

    def __init__(self) -> None:
        self._kept: dict[str, _Kept] = {}

    def write(self, owner: bpy.types.Object, name: str, channels: Sequence[Channel],
              first_frame: int) -> bpy.types.Action:
        """The owner's Action, which is as `write_action` would make it; the motion that it held before is gone."""
        shape = [(channel.data_path, channel.group, channel.values.shape[1], channel.steps is None)
                 for channel in channels]
        kept = self._kept.get(owner.name)
        if kept is None or kept.shape != shape:
            self.forget(owner)
            action, curves = new_action(owner, name, channels, first_frame)
            stepped = [channel.steps is not None for channel in channels for _ in range(channel.values.shape[1])]
            self._kept[owner.name] = _Kept(action, shape, [
                _KeptCurve(curve, steps) for curve, steps in zip(curves, stepped)])
            return action
        kept.action.name = name  # ReferenceError where someone has removed the Action and with it the curves
        kept.action.id_properties_clear()
        keys = (keys for _, columns in keys_of(channels, first_frame) for keys in columns)
        unlike: Styles = {}
        for curve, its_keys in zip(kept.curves, keys):
            curve.take(its_keys, unlike)
        return kept.action

    def forget(self, owner: bpy.types.Object) -> None:
        """Removes the owner's Action."""
        if kept := self._kept.pop(owner.name, None):
            bpy.data.actions.remove(kept.action)

    def close(self) -> None:
        for kept in self._kept.values():
            bpy.data.actions.remove(kept.action)
        self._kept.clear()


class _KeptCurve:
    """An F-curve and how many keys it has."""

    __slots__ = ("curve", "points", "stepped", "count")

    def __init__(self, curve: bpy.types.FCurve, stepped: bool) -> None:
        self.curve, self.points, self.stepped = curve, curve.keyframe_points, stepped
        self.count = len(self.points)

    def take(self, keys: Array, unlike: Styles) -> None:
        """Keys as frame, value, frame, value, ..."""
        if len(keys) != 2 * self.count:
            self.count = len(keys) // 2
            self.points.clear()
            add_keys(self.points, self.count, self.stepped, unlike)
        self.points.foreach_set("co", keys)
        self.curve.update()


@dataclass(frozen=True)
class _Kept:
    action: bpy.types.Action
    shape: list[tuple[str, str, int, bool]]   #: of each channel: path, group, width, whether it has no steps
    curves: list[_KeptCurve]
