# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything a prediction reads from the scene, and the prediction itself as a pose of the rig. Nothing is written."""
from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import bpy
import numpy as np

from .. import native
from ..corpora import default_corpus, opened_corpus
from ..rigs.bone_map import BoneMap
from ..rigs.joints import INDEX, JOINTS
from ..rigs.retarget import EXACT_JOINTS, body_of, retarget
from ..rigs.rotations import Array
from ..rigs.skeleton import Skeleton
from .action_writer import refuse_unwritable
from .movers import moves_bones, moves_object, refuse_moved
from .control_rig import is_control_rig, plan_of
from .read_obstacles import read_obstacles
from .read_rig import read_rig
from .read_task import Lift, read_lift, refuse_held_box
from .transforms import layer_of, refuse_removed
from .write_motion import box_world_places

#: How far the posed rig may be from the predicted joints. Single precision keys are a hundred times finer.
MAX_MISFIT_M = 1e-3


@dataclass(frozen=True)
class Prepared:
    """A checked rig, task and person; `solve` needs nothing else of the scene."""

    skeleton: Skeleton
    lift: Lift
    subject: Any                    #: reachcast_core.Subject
    corpus: Any                     #: reachcast_core.Corpus
    options: Mapping[str, object]   #: of reachcast_core.predict


@dataclass(frozen=True)
class Solved:
    """A predicted motion on the rig."""

    motion: Any                     #: reachcast_core.Motion
    pose: Any                       #: reachcast_core.RigPose
    joints: Array                   #: (F, 27, 3) world
    reached: Array                  #: (F, 27, 3) world: the same joints as the posed bones carry them
    places: tuple[Array, Array]     #: of the box: origins (F, 3) and turns (F, 3, 3), world
    errors: Mapping[str, float]     #: metres: landing (if placed), grip (if held), pose
    corpus_path: str
    corpus_kind: str                #: "recorded", "simulated", ... as the corpus says; "recorded" where it does not


def prepare(rig: bpy.types.Object, shelf: bpy.types.Object, *, corpus: object = None,
            home: bpy.types.Object | None = None, box: bpy.types.Object | None = None, stature: float | None = None,
            sex: str | None = None, age: float | None = None, mass: float | None = None,
            bone_map: BoneMap | str | Path | None = None, phases: Iterable[str] = ("transfer",),
            obstacles: Iterable[bpy.types.Object] = (), scene: bpy.types.Scene | None = None,
            handles: Sequence[bpy.types.Object] | None = None, hands: str = "both", **options: object) -> Prepared:
    """Reads and checks what `predict_motion` is given, which says what that is. ValueError in one sentence."""
    scene = scene or bpy.context.scene
    core, layer = native.core(), layer_of(scene)
    if tuple(core.JOINTS) != JOINTS:
        raise ValueError("reachcast_core names other joints than this add-on; build it from the same version")
    for item, what in ((rig, "rig"), (shelf, "shelf"), (home, "home"), (box, "box")):
        refuse_removed(item, what)
    skeleton = read_rig(rig, bone_map, layer)
    lift = read_lift(skeleton, shelf, home, box, layer, handles, hands)
    refuse_owners(rig, skeleton, box, layer)
    subject = _subject(core, skeleton, stature, sex, age, mass)
    surfaces = read_obstacles(skeleton, [item for item in obstacles if item not in {rig, box}], layer)
    try:
        opened = opened_for(core, corpus)
    except RuntimeError as error:  # what the native module says of a damaged or busy file, in one sentence
        raise ValueError(str(error)) from error
    return Prepared(skeleton, lift, subject, opened,
                    {"frame_rate": scene.render.fps / scene.render.fps_base, "phases": list(phases),
                     "obstacles": surfaces, **options})


def solve(prepared: Prepared, **options: object) -> Solved:
    """Predicts, with these options in place of the prepared ones. ValueError when it cannot be done."""
    skeleton, lift = prepared.skeleton, prepared.lift
    motion = _predict(native.core(), prepared, {**prepared.options, **options})
    joints = skeleton.to_world(np.asarray(motion.positions, float))
    pose = retarget(skeleton, joints, np.asarray(motion.bends))
    places = box_world_places(skeleton, np.asarray(motion.box_positions), np.asarray(motion.box_quaternions))
    reached = pose.joints()
    return Solved(motion, pose, joints, reached, places, _errors(skeleton, lift, motion, reached, joints, places),
                  str(prepared.corpus.path), prepared.corpus.meta["kind"] or "recorded")


def refuse_owners(rig: bpy.types.Object, skeleton: Skeleton, box: bpy.types.Object | None,
                  layer: bpy.types.ViewLayer) -> None:
    """ValueError when an Action on the rig or the box cannot be written or would not be all that moves it."""
    keyed = frozenset(plan_of(rig).bones if is_control_rig(skeleton) else
                      [skeleton.bones.names[bone] for bone in skeleton.keyed])
    refuse_unwritable(rig)
    refuse_moved(rig, "Rig", box, moves_bones(keyed))
    if box is not None:
        refuse_unwritable(box)
        refuse_moved(box, "Box", rig, moves_object)
        refuse_held_box(box, layer)


def opened_for(core: ModuleType, corpus: object) -> object:
    """A corpus that is given as a path or opened; None is the one that ships. ValueError in one sentence."""
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


def _predict(core: ModuleType, prepared: Prepared, options: Mapping[str, object]) -> Any:
    skeleton, lift, box = prepared.skeleton, prepared.lift, prepared.lift.box
    task = core.Task(lift.home, lift.target,
                     core.Box(box.width, box.depth, box.height, box.handle_height, mass=box.mass,
                              grip_distance=box.grip_distance),
                     home_yaw=lift.home_yaw, target_yaw=lift.target_yaw, hands=lift.hands)
    try:
        return core.predict(prepared.corpus, prepared.subject, task, body_of(skeleton), **options)
    except RuntimeError as error:  # what the native module says of a damaged or busy file, in one sentence
        raise ValueError(str(error)) from error
    except TypeError as error:
        given = ", ".join(f"{name}={value!r}" for name, value in options.items() if name != "obstacles")
        raise ValueError(f"One of these options has a value of the wrong kind: {given}") from error


def _errors(skeleton: Skeleton, lift: Lift, motion: Any, reached: Array, joints: Array,
            places: tuple[Array, Array]) -> dict[str, float]:
    """How far the rig's bones, by forward kinematics, are from what was asked: the box from where it is put down, the
    grips from their handles, the joints from the prediction. ValueError when the rig cannot follow."""
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
    for word, grip in lift.grips().items() if len(held) else ():
        handle = origins + turns @ grip
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
