# SPDX-License-Identifier: GPL-3.0-or-later
"""`predict_motion`: a rig and a shelf become an Action. The plain function behind the button, for scripts too."""
from __future__ import annotations

import math
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType, ModuleType
from typing import Any

import bpy
import numpy as np

from .. import native
from ..corpora import default_corpus, opened_corpus
from ..rigs.bone_map import BoneMap
from ..rigs.joints import INDEX, JOINTS
from ..rigs.retarget import EXACT_JOINTS, retarget
from ..rigs.rotations import Array
from ..rigs.skeleton import Skeleton
from .action_writer import refuse_unwritable
from .movers import moves_bones, moves_object, refuse_moved
from .read_obstacles import read_obstacles
from .read_rig import read_rig
from .read_task import Lift, read_lift, refuse_held_box
from .transforms import above_matrix, layer_of, refuse_removed
from .write_motion import box_world_places, write_box_action, write_rig_action

#: How far the posed rig may be from the predicted joints. Single precision keys are a hundred times finer.
MAX_MISFIT_M = 1e-3


@dataclass(frozen=True)
class Neighbour:
    """A recorded motion that took part. Distances in metres: between the targets, the homes, the statures."""

    id: int
    origin: str
    mirrored: bool
    weight: float
    distances: Mapping[str, float]
    phase: str


@dataclass(frozen=True)
class PredictionResult:
    """What was written and what it rests on. Names, not references: undo frees datablocks."""

    rig: str
    action: str
    box_action: str | None
    #: scene frame of grasp, lift_off, placed, release, end, as far as they occur; the second time grasp_2, ...
    frames: Mapping[str, int]
    first_frame: int
    neighbours: tuple[Neighbour, ...]                     #: phase by phase, heaviest first
    outside_data: bool
    outside_reasons: tuple[str, ...]
    corrections: tuple[str, ...]
    errors: Mapping[str, float]                           #: metres: landing (if placed), grip (if held), pose


def predict_motion(rig: bpy.types.Object, shelf: bpy.types.Object, *, corpus: object = None,
                   home: bpy.types.Object | None = None, box: bpy.types.Object | None = None,
                   stature: float | None = None, sex: str | None = None, age: float | None = None,
                   mass: float | None = None, bone_map: BoneMap | str | Path | None = None,
                   start_frame: int | None = None, scene: bpy.types.Scene | None = None,
                   phases: Sequence[str] = ("transfer",), obstacles: Iterable[bpy.types.Object] = (), **options: object) -> PredictionResult:
    """Predicts how `rig` carries `box` to `shelf` and writes a new Action on the rig, and one on the box if given.

    corpus: a path or an opened reachcast_core.Corpus; None takes the one that ships. stature in metres (None: the
    rig's own height), age in years, mass in kg. phases: any of "reach" (empty hands to the box), "transfer" (from home to
    the shelf), "return" (hands to the sides) and "retrieve" (back home), in an order that can be performed; the box
    stands where the first loaded phase takes it from. obstacles: mesh objects that the box and the hands keep clear of
    (option clearance, metres); the rig and the box are none. Objects are taken where they are in the scene's current frame, and the
    motion starts there or at start_frame. Other options go to reachcast_core.predict. Everything is read and checked
    first: on ValueError nothing has been written.
    """
    scene = scene or bpy.context.scene
    core, layer = native.core(), layer_of(scene)
    for item, what in ((rig, "rig"), (shelf, "shelf"), (home, "home"), (box, "box")):
        refuse_removed(item, what)
    skeleton = read_rig(rig, bone_map, layer)
    lift = read_lift(skeleton, shelf, home, box, layer)
    _refuse_owners(rig, skeleton, box, layer)
    subject = _subject(core, skeleton, stature, sex, age, mass)
    surfaces = read_obstacles(skeleton, [item for item in obstacles if item not in {rig, box}], layer)
    motion = _predict(core, skeleton, lift, corpus, subject,
                      {"frame_rate": scene.render.fps / scene.render.fps_base, "phases": list(phases),
                       "obstacles": surfaces, **options})
    joints = skeleton.to_world(np.asarray(motion.positions, float))
    pose = retarget(skeleton, joints)
    places = box_world_places(skeleton, np.asarray(motion.box_positions), np.asarray(motion.box_quaternions))
    errors = _errors(skeleton, lift, motion, pose, joints, places)
    first = scene.frame_current if start_frame is None else int(start_frame)
    name = f"{rig.name} to {shelf.name}"
    above = above_matrix(box, layer) if box else None
    action = write_rig_action(rig, skeleton, pose, name, first)
    box_action = _write_box(box, above, lift, places, f"{box.name} to {shelf.name}", first) if box else None
    result = PredictionResult(
        rig.name, action.name, box_action.name if box_action else None,
        MappingProxyType({event: first + frame for event, frame in motion.events.items()}), first,
        tuple(Neighbour(near.id, near.origin, near.mirrored, near.weight, MappingProxyType(dict(near.distances)),
                        near.phase)
              for near in motion.neighbours),
        motion.outside_data, tuple(map(str, motion.outside_reasons)), tuple(map(_said, motion.corrections)),
        MappingProxyType(errors))
    _label(action, result)
    return result


def _refuse_owners(rig: bpy.types.Object, skeleton: Skeleton, box: bpy.types.Object | None,
                   layer: bpy.types.ViewLayer) -> None:
    """ValueError when an Action on the rig or the box cannot be written or would not be all that moves it."""
    keyed = frozenset(skeleton.bones.names[bone] for bone in skeleton.keyed)
    refuse_unwritable(rig)
    refuse_moved(rig, "Rig", box, moves_bones(keyed))
    if box is not None:
        refuse_unwritable(box)
        refuse_moved(box, "Box", rig, moves_object)
        refuse_held_box(box, layer)


