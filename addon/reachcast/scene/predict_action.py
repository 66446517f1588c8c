# SPDX-License-Identifier: GPL-3.0-or-later
"""`predict_motion`: a rig and a shelf become an Action. The plain function behind the button, for scripts too."""
from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

import bpy

from ..rigs.bone_map import BoneMap
from ..rigs.rotations import Array
from .action_writer import WriteAction, write_action
from .carry import write_box_action
from .movers import CARRIED, PREDICTED
from .prepare import Prepared, Solved, prepare, solve
from .transforms import layer_of
from .write_motion import write_rig_action


#: Custom properties of a predicted Action: ids of the neighbours that are transfers, and their weights.
TRANSFERS, WEIGHTS = "reachcast_transfers", "reachcast_transfer_weights"


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
    #: (phase, what its path of the hands comes from: deviation, bezier, published or given), one per phase
    ways: tuple[tuple[str, str], ...]
    errors: Mapping[str, float]                           #: metres: landing (if placed), grip (if held), pose
    corpus_path: str
    corpus_kind: str                                      #: what was learned from: "recorded", "simulated", ...


def predict_motion(rig: bpy.types.Object, shelf: bpy.types.Object, *, corpus: object = None,
                   home: bpy.types.Object | None = None, box: bpy.types.Object | None = None,
                   stature: float | None = None, sex: str | None = None, age: float | None = None,
                   mass: float | None = None, bone_map: BoneMap | str | Path | None = None,
                   start_frame: int | None = None, scene: bpy.types.Scene | None = None,
                   phases: Sequence[str] = ("transfer",), obstacles: Iterable[bpy.types.Object] = (),
                   **options: object) -> PredictionResult:
    """Predicts how `rig` carries `box` to `shelf` and writes a new Action on the rig, and one on the box if given.

    corpus: a path or an opened reachcast_core.Corpus; None takes the one that ships. stature in metres (None: the
    rig's own height), age in years, mass in kg. phases: any of "reach" (empty hands to the box), "transfer" (from
    home to the shelf), "return" (hands to the sides) and "retrieve" (back home), in an order that can be performed;
    the box stands where the first loaded phase takes it from. obstacles: mesh objects that the box and the hands keep
    clear of (option clearance, metres); the rig and the box are none. handles: two objects where the hands hold the
    box. Objects are taken where they are in the scene's current frame, and the motion starts there or at start_frame.
    Other options go to reachcast_core.predict: approach="above", "front" or "side"; variation={"seed": 1} for another
    motion than the mean; k, scheme, duration. Everything is read and checked first: on ValueError nothing has been
    written.
    """
    scene = scene or bpy.context.scene
    prepared = prepare(rig, shelf, corpus=corpus, home=home, box=box, stature=stature, sex=sex, age=age, mass=mass,
                       bone_map=bone_map, phases=phases, obstacles=obstacles, scene=scene, **options)
    solved = solve(prepared)
    first = scene.frame_current if start_frame is None else int(start_frame)
    return write_solved(prepared, solved, rig, box, f"to {shelf.name}", first, layer_of(scene))


def write_solved(prepared: Prepared, solved: Solved, rig: bpy.types.Object, box: bpy.types.Object | None, what: str,
                 first: int, layer: bpy.types.ViewLayer, above: Array | None = None,
                 write: WriteAction = write_action) -> PredictionResult:
    """New Actions on rig and box, named after them and `what`, whose first key stands at frame `first`.

    above: (4, 4) `transforms.above_matrix` of the box where it is known. write: what makes an Action of channels.
    """
    action = write_rig_action(rig, prepared.skeleton, solved.pose, f"{rig.name} {what}", first, write)
    box_action = write_box_action(prepared, solved, rig, box, f"{box.name} {what}", first, layer, above=above,
                                  write=write) if box else None
    return describe(solved, rig.name, action, box_action, first)


def keep_all(results: Iterable[PredictionResult]) -> None:
    """Has every Action saved with the file, though only one of them can be active (fake user)."""
    for result in results:
        for name in filter(None, (result.action, result.box_action)):
            bpy.data.actions[name].use_fake_user = True


def describe(solved: Solved, rig: str, action: bpy.types.Action, box_action: bpy.types.Action | None,
             first: int) -> PredictionResult:
    """What was written from this, also as custom properties of the Action."""
    motion = solved.motion
    result = PredictionResult(
        rig, action.name, box_action.name if box_action else None,
        MappingProxyType({event: first + frame for event, frame in motion.events.items()}), first,
        tuple(Neighbour(near.id, near.origin, near.mirrored, near.weight, MappingProxyType(dict(near.distances)),
                        near.phase)
              for near in motion.neighbours),
        motion.outside_data, tuple(map(str, motion.outside_reasons)),
        tuple(map(correction_in_words, motion.corrections)),
        tuple(zip((phase for phase, _, _ in motion.phases), motion.ways)), MappingProxyType(dict(solved.errors)),
        solved.corpus_path, solved.corpus_kind)
    _label(action, result)
    if box_action is not None:
        box_action[CARRIED] = rig
    return result


def correction_in_words(correction: Any) -> str:
    """A correction in words: what was moved, by how much at most, in how many frames."""
    parts = [f"{1000.0 * correction.metres:.0f} mm"] if correction.metres else []
    parts += [f"{math.degrees(correction.radians):.0f} degrees"] if correction.radians else []
    return f"{correction.name} by {' and '.join(parts) or 'a little'} in {correction.frames} frames"


def _label(action: bpy.types.Action, result: PredictionResult) -> None:
    """The result as custom properties: it is saved with the file and undone with the Action."""
    for event, frame in result.frames.items():
        action[event] = frame
    action[PREDICTED] = ", ".join(result.frames)
    action["reachcast_first_frame"] = result.first_frame
    transfers = [near for near in result.neighbours if near.phase == "transfer"]
    action[TRANSFERS], action[WEIGHTS] = [near.id for near in transfers], [near.weight for near in transfers]
    action["reachcast_corpus"] = result.corpus_path
    action["reachcast_corpus_kind"] = result.corpus_kind
    action["reachcast_outside_data"] = result.outside_data
    action["reachcast_neighbours"] = ", ".join(str(near.id) for near in result.neighbours)
    action["reachcast_outside_reasons"] = "; ".join(result.outside_reasons)
    action["reachcast_ways"] = ", ".join(f"{phase}: {way}" for phase, way in result.ways)
    action["reachcast_corrections"] = "; ".join(result.corrections)
    for name, value in result.errors.items():
        action[f"reachcast_{name}_error_m"] = value
