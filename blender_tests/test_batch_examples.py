# SPDX-License-Identifier: GPL-3.0-or-later
"""The examples that make pictures of many motions, each run small: what they draw and write is what was predicted."""
from __future__ import annotations

import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import bpy
import numpy as np
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector
from picture_cases import pixels
from reachcast.rigs.joints import INDEX
from reachcast.scene.heat_map import CELL, MARGIN, colour_of
from reachcast.scene.measure import sample
from reachcast.scene.read_rig import read_rig

sys.path.append(os.fspath(Path(__file__).resolve().parent.parent / "examples"))
import keypoints_dataset  # noqa: E402
import line_up  # noqa: E402
import shelf_study  # noqa: E402

COLOUR = 2.5 / 255.0
PIXEL = 0.1             #: predicted joints and posed bones differ by less than a millimetre, some 0.05 pixels here
DEPTH_M = 2e-3          #: single precision in Cycles and in the ray
AGREEMENT = 0.9         #: of visible and depth, where a joint's pixel may be one beside an edge


class Example(unittest.TestCase):
    def setUp(self) -> None:
        self.out = Path(tempfile.mkdtemp(prefix="reachcast-example-"))
        self.addCleanup(shutil.rmtree, self.out, ignore_errors=True)


class ShelfStudy(Example):
    def test_a_trunk_that_lies_level_is_inclined_by_a_right_angle(self) -> None:
        joints = np.zeros((1, 27, 3))
        joints[0, INDEX["c7t1"]] = (0.0, 0.5, 0.0)
        np.testing.assert_allclose(shelf_study.trunk_inclination(joints), [np.pi / 2])

    def test_table_map_and_markers_say_the_same(self) -> None:
        cells = shelf_study.main(["--out", os.fspath(self.out), "--heights", "0.3", "1.1", "2.3", "--statures", "1.6",
                                  "1.8", "--width", "320"])
        self.assertEqual(sorted(os.listdir(self.out)), ["heat_map.png", "study.blend", "study.csv", "study.png"])
        moments = {(cell.stature, cell.height): cell.moment for cell in cells}
        able = [moment for moment in moments.values() if moment == moment]
        with (self.out / "study.csv").open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        for row in rows:
            moment = moments[float(row["stature_m"]), float(row["height_m"])]
            self.assertEqual(row["l5s1_moment_nm"], "" if row["reason"] else f"{moment:.2f}")
            self.assertEqual(bool(row["reason"]), row["height_m"] == "2.3")
        for stature in (1.6, 1.8):
            self.assertGreater(moments[stature, 0.3], 1.3 * moments[stature, 1.1])
        picture = pixels(self.out / "heat_map.png")
        for row, height in enumerate((2.3, 1.1, 0.3)):
            for column, stature in enumerate((1.6, 1.8)):
                shown = picture[MARGIN[1] + CELL[1] * row + 4, MARGIN[0] + CELL[0] * column + 4]
                np.testing.assert_allclose(shown, colour_of(moments[stature, height], min(able), max(able)), atol=COLOUR)
        self.check_scene(moments)

    def check_scene(self, moments: dict[tuple[float, float], float]) -> None:
        bpy.ops.wm.open_mainfile(filepath=os.fspath(self.out / "study.blend"))
        markers = {item["reachcast_study"].split(":")[0]: item for item in bpy.data.objects if "reachcast_study" in item}
        self.assertEqual(len(markers), len(moments))
        self.assertEqual(len([item for item in bpy.data.objects if item.type == "ARMATURE" and item.children]), 2)
        for (stature, height), moment in moments.items():
            marker = markers[f"{stature:g} m to {height:g} m"]
            self.assertAlmostEqual(marker.location.z, height, places=5)
            grey = np.ptp(marker.active_material.diffuse_color[:3]) < 1e-6
            self.assertEqual(grey, moment != moment)


