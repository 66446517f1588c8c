# SPDX-License-Identifier: GPL-3.0-or-later
"""The same task as different people, or the same person again, might do it: motions drawn from a seed."""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ..rigs.rotations import Array
from .ghosts import add_ghost
from .path_session import hold_points
from .predict_action import PredictionResult, keep_all, write_solved
from .prepare import Prepared, Solved, prepare, solve
from .read_task import Lift
from .spread_tube import add_tube
from .steps import Progress, Steps, run_to_end
from .transforms import layer_of

MOST_VARIANTS = 1000
#: The spread is taken from at least so many motions, drawn from the seeds that follow when fewer are shown.
SPREAD_MOTIONS = 40
SPREAD_TIMES = 33


@dataclass(frozen=True)
class VariantsResult:
    results: tuple[PredictionResult, ...]   #: in the order of their seeds
    seeds: tuple[int, ...]
    failed: tuple[tuple[int, str], ...]     #: (seed, reason) of what this body cannot do
    collection: str | None                  #: of the ghosts
    tube: str | None


def predict_variants(rig: bpy.types.Object, shelf: bpy.types.Object, **options: object) -> VariantsResult:
    """All of `variant_steps` at once."""
    return run_to_end(variant_steps(rig, shelf, **options))  # type: ignore[arg-type]


def variant_steps(rig: bpy.types.Object, shelf: bpy.types.Object, *, count: int = 5, seed: int = 1,
                  amount: float = 1.0, ghosts: bool = False, spacing: float = 1.0, tube: bool = True,
                  box: bpy.types.Object | None = None, start_frame: int | None = None,
                  scene: bpy.types.Scene | None = None, **options: object) -> Steps[VariantsResult]:
    """`count` motions of the task that `predict_motion` would do, drawn from seeds seed, seed + 1, ...

    As Actions on the rig, the first of which is left active; with ghosts=True as copies of rig and box, `spacing`
    metres apart to the subject's right, each with an Action of its own. tube: a mesh about the mean path of the hands
    in every phase that carries the box (or in all), two standard deviations wide. A motion that this body cannot hold
    is left out and named in `failed`; ValueError when that is true of all, or for bad input. A step is a variant;
    whoever stops gets no tube.
    """
    _check(count, seed, amount, spacing)
    scene = scene or bpy.context.scene
    layer = layer_of(scene)
    prepared = prepare(rig, shelf, box=box, scene=scene, **options)
    first = scene.frame_current if start_frame is None else int(start_frame)
    collection, is_stopped = None, False
    drawn: list[tuple[int, Solved]] = []
    failed: list[tuple[int, str]] = []
    results: list[PredictionResult] = []
    for number in range(seed, seed + count):
        is_stopped = bool((yield Progress(number - seed, count)))
        if is_stopped:
            break
        done, refused = _draw(prepared, range(number, number + 1), amount)
        drawn, failed = drawn + done, failed + refused
        what = f"to {shelf.name} variant {number}"
        if done and not ghosts:
            results.append(write_solved(prepared, done[0][1], rig, box, what, first, layer))
        elif done:
            collection = collection or _collection(f"Variants of {rig.name} to {shelf.name}", scene)
            results.append(add_ghost(prepared, done[0][1], rig, box, what, first, len(drawn) * spacing, collection,
                                     layer))
    if not drawn and not failed:
        raise ValueError("The variants were stopped before the first was finished")
    if not drawn:
        raise ValueError(f"None of the {len(failed)} variants can be done; with seed {seed}: {failed[0][1]}")
    if collection is None:
        keep_all(results)
        rig.animation_data.action = bpy.data.actions[results[0].action]
        if box is not None:
            box.animation_data.action = bpy.data.actions[results[0].box_action]
    mesh = None
    if tube and not is_stopped:
        more, _ = _draw(prepared, range(seed + count, seed + SPREAD_MOTIONS), amount)
        mesh = add_tube(f"Spread of {rig.name} to {shelf.name}", _paths([solved for _, solved in drawn + more], prepared.lift),
                        collection or scene.collection).name
    return VariantsResult(tuple(results), tuple(number for number, _ in drawn), tuple(failed),
                          collection.name if collection else None, mesh)


def _check(count: int, seed: int, amount: float, spacing: float) -> None:
    if not isinstance(count, int) or not 1 <= count <= MOST_VARIANTS:
        raise ValueError(f"The number of variants is {count!r}; it must be from 1 to {MOST_VARIANTS}")
    if not isinstance(seed, int) or not 0 <= seed < 2 ** 31:
        raise ValueError(f"The seed is {seed!r}; it must be a whole number from 0 to {2 ** 31 - 1}")
    if not 0.0 <= amount <= 2.0:
        raise ValueError(f"The amount of the variation is {amount!r}; it must be from 0 to 2")
    if not 0.0 <= spacing <= 100.0:
        raise ValueError(f"The spacing of the ghosts is {spacing!r} m; it must be from 0 to 100")


def _draw(prepared: Prepared, seeds: range, amount: float) -> tuple[list[tuple[int, Solved]], list[tuple[int, str]]]:
    drawn, failed = [], []
    for number in seeds:
        try:
            drawn.append((number, solve(prepared, variation={"seed": number, "amount": amount})))
        except ValueError as error:
            failed.append((number, str(error)))
    return drawn, failed


def _paths(drawn: list[Solved], lift: Lift) -> list[Array]:
    """(motions, times, 3) world for each phase that carries the box, else for each: hands at equal relative times."""
    phases = [phase for phase, _, _ in drawn[0].motion.phases]
    carrying = [number for number, phase in enumerate(phases) if phase in ("transfer", "retrieve")]
    paths = []
    for number in carrying or range(len(phases)):
        found = []
        for solved in drawn:
            _, first, last = solved.motion.phases[number]
            points = hold_points(solved, lift)[first:last + 1]
            at = np.linspace(0.0, len(points) - 1.0, SPREAD_TIMES)
            found.append(np.stack([np.interp(at, np.arange(len(points)), column) for column in points.T], axis=1))
        paths.append(np.array(found))
    return paths


def _collection(name: str, scene: bpy.types.Scene) -> bpy.types.Collection:
    collection = bpy.data.collections.new(name)
    scene.collection.children.link(collection)
    return collection
