# SPDX-License-Identifier: GPL-3.0-or-later
"""Who can put the box on which shelf, and what does it cost their back? Heights x statures, as a heat map and as a scene.

    blender -b --factory-startup --python-exit-code 1 --python examples/shelf_study.py -- --out DIR [--corpus FILE] \\
        [--heights 0.4 0.6 ...] [--statures 1.5 1.6 ...] [--ahead 0.45] [--load 10]

The box starts in front of the body at waist height. Effort is the largest static moment at L5/S1 while the box is
carried (`reachcast_core.back_moment`, segment masses of Winter 2009) of a person of 24 kg per square metre of stature: the
back's, so an arm that is held high costs nothing here.
Writes study.csv, heat_map.png, study.blend (a person per stature at the shelf that costs least, and a marker for every
shelf in the colour of the map; grey: out of reach) and study.png of it.
"""
from __future__ import annotations

import argparse
import csv
import os
import re
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path[:0] = [os.fspath(HERE.parent / "addon"), os.fspath(HERE)]

import addon_utils  # noqa: E402
import bpy  # noqa: E402
import numpy as np  # noqa: E402
from mathutils import Vector  # noqa: E402

addon_utils.enable("reachcast")

import demo_render as render  # noqa: E402
from reachcast import native  # noqa: E402
from reachcast.batch.stage import Stage  # noqa: E402
from reachcast.batch.tasks import Unit, read_task  # noqa: E402
from reachcast.corpora import default_corpus, opened_corpus  # noqa: E402
from reachcast.rigs.joints import INDEX  # noqa: E402
from reachcast.scene.ghosts import perform_aside  # noqa: E402
from reachcast.scene.heat_map import colour_of, write_heat_map  # noqa: E402
from reachcast.scene.prepare import Solved, solve  # noqa: E402

BODY_MASS_INDEX = 24.0   # kg per square metre of stature
SPACING_M = 1.3          # between the people of the scene
MARKER_M = 0.05


@dataclass(frozen=True)
class Cell:
    """One person and one shelf. moment: NaN where it cannot be done, for `reason`."""

    stature: float
    height: float
    moment: float = float("nan")       #: N m
    inclination: float = float("nan")  #: of the trunk, degrees, the most while the box is carried
    reason: str = ""

    @property
    def text(self) -> str:
        """The moment, or by how much the shelf is out of reach."""
        if not self.reason:
            return f"{self.moment:.0f}"
        short = re.search(r"([\d.]+) cm out of reach", self.reason)
        return f"{float(short[1]):.3g} cm" if short else "no"


def arguments(given: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="shelf_study.py")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--corpus", type=Path)
    parser.add_argument("--heights", type=float, nargs="+", default=[0.2, 0.5, 0.8, 1.1, 1.4, 1.7, 2.0])
    parser.add_argument("--statures", type=float, nargs="+", default=[1.5, 1.6, 1.7, 1.8, 1.9])
    parser.add_argument("--ahead", type=float, default=0.45, help="from the feet to the middle of the box, metres")
    parser.add_argument("--load", type=float, default=10.0, help="kilograms")
    parser.add_argument("--width", type=int, default=960, help="of the picture of the scene, pixels")
    return parser.parse_args(list(given))


def unit(options: argparse.Namespace, stature: float, height: float, outputs: str = "csv") -> Unit:
    return Unit(read_task({"stature": stature, "target": [0.0, options.ahead, height], "load": options.load,
                           "outputs": outputs}, 1), None)


def carried(solved: Solved) -> slice:
    return slice(solved.motion.events["lift_off"], solved.motion.events["placed"] + 1)


def studied(stage: Stage, options: argparse.Namespace, stature: float, height: float) -> Cell:
    try:
        prepared, _, load = stage.prepared(unit(options, stature, height))
        solved = solve(prepared)
    except ValueError as error:
        return Cell(stature, height, reason=str(error))
    origins, turns = solved.places
    centres = origins + turns @ np.array([0.0, 0.0, 0.5 * load.shape.height])
    while_held = carried(solved)
    joints = solved.joints[while_held]
    moment = native.core().back_moment(joints, BODY_MASS_INDEX * stature ** 2, options.load, centres[while_held])
    return Cell(stature, height, float(moment.max()), float(np.degrees(trunk_inclination(joints).max())))


def trunk_inclination(joints: np.ndarray) -> np.ndarray:
    """(F,) radians of the line from L5/S1 to C7/T1 from the vertical, of (F, 27, 3) joint centres."""
    trunk = joints[:, INDEX["c7t1"]] - joints[:, INDEX["l5s1"]]
    return np.arctan2(np.linalg.norm(trunk[:, :2], axis=1), trunk[:, 2])