def _corpus(core: ModuleType, corpus: object) -> object:
    if corpus is None or corpus == "":
        corpus = default_corpus()
        if corpus is None:
            raise ValueError("No corpus is given and none ships with this build of the add-on; choose a corpus file")
    if isinstance(corpus, (str, os.PathLike)):
        return opened_corpus(core, bpy.path.abspath(os.fspath(corpus)))
    if not isinstance(corpus, core.Corpus):
        raise ValueError(f"The corpus must be a path or an opened corpus, not {corpus!r}")
    return corpus


def _subject(core: ModuleType, skeleton: Skeleton, stature: float | None, sex: str | None, age: float | None,
             mass: float | None) -> object:
    for name, value in (("stature", stature), ("age", age), ("mass", mass)):
        if value is not None and not isinstance(value, (int, float)):
            raise ValueError(f"The person's {name} must be a number, not {value!r}")
    return core.Subject(skeleton.height if not stature else float(stature), sex=sex, age=age, mass=mass)


def _predict(core: ModuleType, skeleton: Skeleton, lift: Lift, corpus: object, subject: object,
             options: Mapping[str, object]) -> Any:
    if tuple(core.JOINTS) != JOINTS:
        raise ValueError("reachcast_core names other joints than this add-on; build it from the same version")
    box = lift.box
    task = core.Task(lift.home, lift.target,
                     core.Box(box.width, box.depth, box.height, box.handle_height, mass=box.mass,
                              grip_distance=box.grip_distance),
                     home_yaw=lift.home_yaw, target_yaw=lift.target_yaw)
    body = core.Body.from_posture(skeleton.to_body(skeleton.joints), skeleton.height)
    try:
        return core.predict(_corpus(core, corpus), subject, task, body, **options)
    except RuntimeError as error:  # what the native module says of a damaged or busy file, in one sentence
        raise ValueError(str(error)) from error
    except TypeError as error:
        given = ", ".join(f"{name}={value!r}" for name, value in options.items() if name != "obstacles")
        raise ValueError(f"One of these options has a value of the wrong kind: {given}") from error


def _errors(skeleton: Skeleton, lift: Lift, motion: Any, pose: Any, joints: Array,
            places: tuple[Array, Array]) -> dict[str, float]:
    """How far the rig's bones, by forward kinematics, are from what was asked: the box from where it is put down, the
    grips from their handles, the joints from the prediction. ValueError when the rig cannot follow."""
    reached = pose.joints()
    misfit = np.linalg.norm(reached - joints, axis=2)[:, EXACT_JOINTS]
    if (worst := float(misfit.max())) > MAX_MISFIT_M:
        frame, joint = np.unravel_index(int(misfit.argmax()), misfit.shape)
        raise ValueError(f"Rig '{skeleton.name}' cannot follow the predicted motion: "
                         f"{JOINTS[EXACT_JOINTS[joint]]} would be {worst * 1000:.1f} mm off at frame {frame}; "
                         f"the limit is {MAX_MISFIT_M * 1000:g} mm")
    origins, turns = places
    errors = {"pose": worst}
    ends = {"transfer": lift.target, "retrieve": lift.home}
    landings = [float(np.linalg.norm(origins[last] - skeleton.to_world(ends[phase])))
                for phase, _, last in motion.phases if phase in ends]
    if landings:
        errors["landing"] = max(landings)
    held = _held_frames(motion)
    for word, side in (("left", -0.5), ("right", 0.5)) if len(held) else ():
        handle = origins + turns @ np.array([side * lift.box.grip_distance, 0.0, lift.box.handle_height])
        off = float(np.linalg.norm(reached[:, INDEX[f"{word}_grip"]] - handle, axis=1)[held].max())
        errors["grip"] = max(off, errors.get("grip", 0.0))
    return errors


def _held_frames(motion: Any) -> Array:
    """Frames (H,) from each grasp to the release that follows it, both included; to the end if none does."""
    held: list[int] = []
    begun = None
    for event, frame in motion.events.items():
        if event.startswith("grasp"):
            begun = frame
        elif event.startswith(("release", "end")) and begun is not None:
            held.extend(range(begun, frame + 1))
            begun = None
    return np.array(held, dtype=int)


def _write_box(box: bpy.types.Object, above: Array, lift: Lift, places: tuple[Array, Array], name: str,
               first: int) -> bpy.types.Action:
    origins, turns = places
    if lift.half_turn:
        turns = turns * np.array([-1.0, -1.0, 1.0])
    return write_box_action(box, above, origins + turns @ np.array(lift.box.origin_offset), turns, name, first)


def _said(correction: Any) -> str:
    """A correction in words: what was moved, by how much at most, in how many frames."""
    parts = [f"{1000.0 * correction.metres:.0f} mm"] if correction.metres else []
    parts += [f"{math.degrees(correction.radians):.0f} degrees"] if correction.radians else []
    return f"{correction.name} by {' and '.join(parts) or 'a little'} in {correction.frames} frames"


def _label(action: bpy.types.Action, result: PredictionResult) -> None:
    """The result as custom properties: it is saved with the file and undone with the Action."""
    for event, frame in result.frames.items():
        action[event] = frame
    action["reachcast_events"] = ", ".join(result.frames)
    action["reachcast_first_frame"] = result.first_frame
    action["reachcast_outside_data"] = result.outside_data
    action["reachcast_neighbours"] = ", ".join(str(near.id) for near in result.neighbours)
    action["reachcast_outside_reasons"] = "; ".join(result.outside_reasons)
    action["reachcast_corrections"] = "; ".join(result.corrections)
    for name, value in result.errors.items():
        action[f"reachcast_{name}_error_m"] = value
