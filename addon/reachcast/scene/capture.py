# SPDX-License-Identifier: GPL-3.0-or-later
"""An armature with an Action, however it came into Blender, as a recording: sampled through its bone map."""
from __future__ import annotations

import hashlib
from dataclasses import replace
from typing import Any

import bpy
import numpy as np

from .. import native
from ..reachcast_corpus.importing import FileReport
from ..reachcast_corpus.recordings import ReadingOptions, settings_of
from ..rigs.joints import INDEX, JOINTS, SIDES
from ..rigs.rotations import Array
from ..rigs.skeleton import Skeleton
from .measure import sample
from .read_rig import read_rig
from .transforms import layer_of

#: From wrist to grip as a part of the forearm: the most that is taken for a hand, and what is taken instead, which is
#: what the readers of recordings take for a wrist alone.
_LONGEST_HAND, _HAND = 0.6, 0.39


def captured_clip(rig: bpy.types.Object, first: int, last: int, *, bone_map: object = None,
                  scene: bpy.types.Scene | None = None) -> Any:
    """A reachcast_core.Clip of the joint centres in the frames first to last as the scene evaluates them: metres,
    world, at the scene's frame rate. ValueError names what is wrong with rig or frames."""
    scene = scene or bpy.context.scene
    return _captured(rig, read_rig(rig, bone_map, layer_of(scene)), first, last, scene)


def _captured(rig: bpy.types.Object, skeleton: Skeleton, first: int, last: int, scene: bpy.types.Scene) -> Any:
    if last - first < 3:
        raise ValueError(f"Frames {first} to {last} are {max(0, last - first + 1)}; a recording has at least 4")
    joints = with_human_hands(sample(rig, skeleton, range(first, last + 1), scene=scene).joints)
    return native.core().Clip(list(JOINTS), np.ascontiguousarray(joints), scene.render.fps / scene.render.fps_base,
                              _name_of(rig))


def with_human_hands(joints: Array) -> Array:
    """Grips no farther from the wrists than a person's. glTF and FBX do not keep how long the last bone of a chain is:
    a hand without fingers comes back as long as its forearm."""
    joints = joints.copy()
    for _, word in SIDES:
        elbow, wrist, grip = (joints[:, INDEX[f"{word}_{name}"]] for name in ("elbow", "wrist", "grip"))
        forearm = np.linalg.norm(wrist - elbow, axis=1, keepdims=True)
        reach = np.linalg.norm(grip - wrist, axis=1, keepdims=True)
        shorter = np.where(reach > _LONGEST_HAND * forearm, _HAND * forearm / reach, 1.0)
        for name in ("hand_front", "hand_back", "grip"):
            place = INDEX[f"{word}_{name}"]
            joints[:, place] = wrist + shorter * (joints[:, place] - wrist)
    return joints


def capture_motion(rig: bpy.types.Object, corpus: Any, first: int, last: int, *, bone_map: object = None,
                   options: ReadingOptions = ReadingOptions(), phase: str | None = None,
                   scene: bpy.types.Scene | None = None) -> FileReport:
    """Adds what the rig does in the frames first to last to a corpus opened for writing, in one transaction.

    phase: the frames are this one phase; None finds the phases. Without a stature in the options the rig's own height
    is the person's. The same motion again changes nothing. ValueError and RuntimeError in one sentence.
    """
    core, scene = native.core(), scene or bpy.context.scene
    skeleton = read_rig(rig, bone_map, layer_of(scene))
    clip = _captured(rig, skeleton, first, last, scene)
    if options.stature is None:
        options = replace(options, stature=float(skeleton.height))
    data = np.asarray(clip.positions).astype("<f8").tobytes()
    digest = hashlib.sha256(data).hexdigest()
    settings = settings_of(options, [phase] if phase else [])
    name, origin = f"{_name_of(rig)}, frames {first} to {last}", f"{_name_of(rig)}#{digest[:8]}"
    subject = core.Subject(options.stature, sex=options.sex, age=options.age, mass=options.mass)
    if phase:
        reaches, rejections = [core.cut_reach(clip, 0, last - first, subject, phase, f"{origin}:0-{last - first}")], []
    else:
        found = core.find_reaches(clip, subject, origin=origin)
        reaches, rejections = list(found.reaches), [(left.what, left.reason) for left in found.rejections]
    if options.backwards:
        reaches += [reach.reversed() for reach in reaches]
    note = f"captured in Blender, {clip.rate:g} Hz"
    stored = corpus.add_source(name, f"sha256:{digest}", len(data), reaches, rejections, note=note, settings=settings,
                               mirror=options.mirror)
    if stored is None:
        return FileReport(name, "known")
    return FileReport(name, "imported", stored.motions, tuple(reach.phase for reach in reaches), note,
                      tuple(rejections))


def _name_of(rig: bpy.types.Object) -> str:
    action = rig.animation_data.action if rig.animation_data else None
    file = bpy.path.basename(bpy.data.filepath) or "unsaved"
    return f"{file}/{rig.name}/{action.name if action else 'no Action'}"
