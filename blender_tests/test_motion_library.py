# SPDX-License-Identifier: GPL-3.0-or-later
"""The motions of a corpus on rigs, in lists, forgotten, drawn; and rigs' motions captured into a corpus."""
from __future__ import annotations

import tempfile
import unittest
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix
from reachcast import native
from reachcast.corpora import default_corpus
from reachcast.reachcast_corpus.exporting import export_motion
from reachcast.reachcast_corpus.importing import open_or_create
from reachcast.rigs.joints import INDEX, JOINTS
from reachcast.scene.capture import capture_motion, captured_clip
from reachcast.scene.measure import sample
from reachcast.scene import target_cloud
from reachcast.scene.motion_library import forget_motions, play_motion, target_points
from reachcast.scene.read_rig import read_rig
from rig_cases import RIGS

#: Metres: between the hands' middle in the evaluated scene and the recorded places, scaled to the rig.
PLACED_M = 1e-4
#: Metres, mean over joints: a captured motion that is played again on the rig it came from. Splines of eight
#: coefficients cost millimetres; the corpus knows no turning of the box.
AGAIN_M = 0.03
#: Metres, any joint: single precision and the exporters' own sampling.
CAME_BACK_M, LAST_BONES_M = 0.002, 0.1


class MotionLibrary(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.core = native.core()
        self.shipped = self.core.Corpus.open(str(default_corpus()))
        self.rig = RIGS["mannequin"]()
        bpy.context.view_layer.update()

    def first_of(self, phase: str) -> object:
        return next(motion for motion in self.shipped.motions() if motion.phase == phase and motion.id > 4000)

    def own_corpus(self, count: int) -> str:
        path = str(self.folder / "own.sqlite")
        with self.core.Corpus.create(path) as corpus:
            corpus.add(self.shipped.load(list(range(1, count + 1))))
        return path

    def test_a_motion_is_played_where_it_was_recorded_as_the_rig_is_larger(self) -> None:
        skeleton = read_rig(self.rig)
        for phase in ("transfer", "retrieve", "reach", "return"):
            motion = self.first_of(phase)
            result = play_motion(self.rig, motion.id, start_frame=11)
            joints = sample(self.rig, skeleton, [result.first_frame, result.frames["end"]]).joints
            grips = joints[:, -4:-2].mean(axis=1)
            ends = np.array([skeleton.to_body(point) for point in grips])
            larger = skeleton.height / motion.subject.stature
            for held, place, row in ((phase != "reach", motion.home, 0), (phase != "return", motion.target, 1)):
                if held:
                    self.assertLess(np.linalg.norm(ends[row] - np.asarray(place) * larger), PLACED_M, phase)
            self.assertEqual([near.id for near in result.neighbours], [motion.id])
            self.assertFalse(result.outside_data)

    def test_what_cannot_be_played_is_named_and_nothing_is_written(self) -> None:
        with self.assertRaisesRegex(ValueError, "has no motion 99999"):
            play_motion(self.rig, 99999)
        self.assertEqual(len(bpy.data.actions), 0)

    def test_targets_are_drawn_around_the_rig(self) -> None:
        places = target_points(self.shipped)
        self.rig.location.x += 2.0
        bpy.context.view_layer.update()
        moved = target_points(self.shipped, self.rig)
        skeleton = read_rig(self.rig)
        np.testing.assert_allclose(moved, [skeleton.to_world(place) for place in places], atol=1e-6)
        recorded = np.array([motion.target for motion in self.shipped.motions() if motion.phase == "transfer"])
        for place in recorded[::97]:
            self.assertLess(np.linalg.norm(places - place, axis=1).min(), 0.01)

    def test_drawn_targets_follow_the_phase_the_rig_and_where_it_stands(self) -> None:
        settings, listing = bpy.context.scene.reachcast, bpy.context.window_manager.reachcast_motions

        def assert_drawn(phase: str | None) -> None:
            bpy.context.view_layer.update()
            np.testing.assert_allclose(target_cloud.shown_points(), target_points(self.shipped, settings.rig, phase),
                                       atol=1e-5)

        self.addCleanup(setattr, listing, "show_targets", False)
        self.addCleanup(setattr, listing, "phase", "ALL")
        listing.show_targets = True
        assert_drawn(None)
        settings.rig = self.rig
        assert_drawn(None)
        listing.phase = "retrieve"
        assert_drawn("retrieve")
        self.rig.matrix_world = Matrix.Translation((1.0, -2.0, 0.5)) @ Matrix.Rotation(0.8, 4, "Z") @ Matrix.Scale(0.9, 4)
        assert_drawn("retrieve")
        settings.corpus = self.own_corpus(6)
        with self.core.Corpus.open(settings.corpus) as corpus:
            np.testing.assert_allclose(target_cloud.shown_points(), target_points(corpus, self.rig, "retrieve"),
                                       atol=1e-5)
        settings.corpus = str(self.folder / "none.sqlite")
        self.assertIn("none.sqlite", bpy.context.window_manager.reachcast_problem)
        settings.corpus = ""
        self.assertEqual(bpy.context.window_manager.reachcast_problem, "")

    def test_the_list_follows_the_phase(self) -> None:
        listing = bpy.context.window_manager.reachcast_motions
        bpy.ops.reachcast.list_motions()
        self.addCleanup(setattr, listing, "phase", "ALL")
        for phase in ("return", "reach"):
            listing.phase = phase
            self.assertEqual({row.phase for row in listing.rows}, {phase})

    def test_list_play_and_forget_from_the_panel(self) -> None:
        settings, listing = bpy.context.scene.reachcast, bpy.context.window_manager.reachcast_motions
        settings.rig, settings.corpus = self.rig, self.own_corpus(6)
        self.assertFalse(bpy.ops.reachcast.play_motion.poll())
        bpy.ops.reachcast.list_motions()
        self.assertEqual([row.motion for row in listing.rows], [1, 2, 3, 4, 5, 6])
        listing.active = 2
        bpy.ops.reachcast.play_motion()
        self.assertIn("motion 3", self.rig.animation_data.action.name)
        bpy.ops.reachcast.forget_motion()
        left = [row.motion for row in listing.rows]
        self.assertNotIn(3, left)
        with self.core.Corpus.open(settings.corpus) as corpus:
            self.assertEqual([motion.id for motion in corpus.motions()], left)
        settings.corpus = ""
        self.assertFalse(bpy.ops.reachcast.forget_motion.poll())  # the list is of another corpus

    def test_the_corpus_that_ships_is_never_changed(self) -> None:
        before = default_corpus().read_bytes()
        bpy.context.scene.reachcast.corpus = ""
        bpy.ops.reachcast.list_motions()
        with self.assertRaisesRegex(RuntimeError, "stays as it is"):
            bpy.ops.reachcast.forget_motion()
        self.assertFalse(bpy.ops.reachcast.import_motions.poll())
        self.assertEqual(default_corpus().read_bytes(), before)

    def test_forgetting_counts(self) -> None:
        path = self.own_corpus(4)
        self.assertEqual(forget_motions(path, [2, 77]), 1)

    def test_recordings_are_imported_from_the_panel(self) -> None:
        folder = self.folder / "recordings"
        folder.mkdir()
        chosen = [motion for motion in self.shipped.motions()
                  if motion.phase == "transfer" and motion.duration > 0.8 and not motion.mirrored][:3]
        names = [export_motion(self.core, self.shipped, motion, folder, "bvh").name for motion in chosen]
        (folder / "broken.bvh").write_text("HIERARCHY")
        settings = bpy.context.scene.reachcast
        settings.corpus = str(self.folder / "new.sqlite")
        table = self.folder / "labels.csv"
        table.write_text("file,phase,start_s,end_s\n" + "".join(
            f"{name},transfer,0,{motion.duration - 0.05:.2f}\n" for name, motion in zip(names, chosen)))
        bpy.ops.reachcast.import_motions(filepath=str(folder), labels=str(table))
        listing = bpy.context.window_manager.reachcast_motions
        self.assertEqual(listing.total, 6)  # mirror images included
        report = bpy.data.texts["Reachcast Import"].as_string()
        self.assertTrue(all(name in report for name in [*names, "broken.bvh"]), report)
        self.assertIn("the whole file", report)
        before = Path(settings.corpus).read_bytes()
        bpy.ops.reachcast.import_motions(filepath=str(folder), labels=str(table))
        self.assertEqual(Path(settings.corpus).read_bytes(), before)
        with self.assertRaisesRegex(RuntimeError, "holds no recording"):
            (self.folder / "empty").mkdir()
            bpy.ops.reachcast.import_motions(filepath=str(self.folder / "empty"))

    def test_what_fbx_and_gltf_keep_is_captured_alike(self) -> None:
        settings = bpy.context.scene.reachcast
        settings.rig, motion = self.rig, next(motion for motion in self.shipped.motions()
                                              if motion.phase == "transfer" and motion.duration > 1.0)
        result = play_motion(self.rig, motion.id, start_frame=1)
        scene = bpy.context.scene
        scene.frame_start, scene.frame_end = 1, result.frames["end"]
        expected = captured_clip(self.rig, 1, scene.frame_end).positions
        for item in [item for item in bpy.data.objects if item.type == "MESH"]:
            bpy.data.objects.remove(item)  # Blender 3.4's glTF importer fails on meshes with Debian's numpy
        for form, write, read in (
                ("glb", lambda path: bpy.ops.export_scene.gltf(filepath=path, export_frame_range=True),
                 lambda path: bpy.ops.import_scene.gltf(filepath=path, bone_heuristic="BLENDER")),
                ("fbx", lambda path: bpy.ops.export_scene.fbx(filepath=path, bake_anim_simplify_factor=0.0),
                 lambda path: bpy.ops.import_scene.fbx(filepath=path))):
            path = str(self.folder / f"lift.{form}")
            write(path)
            known = set(bpy.data.objects)
            read(path)
            rig = next(item for item in set(bpy.data.objects) - known if item.type == "ARMATURE")
            offset = int(round(rig.animation_data.action.frame_range[0])) - 1
            bpy.context.view_layer.update()
            came = captured_clip(rig, 1 + offset, scene.frame_end + offset).positions
            apart = np.linalg.norm(came - expected, axis=2)
            # Neither format keeps how long the last bones are: of hands and head, only where they begin comes back.
            last = [INDEX[joint] for joint in JOINTS
                    if joint.endswith(("front", "back", "grip")) or joint in ("tragion", "nasion")]
            self.assertLess(apart[:, last].max(), LAST_BONES_M, form)
            apart = np.delete(apart, last, axis=1)
            self.assertLess(apart.max(), CAME_BACK_M, form)

    def test_a_captured_motion_comes_back_on_its_rig(self) -> None:
        motion = self.first_of("transfer")
        played = play_motion(self.rig, motion.id, start_frame=1)
        first, last = played.frames["lift_off"], played.frames["placed"]
        skeleton = read_rig(self.rig)
        before = sample(self.rig, skeleton, range(first, last + 1)).joints
        path = self.folder / "captured.sqlite"
        with open_or_create(self.core, path) as corpus:
            report = capture_motion(self.rig, corpus, first, last, phase="transfer")
            self.assertEqual((report.state, report.motions, report.phases), ("imported", 2, ("transfer",)))
            self.assertEqual(capture_motion(self.rig, corpus, first, last, phase="transfer").state, "known")
        again = play_motion(self.rig, 1, corpus=str(path), start_frame=1)
        start = again.frames["lift_off"]
        after = sample(self.rig, skeleton, range(start, start + len(before))).joints
        self.assertLess(np.linalg.norm(after - before, axis=2).mean(), AGAIN_M)

    def test_captured_joints_are_the_evaluated_ones(self) -> None:
        result = play_motion(self.rig, self.first_of("transfer").id, start_frame=1)
        clip = captured_clip(self.rig, 1, result.frames["end"])
        self.assertEqual(len(clip), result.frames["end"])
        skeleton = read_rig(self.rig)
        np.testing.assert_allclose(clip.positions[4], sample(self.rig, skeleton, [5]).joints[0], atol=1e-9)
        with self.assertRaisesRegex(ValueError, "at least 4"):
            captured_clip(self.rig, 1, 3)
