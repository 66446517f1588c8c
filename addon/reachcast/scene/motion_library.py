# SPDX-License-Identifier: GPL-3.0-or-later
"""The motions inside a corpus, in a scene: one of them on a rig, and where in space they lead."""
from __future__ import annotations

from typing import Any

import bpy
import numpy as np

from .. import native
from ..rigs.rotations import Array
from .predict_action import PredictionResult, write_solved
from .prepare import Prepared, opened_for, refuse_owners, solve
from .read_rig import read_rig
from .read_task import BoxShape, Lift
from .transforms import layer_of

_DEPTH, _HEIGHT = 0.3, 0.25     #: of the box that is thought of: where it was held is recorded, its size is not
_LEAST_WIDTH, _HALF_HAND = 0.02, 0.02
_SAME_PLACE_M = 0.01            #: targets nearer than this are drawn as one


def stored_motion(corpus: Any, motion_id: int) -> Any:
    """The MotionSummary with this id. ValueError when there is none."""
    found = next((motion for motion in corpus.motions() if motion.id == motion_id), None)
    if found is None:
        raise ValueError(f"The corpus {corpus.path} has no motion {motion_id}")
    return found


def play_motion(rig: bpy.types.Object, motion_id: int, *, corpus: object = None, bone_map: object = None,
                start_frame: int | None = None, scene: bpy.types.Scene | None = None) -> PredictionResult:
    """Writes one stored motion as a new Action on the rig, without any other motion (Faraway 2004, section 3.3).

    The recorded places are made larger or smaller as this rig is than the person, so that a child's rig need not jump.
    Empty hands begin or end at this rig's sides. ValueError when the rig cannot do it; then nothing has been written.
    """
    scene = scene or bpy.context.scene
    layer = layer_of(scene)
    skeleton = read_rig(rig, bone_map, layer)
    refuse_owners(rig, skeleton, None, layer)
    core = native.core()
    source = opened_for(core, corpus)
    motion = stored_motion(source, motion_id)
    lift = _lift_of(motion, skeleton.height / motion.subject.stature)
    prepared = Prepared(skeleton, lift, core.Subject(skeleton.height, sex=motion.subject.sex), source,
                        {"frame_rate": scene.render.fps / scene.render.fps_base, "phases": [motion.phase],
                         "motion": motion_id})
    first = scene.frame_current if start_frame is None else int(start_frame)
    return write_solved(prepared, solve(prepared), rig, None, f"motion {motion_id}", first, layer)


def _lift_of(motion: Any, larger: float) -> Lift:
    """The task that a motion did. Its places are hold points; a box has its handles at half its height."""
    low = np.array([0.0, 0.0, 0.5 * _HEIGHT])
    start, end = (np.asarray(place) * larger - low for place in (motion.home, motion.target))
    home, target = {"transfer": (start, end), "retrieve": (end, start), "reach": (end, end),
                    "return": (start, start)}[motion.phase]
    grips = motion.grip_distance
    if motion.phase in ("reach", "return") or motion.hands != "both":  # the hands' distance at the start says nothing of the box
        grips = 0.4
    width = max(_LEAST_WIDTH, grips - 2.0 * _HALF_HAND)
    return Lift(home, target, 0.0, 0.0, BoxShape(width, _DEPTH, _HEIGHT, 0.5 * _HEIGHT, grips, 1.0), False,
                motion.hands)


def target_points(corpus: Any, rig: bpy.types.Object | None = None, phase: str | None = None) -> Array:
    """(N, 3) world, metres: where the hands of stored motions were on the box away from home, each place once.

    Around the rig's stand if there is one, else around the world's origin, facing +y.
    """
    places = [motion.target if motion.phase in ("reach", "transfer") else motion.home
              for motion in corpus.motions() if phase is None or motion.phase == phase]
    if not places:
        return np.zeros((0, 3))
    cells = np.unique(np.round(np.asarray(places) / _SAME_PLACE_M).astype(int), axis=0) * _SAME_PLACE_M
    return cells if rig is None else read_rig(rig).to_world(cells)


def forget_motions(path: str, ids: list[int]) -> int:
    """Takes motions out of a corpus file. Returns how many there were. ValueError or RuntimeError of the core."""
    with native.core().Corpus.open_for_writing(bpy.path.abspath(path)) as corpus:
        return corpus.remove(ids)
