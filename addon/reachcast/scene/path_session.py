# SPDX-License-Identifier: GPL-3.0-or-later
"""Editing the paths of the hands: curve objects, and the whole body solved again whenever one of them has changed.

A session begins with a prediction, whose Actions are new. From then on `update` looks at the curves and at the Empties
on the shelf and at home; where one has moved, the same Actions get other keys. How long each phase takes stays as it
was. A live session has no curves: it follows the Empties, and predicts durations anew each time. Datablocks are kept
by name, since undo frees them.
"""
from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import bpy
import numpy as np

from .. import native
from ..rigs.joints import INDEX
from ..rigs.rotations import Array
from .action_writer import rewrite_action
from .nla_strips import predicted_action
from .path_curve import add_path_curve, read_control, remove_path_curves, write_control
from .carry import carried_channels
from .predict_action import PredictionResult, describe, write_solved
from .prepare import Prepared, Solved, prepare, solve
from .read_task import Lift, place_of
from .transforms import above_matrix, layer_of
from .write_motion import rig_channels

#: A control point that differs by less has not been moved: curves are single precision.
_MOVED_M = 1e-5
#: Property of an Action that keeps the inner control points of a phase, each from its end, body frame.
_KEPT = "reachcast_hand_path_{}"


class SessionEnded(Exception):
    """Something that the session needs has been deleted. The message names it."""