class Keypoints(Example):
    SIZE = (160, 120)

    def test_keypoints_and_depth_are_where_blender_sees_them(self) -> None:
        said = keypoints_dataset.main(["--out", os.fspath(self.out), "--variants", "2", "--cameras", "2", "--step", "70",
                                       "--size", "160x120", "--engine", "WORKBENCH"])
        self.assertEqual(json.loads((self.out / "annotations.json").read_text()), said)
        scene = bpy.context.scene
        rig = next(item for item in scene.objects if item.type == "ARMATURE")
        skeleton, agreed, asked = read_rig(rig), 0, 0
        last = [(image, note) for image, note in zip(said["images"], said["annotations"])
                if image["variant_seed"] == said["images"][-1]["variant_seed"]]
        self.assertEqual({image["variant_seed"] for image in said["images"]}, {1, 2})
        self.assertEqual({tuple(item.size) for item in map(self.loaded, said["images"])}, {self.SIZE})
        for image, note in last:
            camera = scene.objects[f"Camera {image['file_name'][len('images/v1_c')]}"]
            scene.frame_set(image["frame"])
            joints = sample(rig, skeleton, [image["frame"]]).joints[0]
            depth = pixels(self.out / image["depth_file_name"])[..., 0]
            self.check_depth(camera, depth)
            self.assertEqual(note["num_keypoints"], 23)
            for joint, (x, y, seen) in zip(joints, np.reshape(note["keypoints"], (-1, 3))):
                place = world_to_camera_view(scene, camera, Vector(joint))
                self.assertAlmostEqual(x, place.x * self.SIZE[0], delta=PIXEL)
                self.assertAlmostEqual(y, (1.0 - place.y) * self.SIZE[1], delta=PIXEL)
                surface = depth[int(y), int(x)]
                agreed += (surface > place.z - keypoints_dataset.FLESH_M) == (seen == 2)
                asked += 1
            x, y, width, height = note["bbox"]
            found = np.reshape(note["keypoints"], (-1, 3))[:, :2]
            self.assertTrue(np.all((found >= (x - 0.5, y - 0.5)) & (found <= (x + width + 0.5, y + height + 0.5))))
        self.assertGreater(agreed / asked, AGREEMENT)

    def loaded(self, image: dict[str, object]) -> bpy.types.Image:
        return bpy.data.images.load(os.fspath(self.out / str(image["file_name"])))

    def check_depth(self, camera: bpy.types.Object, depth: np.ndarray) -> None:
        """Rays through the middles of some pixels, by hand."""
        scene, graph = bpy.context.scene, bpy.context.evaluated_depsgraph_get()
        scale = camera.data.sensor_width / camera.data.lens / max(self.SIZE)
        start, turn = camera.matrix_world.translation, camera.matrix_world.to_3x3()
        off = []
        for row in range(3, self.SIZE[1], 9):
            for column in range(3, self.SIZE[0], 9):
                way = Vector(((column + 0.5 - self.SIZE[0] / 2) * scale, (self.SIZE[1] / 2 - row - 0.5) * scale, -1.0))
                hit, place, *_ = scene.ray_cast(graph, start, (turn @ way).normalized())
                ahead = -(turn.transposed() @ (place - start)).z if hit else 0.0
                off.append(abs(ahead - depth[row, column]) / max(ahead, 1.0))
        self.assertLess(np.median(off), DEPTH_M)
        self.assertGreater(np.mean(np.array(off) < DEPTH_M), 0.95)  # the others are at edges


class LineUp(Example):
    def test_everybody_puts_an_own_box_on_an_own_shelf(self) -> None:
        found = line_up.main(["--out", os.fspath(self.out), "--percentiles", "25", "75", "--size", "128x48", "--step",
                              "40", "--engine", "WORKBENCH"])
        self.assertEqual(sorted(os.listdir(self.out)), ["line_up.blend", "line_up.mp4", "line_up.png"])
        self.assertEqual(len(found.results), 4)
        statures = [person.stature for person, _ in found.results]
        self.assertEqual(statures, sorted(statures))
        scene = bpy.context.scene
        scene.frame_set(scene.frame_end)
        graph = bpy.context.evaluated_depsgraph_get()
        boxes = sorted(tuple(item.evaluated_get(graph).matrix_world.translation) for item in scene.objects
                       if item.name.startswith("Box"))
        expected = [(0.1 + line_up.SPACING_M * number, 0.45, 1.2) for number in range(1, 5)]
        np.testing.assert_allclose(boxes, expected, atol=1e-3)
        told = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames",
                               "-of", "csv=p=0", self.out / "line_up.mp4"], capture_output=True, text=True, check=True)
        rate = 24 / 40
        self.assertEqual(int(told.stdout), len(range(1, scene.frame_end + 1, 40)) + round(line_up.REST_S * rate))


if __name__ == "__main__":
    unittest.main()
