# SPDX-License-Identifier: GPL-3.0-or-later
"""What a user may want beside the keys of a prediction: markers on the timeline and Actions in the asset browser."""
from __future__ import annotations

import bpy

from .predict_action import PredictionResult

MARKED = ("grasp", "lift_off", "placed", "release")


def add_markers(result: PredictionResult, scene: bpy.types.Scene) -> list[str]:
    """Markers at grasp, lift-off, placed and release, as "Rig: grasp"; those of the rig's earlier motion give way.

    The Action keeps markers of its own too, which show in the Action editor. Returns the names on the timeline.
    """
    prefix = f"{result.rig}: "
    for marker in [marker for marker in scene.timeline_markers if marker.name.startswith(prefix)]:
        scene.timeline_markers.remove(marker)
    names = []
    for event, frame in result.frames.items():
        if event.rstrip("_0123456789") not in MARKED:
            continue
        words = event.replace("_", " ")
        names.append(scene.timeline_markers.new(prefix + words, frame=frame).name)
        bpy.data.actions[result.action].pose_markers.new(words).frame = frame
    return names


def mark_assets(result: PredictionResult) -> None:
    """Puts the Actions into the asset browser's Current File, with what they rest on as their description."""
    where = f"{'outside' if result.outside_data else 'within'} the {result.corpus_kind} data"
    for name in filter(None, (result.action, result.box_action)):
        action = bpy.data.actions[name]
        action.asset_mark()
        action.asset_data.description = (f"Predicted by Reachcast from {len(result.neighbours)} motions, {where}; "
                                         f"frames {result.first_frame} to {result.frames['end']}")
        for phase, _ in result.ways:
            action.asset_data.tags.new(phase, skip_if_exists=True)