@dataclass
class PathSession:
    scene: str
    rig: str
    shelf: str
    home: str | None
    box: str | None
    result: PredictionResult
    prepared: Prepared
    durations: dict[str, float] | None        #: phase -> seconds; None: predicted anew each time
    above: Array | None                       #: (4, 4) of the box
    curves: dict[int, str]                    #: number of the phase -> curve object
    ends: dict[int, tuple[str, str]]          #: number of the phase -> where its path begins and ends: home, target, rest
    seen: dict[int, Array] = field(default_factory=dict)  #: control points when they were last looked at
    solves: int = 0                           #: how often the body was solved

    def update(self) -> bool:
        """True when something had moved and the Actions have other keys. ValueError when it cannot be done, and the
        Actions are as they were; SessionEnded when the session is over."""
        rig, box = self._object(self.rig), self._object(self.box) if self.box else None
        layer = layer_of(self._scene())
        control = {number: read_control(self._object(name)) for number, name in self.curves.items()}
        moved = {number for number in control if np.abs(control[number] - self.seen[number]).max() > _MOVED_M}
        self._move_places(control, moved, layer)
        lift = self._lift(layer)
        if not moved and lift is self.prepared.lift:
            return False
        self.prepared = replace(self.prepared, lift=lift)
        self._put_ends(control)
        kept = {} if self.durations is None else {"duration": self.durations, "hand_paths": self._inner(control)}
        solved = solve(self.prepared, **kept)
        action, box_action = self._action(self.result.action), self._action(self.result.box_action)
        rewrite_action(action, rig_channels(rig, self.prepared.skeleton, solved.pose), self.result.first_frame)
        if box is not None and box_action is not None:
            rewrite_action(box_action, carried_channels(box, rig, self.above, lift, solved), self.result.first_frame)
        self.result = describe(solved, self.rig, action, box_action, self.result.first_frame)
        self._keep(action, control)
        self.solves += 1
        return True

    def _scene(self) -> bpy.types.Scene:
        scene = bpy.data.scenes.get(self.scene)
        if scene is None:
            raise SessionEnded(f"scene '{self.scene}' has been removed")
        return scene

    def _object(self, name: str) -> bpy.types.Object:
        item = bpy.data.objects.get(name)
        if item is None:
            raise SessionEnded(f"'{name}' has been removed")
        return item

    def _action(self, name: str | None) -> bpy.types.Action | None:
        if name is not None and name not in bpy.data.actions:
            raise SessionEnded(f"Action '{name}' has been removed")
        return bpy.data.actions[name] if name is not None else None

    def _up(self) -> Array:
        return np.array([0.0, 0.0, self.prepared.lift.box.handle_height])

    def _move_places(self, control: Mapping[int, Array], moved: Iterable[int], layer: bpy.types.ViewLayer) -> None:
        """An end of a curve that was moved takes the Empty there with it."""
        taken = False
        for number in sorted(moved):
            for place, at in zip(self.ends[number], (0, 3)):
                way = control[number][at] - self.seen[number][at]
                name = {"home": self.home, "target": self.shelf}.get(place)
                if name is None or np.abs(way).max() <= _MOVED_M:
                    continue
                item = self._object(name)
                matrix = item.matrix_world.copy()
                matrix.translation = matrix.translation + type(matrix.translation)(way)
                item.matrix_world = matrix
                taken = True
        if taken:
            layer.update()

    def _lift(self, layer: bpy.types.ViewLayer) -> Lift:
        lift, skeleton = self.prepared.lift, self.prepared.skeleton
        target, target_yaw = place_of(skeleton, self._object(self.shelf), lift, layer)
        if np.abs(target - lift.target).max() > _MOVED_M or abs(target_yaw - lift.target_yaw) > _MOVED_M:
            lift = replace(lift, target=target, target_yaw=target_yaw)
        if self.home:
            home, home_yaw = place_of(skeleton, self._object(self.home), lift, layer)
            if np.abs(home - lift.home).max() > _MOVED_M or abs(home_yaw - lift.home_yaw) > _MOVED_M:
                lift = replace(lift, home=home, home_yaw=home_yaw)
        return lift

    def _put_ends(self, control: dict[int, Array]) -> None:
        """Ends of curves lie where the hands will be; inner points go along with the end that they belong to."""
        lift, skeleton = self.prepared.lift, self.prepared.skeleton
        at = {"home": skeleton.to_world(lift.home + self._up()), "target": skeleton.to_world(lift.target + self._up())}
        for number, name in self.curves.items():
            wanted = control[number].copy()
            for place, end, inner in zip(self.ends[number], (0, 3), (1, 2)):
                where = at.get(place, self.seen[number][end])
                if np.abs(wanted[inner] - self.seen[number][inner]).max() <= _MOVED_M:
                    wanted[inner] += where - self.seen[number][end]
                wanted[end] = where
            if np.abs(wanted - control[number]).max() > _MOVED_M:
                write_control(self._object(name), wanted)
            control[number] = wanted
            self.seen[number] = read_control(self._object(name))

    def _inner(self, control: Mapping[int, Array]) -> dict[int, Array]:
        return {number: self.prepared.skeleton.to_body(points[1:3]) for number, points in control.items()}

    def _keep(self, action: bpy.types.Action, control: Mapping[int, Array]) -> None:
        axes = self.prepared.skeleton.axes
        for number, points in control.items():
            arms = (points[[1, 2]] - points[[0, 3]]) @ axes.T
            action[_KEPT.format(number)] = [float(value) for value in arms.ravel()]


