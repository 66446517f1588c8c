# SPDX-License-Identifier: GPL-3.0-or-later
"""New Actions as strips on NLA tracks of their own, above all others: what *Push Down* does, named after the task."""
from __future__ import annotations

from collections.abc import Sequence

import bpy

from .movers import PREDICTED
from .predict_action import PredictionResult


def put_on_strips(results: Sequence[PredictionResult], rig: bpy.types.Object,
                  box: bpy.types.Object | None = None) -> list[str]:
    """Gives each result's Action on `rig`, and on `box`, a new track and a strip, both called after the Action.

    A strip replaces what lies below it from the Action's first frame on and holds its last pose; of several results
    the first plays and the tracks of the others are muted. No Action is active afterwards: what was active before the
    prediction stays in the file. Returns the names of the tracks. ValueError when an object's NLA is switched off, for
    then no strip would be seen; nothing has then changed.
    """
    written = [(rig, [result.action for result in results])]
    if box is not None:
        written.append((box, [result.box_action for result in results]))
    for owner, _ in written:
        if not owner.animation_data.use_nla:
            raise ValueError(f"The NLA of '{owner.name}' is switched off, so its new Action stays the active one; switch "
                             f"the NLA on, or leave strips out")
    tracks = []
    for owner, names in written:
        owner.animation_data.action = None
        for name in names:
            track = _add_strip(owner.animation_data, bpy.data.actions[name])
            track.mute = name != names[0]
            tracks.append(track.name)
    return tracks


def predicted_action(rig: bpy.types.Object | None) -> bpy.types.Action | None:
    """The predicted Action that `rig` plays: the active one, else that of the uppermost live strip that has one."""
    data = rig.animation_data if rig else None
    if data is None:
        return None
    live = [strip.action for track in reversed(data.nla_tracks) if data.use_nla and not track.mute
            for strip in track.strips if not strip.mute]
    shown = [data.action] if data.action is not None else live
    return next((action for action in shown if action is not None and PREDICTED in action), None)


def _add_strip(data: bpy.types.AnimData, action: bpy.types.Action) -> bpy.types.NlaTrack:
    extrapolation = "HOLD_FORWARD" if len(data.nla_tracks) else "HOLD"  # a lower strip is seen before this one begins
    track = data.nla_tracks.new()
    track.name = action.name
    strip = track.strips.new(action.name, int(action.frame_range[0]), action)
    if hasattr(action, "slots"):
        strip.action_slot = action.slots[0]
    strip.blend_type, strip.extrapolation, strip.use_sync_length = "REPLACE", extrapolation, True
    return track
