# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of a batch: the camera sees the whole motion, and frames, film and sheet show the same pictures."""
from __future__ import annotations

import csv
import json
import math
import os
import shutil
import subprocess
import tempfile
import unittest
from fractions import Fraction
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector
from picture_cases import pixels
from reachcast import native
from reachcast.batch.pictures import moments, ready_camera
from reachcast.batch.run import run_batch
from reachcast.batch.stage import Stage
from reachcast.batch.tasks import read_task, units_of
from reachcast.corpora import default_corpus, opened_corpus
from reachcast.scene.film import CAPTION, GAP, PANEL_WIDTH, Moment, write_contact_sheet
from reachcast.scene.measure import sample
from reachcast.scene.predict_action import write_solved
from reachcast.scene.prepare import solve
from reachcast.scene.render import set_pictures
from reachcast.scene.studio import studio_of

HOME, TARGET = "0 0.42 0.1", "0.2 0.45 1.0"
SMALL = {"home": HOME, "target": TARGET, "engine": "WORKBENCH", "resolution": "96x64"}
SAME = 2.5 / 255.0        #: one step of eight bits, twice
FILM = 0.03               #: mean difference of a film's picture, which H.264 has been over


def projected(camera: bpy.types.Object, points: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    """(N, 2) from the lower left corner of the picture, in parts of its width and height; a pinhole by hand."""
    local = (points - np.array(camera.matrix_world.translation)) @ np.array(camera.matrix_world.to_3x3())
    view = camera.data.sensor_width / camera.data.lens * np.array(size) / max(size)
    place = local[:, :2] / -local[:, 2:] / view + 0.5
    place[local[:, 2] >= 0.0] = np.nan
    return place


class Pictures(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="reachcast-pictures-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.out = self.folder / "out"

    def run_rows(self, *rows: dict[str, object]) -> list[dict[str, str]]:
        table = self.folder / "tasks.jsonl"
        table.write_text("".join(json.dumps(row) + "\n" for row in rows))
        run_batch(table, self.out, say=lambda _: None)
        with (self.out / "results.csv").open(newline="") as file:
            return list(csv.DictReader(file))

    def test_the_camera_sees_body_and_box_in_every_frame(self) -> None:
        stage = Stage(opened_corpus(native.core(), os.fspath(default_corpus())))
        scene = bpy.context.scene
        for number, (target, stature, size, phases) in enumerate((
                ("0.5 0.4 1.3", 1.9, (96, 64), "reach transfer return"), ("-0.6 0.2 0.4", 1.5, (64, 128), "transfer"),
                ("0 0.5 0.9", 1.7, (128, 64), "reach transfer return reach retrieve"))):
            task = read_task({"home": HOME, "target": target, "stature": stature, "phases": phases,
                              "resolution": list(size), "outputs": "sheet"}, number + 1)
            prepared, worker, load = stage.prepared(units_of(task)[0])
            solved = solve(prepared)
            write_solved(prepared, solved, worker.rig, load.box, "seen", 1, bpy.context.view_layer)
            set_pictures(scene, task.engine, task.resolution)
            camera = ready_camera(task, prepared, solved, load)
            bpy.context.view_layer.update()
            frames = range(1, len(solved.joints) + 1)
            shown = sample(worker.rig, worker.skeleton, frames, load.box)
            corners = np.array([tuple(corner) for corner in load.box.bound_box])
            boxes = shown.box_origins[:, None] + np.einsum("fij,cj->fci", shown.box_axes, corners)
            meshes = [item for item in worker.rig.children if item.type == "MESH"]
            flesh = self.flesh(meshes, [frames[0], frames[len(frames) // 2], frames[-1]])
            places = projected(camera, np.concatenate([shown.joints.reshape(-1, 3), boxes.reshape(-1, 3), flesh]), size)
            self.assertGreaterEqual(places.min(), 0.0)
            self.assertLessEqual(places.max(), 1.0)
            self.assertGreater(np.ptp(places, axis=0).max(), 0.6)

    def flesh(self, meshes, frames) -> np.ndarray:  # type: ignore[no-untyped-def]
        found = []
        for frame in frames:
            bpy.context.scene.frame_set(frame)
            graph = bpy.context.evaluated_depsgraph_get()
            for item in meshes:
                shown = item.evaluated_get(graph)
                found += [tuple(shown.matrix_world @ vertex.co) for vertex in list(shown.data.vertices)[::7]]
        return np.array(found)

    def test_captions_are_there_however_often_factory_settings_were_read(self) -> None:
        for _ in range(2):
            bpy.ops.wm.read_factory_settings(use_empty=True)
            image = bpy.data.images.new("grey", 120, 60)
            image.filepath_raw, image.file_format = os.fspath(self.folder / "grey.png"), "PNG"
            image.save()
            write_contact_sheet([Moment(0, "on the way")], {0: self.folder / "grey.png"}, (120, 60),
                                self.folder / "sheet.png")
            beneath = pixels(self.folder / "sheet.png")[GAP + 60 + 1:]
            self.assertLess(beneath.min(), 0.5)           # ink
            self.assertGreater(np.median(beneath), 0.9)   # on paper
            self.assertFalse(bpy.data.fonts)

    def test_a_sheet_is_the_same_whatever_the_scenes_frame(self) -> None:
        folder = self.folder
        image = bpy.data.images.new("grey", 40, 30)
        image.filepath_raw, image.file_format = os.fspath(folder / "grey.png"), "PNG"
        image.save()
        sheets = []
        for frame in (1, 40):
            bpy.context.scene.frame_set(frame)
            write_contact_sheet([Moment(0, "a")], {0: folder / "grey.png"}, (40, 30), folder / "sheet.png")
            sheets.append(pixels(folder / "sheet.png"))
        np.testing.assert_array_equal(*sheets)
        self.assertGreater(sheets[0].max(), 0.9)  # paper

    def test_frames_film_and_sheet_show_the_same(self) -> None:
        row, = self.run_rows({"id": "a", **SMALL, "outputs": "png mp4 sheet", "frame_step": 10})
        folder = self.out / "tasks" / "a"
        self.assertEqual(row["files"], "motion.mp4 sheet.png frames thumbnail.png", row["reason"])
        count = round(float(row["duration_s"]) * 24) + 1
        frames = sorted(folder.glob("frames/*.png"))
        self.assertEqual([int(path.stem) for path in frames], list(range(1, count + 1, 10)))
        pictures = [pixels(path) for path in frames]
        self.assertEqual({picture.shape for picture in pictures}, {(64, 96, 3)})
        self.assertGreater(np.abs(pictures[0] - pictures[-1]).max(), 0.2)
        self.check_film(folder / "motion.mp4", pictures)
        sheet = pixels(folder / "sheet.png")
        np.testing.assert_allclose(sheet[GAP:GAP + 64, GAP:GAP + 96], pictures[0], atol=SAME)
        self.assertEqual(sheet.shape[1], 3 * (min(96, PANEL_WIDTH) + 2 * GAP))
        self.assertEqual(sheet.shape[0] % (64 + 2 * GAP + CAPTION), 0)
        self.assertEqual({image.type for image in bpy.data.images}, {"RENDER_RESULT"})
        self.assertEqual(len(bpy.data.scenes), 1)

    def check_film(self, path: Path, pictures: list[np.ndarray]) -> None:
        told = subprocess.run(["ffprobe", "-v", "error", "-show_entries", "stream=codec_name,pix_fmt,r_frame_rate",
                               "-of", "csv=p=0", path], capture_output=True, text=True, check=True).stdout
        codec, form, rate = told.strip().split(",")
        self.assertEqual((codec, form), ("h264", "yuv420p"))
        self.assertAlmostEqual(float(Fraction(rate)), 2.4, places=3)
        raw = subprocess.run(["ffmpeg", "-v", "error", "-i", path, "-f", "rawvideo", "-pix_fmt", "rgb24", "-"],
                             capture_output=True, check=True).stdout
        film = np.frombuffer(raw, np.uint8).reshape(-1, *pictures[0].shape) / 255.0
        self.assertEqual(len(film), len(pictures))
        for shown, picture in zip(film, pictures):
            self.assertLess(np.abs(shown - picture).mean(), FILM)

    def test_a_picture_does_not_depend_on_the_tasks_before(self) -> None:
        wanted = {"id": "b", **SMALL, "stature": 1.8, "object": "0.3x0.3x0.3", "outputs": "sheet"}
        self.run_rows({"id": "a", **SMALL, "stature": 1.5, "target": "-0.5 0.3 0.7", "outputs": "sheet"}, wanted)
        after = (self.out / "tasks" / "b" / "sheet.png").read_bytes()
        shutil.rmtree(self.out)
        bpy.ops.wm.read_factory_settings(use_empty=True)
        self.run_rows(wanted)
        self.assertEqual((self.out / "tasks" / "b" / "sheet.png").read_bytes(), after)

    def test_a_camera_of_the_scene_is_looked_through_and_no_studio_is_built(self) -> None:
        camera = bpy.data.objects.new("Side", bpy.data.cameras.new("Side"))
        camera.location, camera.rotation_euler = (4.0, 0.2, 1.0), (math.pi / 2, 0.0, math.pi / 2)
        bpy.context.scene.collection.objects.link(camera)
        before = bpy.context.scene.render.engine
        row, other = self.run_rows({"id": "a", **SMALL, "camera": "Side", "outputs": "sheet"},
                                   {"id": "b", **SMALL, "camera": "Top", "outputs": "sheet"})
        self.assertEqual(row["status"], "done", row["reason"])
        self.assertEqual((other["status"], other["reason"]), ("refused", "The camera 'Top' is not in the scene"))
        self.assertIsNone(studio_of(bpy.context.scene))
        self.assertEqual(camera.location, Vector((4.0, 0.2, 1.0)))
        self.assertEqual(bpy.context.scene.render.engine, before)
        self.assertIsNone(bpy.context.scene.camera)

    def test_every_engine_draws(self) -> None:
        rows = self.run_rows(*({"id": name, **SMALL, "resolution": "32x24", "engine": name, "outputs": "mp4",
                                "frame_step": 100} for name in ("EEVEE", "WORKBENCH", "CYCLES")))
        for row in rows:
            self.assertEqual(row["status"], "done", row["reason"])
            picture = pixels(self.out / "tasks" / row["id"] / "thumbnail.png")
            self.assertGreater(picture.std(), 0.02)
            self.assertFalse((self.out / "tasks" / row["id"] / "frames").exists())

    def test_cells_of_pictures_are_checked(self) -> None:
        for cell, value, words in (("engine", "LUX", "EEVEE, WORKBENCH or CYCLES"), ("resolution", "641x480", "even"),
                                   ("resolution", "640", "width x height"), ("frame_step", 0, "from 1 to 100")):
            with self.subTest(cell=cell), self.assertRaisesRegex(ValueError, f"{cell} is .*{words}"):
                read_task({"target": TARGET, cell: value}, 1)

    def test_moments_are_in_order_and_each_frame_is_there_once(self) -> None:
        found = moments({"grasp": 10, "lift_off": 16, "placed": 46, "release": 52, "end": 80}, 81, 24.0, 5)
        self.assertEqual([moment.frame for moment in found], [5, 15, 21, 31, 41, 51, 57, 85])
        self.assertEqual([moment.label.split("  ")[0] for moment in found],
                         ["start", "grasp", "lift off", "on the way", "on the way", "placed", "release", "end"])
        found = moments({"grasp": 10, "lift_off": 16, "placed": 46, "release": 52, "grasp_2": 80, "lift_off_2": 86,
                         "placed_2": 120, "release_2": 126, "end": 126}, 151, 24.0, 1)
        self.assertEqual([moment.label.split("  ")[0] for moment in found],
                         ["start", *("grasp", "lift off", "placed", "release") * 2, "end"])


if __name__ == "__main__":
    unittest.main()