def begin_session(rig: bpy.types.Object, shelf: bpy.types.Object, *, home: bpy.types.Object | None = None,
                  box: bpy.types.Object | None = None, edited: Sequence[int] | None = None,
                  start_frame: int | None = None, scene: bpy.types.Scene | None = None, live: bool = False,
                  **options: object) -> PathSession:
    """Predicts as `predict_motion` does and adds a curve for the path of every edited phase (numbers into `phases`;
    None: those that carry the box, or all when none does). Paths that were edited before in the rig's Action are taken
    up again; curves that an earlier session left behind go. live: no curves, `edited` is not looked at. ValueError when
    it cannot be done; nothing has then been written."""
    scene = scene or bpy.context.scene
    layer = layer_of(scene)
    prepared = prepare(rig, shelf, home=home, box=box, scene=scene, **options)
    learned = solve(prepared)
    phases = [phase for phase, _, _ in learned.motion.phases]
    numbers = [] if live else _edited(phases, edited)
    former = predicted_action(rig)
    inner = {number: _inner_of(former, number, prepared, learned) for number in numbers}
    durations = None if live else {phase: float(learned.motion.times[last] - learned.motion.times[first])
                                   for phase, first, last in learned.motion.phases}
    solved = learned if live else solve(prepared, duration=durations, hand_paths=inner)
    first = scene.frame_current if start_frame is None else int(start_frame)
    above = above_matrix(box, layer) if box else None
    result = write_solved(prepared, solved, rig, box, f"to {shelf.name}", first, layer)
    session = PathSession(scene.name, rig.name, shelf.name, home.name if home else None, box.name if box else None,
                          result, prepared, durations, above, {}, _ends(phases))
    action = bpy.data.actions[result.action]
    remove_path_curves(rig.name)
    for number in numbers:
        control = control_of(prepared, solved, number)
        control[1:3] = prepared.skeleton.to_world(inner[number])
        curve = add_path_curve(f"Hand Path {phases[number].capitalize()}", control, scene.collection, rig.name)
        session.curves[number] = curve.name
    layer.update()
    session.seen = {number: read_control(bpy.data.objects[name]) for number, name in session.curves.items()}
    session._keep(action, session.seen)
    return session


def end_session(session: PathSession) -> None:
    """Takes the curves away. The Actions stay, and so does what they know of their paths."""
    for name in session.curves.values():
        item = bpy.data.objects.get(name)
        if item is not None:
            data = item.data
            bpy.data.objects.remove(item)
            if data.users == 0:
                bpy.data.curves.remove(data)
    session.curves.clear()


def hold_points(solved: Solved, lift: Lift) -> Array:
    """(F, 3) world: the middle between the grips, or the grip of the one hand that works."""
    return solved.joints[:, [INDEX[f"{word}_grip"] for word in lift.grips()]].mean(axis=1)


def control_of(prepared: Prepared, solved: Solved, number: int) -> Array:
    """(4, 3) world: the path of the hands in a phase, or the cubic that is nearest to it."""
    curve = solved.motion.curves[number]
    if curve is not None:
        return prepared.skeleton.to_world(np.asarray(curve))
    _, first, last = solved.motion.phases[number]
    return np.array(native.core().fit_bezier(hold_points(solved, prepared.lift)[first:last + 1], 3))


def _edited(phases: Sequence[str], edited: Sequence[int] | None) -> list[int]:
    if edited is None:
        carrying = [number for number, phase in enumerate(phases) if phase in ("transfer", "retrieve")]
        return carrying or list(range(len(phases)))
    numbers = sorted({int(number) for number in edited})
    if not numbers or numbers[0] < 0 or numbers[-1] >= len(phases):
        raise ValueError(f"The phases to edit are {list(edited)}; give numbers from 0 to {len(phases) - 1}")
    return numbers


def _inner_of(former: bpy.types.Action | None, number: int, prepared: Prepared, learned: Solved) -> Array:
    """(2, 3) body frame."""
    control = prepared.skeleton.to_body(control_of(prepared, learned, number))
    kept = former.get(_KEPT.format(number)) if former is not None else None
    if kept is None or len(kept) != 6:
        return control[1:3]
    return control[[0, 3]] + np.array(kept[:], dtype=float).reshape(2, 3)


def _ends(phases: Sequence[str]) -> dict[int, tuple[str, str]]:
    """Where each path begins and ends, as reachcast_core plans it: the box stands where the first phase that carries it
    takes it from, at the target when none does."""
    loaded = next((phase for phase in phases if phase in ("transfer", "retrieve")), None)
    here = "home" if loaded == "transfer" else "target"
    ends = {}
    for number, phase in enumerate(phases):
        there = "target" if here == "home" else "home"
        ends[number] = {"reach": ("rest", here), "return": (here, "rest")}.get(phase, (here, there))
        if phase in ("transfer", "retrieve"):
            here = there
    return ends