def write_table(cells: list[Cell], path: Path) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(("stature_m", "height_m", "l5s1_moment_nm", "trunk_inclination_deg", "reason"))
        for cell in cells:
            numbers = ("", "") if cell.reason else (f"{cell.moment:.2f}", f"{cell.inclination:.2f}")
            table.writerow((f"{cell.stature:g}", f"{cell.height:g}", *numbers, cell.reason))


def draw_map(cells: list[Cell], options: argparse.Namespace, path: Path) -> None:
    by_place = {(cell.height, cell.stature): cell for cell in cells}
    heights, statures = sorted(set(options.heights), reverse=True), sorted(set(options.statures))
    rows = [[by_place[height, stature] for stature in statures] for height in heights]
    write_heat_map(np.array([[cell.moment for cell in row] for row in rows]), [[cell.text for cell in row] for row in rows],
                   [f"{height:g} m" for height in heights], [f"{stature:g} m" for stature in statures],
                   title=f"Moment at L5/S1 when {options.load:g} kg go to a shelf {options.ahead:g} m ahead",
                   across="stature; grey: out of reach, by how much", unit="N m, static", path=path)


def set_scene(stage: Stage, cells: list[Cell], options: argparse.Namespace) -> None:
    """At frame 1 everybody puts the box on the shelf that costs least, between the markers of all shelves."""
    scene = bpy.context.scene
    people = bpy.data.collections.new("Study")
    scene.collection.children.link(people)
    moments = [cell.moment for cell in cells]
    for number, stature in enumerate(sorted(set(options.statures))):
        own = [cell for cell in cells if cell.stature == stature]
        aside = SPACING_M * number
        for cell in own:
            add_marker(people, Vector((aside + 0.32, options.ahead, cell.height)),
                       colour_of(cell.moment, np.nanmin(moments), np.nanmax(moments)),
                       f"{stature:g} m to {cell.height:g} m: {cell.reason or f'{cell.moment:.0f} N m'}")
        able = [cell for cell in own if not cell.reason]
        if able:
            best = min(able, key=lambda cell: cell.moment)
            single = Stage(stage.corpus)  # a figure of its own, which stays
            prepared, worker, load = single.prepared(unit(options, stature, best.height, "png"))
            solved = solve(prepared)
            placed = solved.motion.events["placed"]
            perform_aside(prepared, solved, worker.rig, load.box, f"to {best.height:g} m", 1 - placed, aside, people,
                          bpy.context.view_layer)
            load.box.hide_render = load.box.hide_viewport = True


def add_marker(collection: bpy.types.Collection, place: Vector, colour: tuple[float, float, float], name: str) -> None:
    half = 0.5 * MARKER_M
    mesh = bpy.data.meshes.new(name[:60])
    mesh.from_pydata([(x * 2.5, y, z) for x in (-half, half) for y in (-half, half) for z in (-half, half)], [],
                     [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
    material = bpy.data.materials.new(name[:60])
    material.use_nodes = True
    linear = (*(((part + 0.055) / 1.055) ** 2.4 for part in colour), 1.0)
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = material.diffuse_color = linear
    mesh.materials.append(material)
    marker = bpy.data.objects.new(name[:60], mesh)
    marker["reachcast_study"] = name
    marker.location = place
    collection.objects.link(marker)


def main(given: Sequence[str]) -> list[Cell]:
    options = arguments(given)
    options.out.mkdir(parents=True, exist_ok=True)
    bpy.ops.wm.read_homefile(use_empty=True)
    addon_utils.enable("reachcast")
    stage = Stage(opened_corpus(native.core(), os.fspath(options.corpus or default_corpus())))
    cells = [studied(stage, options, stature, height) for stature in sorted(set(options.statures))
             for height in sorted(set(options.heights))]
    able = [cell for cell in cells if not cell.reason]
    if not able:
        sys.exit(f"shelf_study: nobody can do any of it; first: {cells[0].reason}.")
    write_table(cells, options.out / "study.csv")
    with render.quiet():
        draw_map(cells, options, options.out / "heat_map.png")
        bpy.ops.wm.read_homefile(use_empty=True)
        addon_utils.enable("reachcast")
        set_scene(Stage(stage.corpus), cells, options)
        scene = bpy.context.scene
        scene.frame_set(1)
        shown = [item for item in scene.objects if item.type == "MESH" and not item.hide_render]
        points = render.bounds_over(shown, [1])
        render.furnish(points, True, size=(options.width, options.width // 32 * 18), side_deg=35.0)
        bpy.ops.wm.save_as_mainfile(filepath=os.fspath(options.out / "study.blend"), check_existing=False)
        render.render_frames(options.out, [1])[1].replace(options.out / "study.png")
    best = min(able, key=lambda cell: cell.moment)
    print(f"{len(able)} of {len(cells)} can be done; least: {best.moment:.0f} N m, {best.stature:g} m to "
          f"{best.height:g} m; most: {max(cell.moment for cell in able):.0f} N m", flush=True)
    return cells


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])
