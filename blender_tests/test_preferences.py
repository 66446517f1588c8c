# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's preferences: corpora offered, the usual person, units; they survive Blender's end."""
from __future__ import annotations

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import addon_utils
import bpy
import reachcast
from reachcast import preferences
from reachcast.operators.predict_motion import task_of

_WRITE = """
import bpy
bpy.ops.preferences.addon_enable(module="reachcast")
chosen = bpy.context.preferences.addons["reachcast"].preferences
for folder in ("/corpora/one", "/corpora/two"):
    assert bpy.ops.reachcast.add_corpus_folder(directory=folder) == {"FINISHED"}
chosen.stature, chosen.sex, chosen.age, chosen.mass, chosen.units = 1.62, "FEMALE", 41.0, 58.0, "INCHES"
bpy.ops.wm.save_userpref()
"""
_READ = """
import bpy
chosen = bpy.context.preferences.addons["reachcast"].preferences
found = ([item.folder for item in chosen.corpus_folders], round(chosen.stature, 6), chosen.sex, chosen.age, chosen.mass,
         chosen.units, round(bpy.context.scene.reachcast.stature, 6))
print("found", found)
assert found == (["/corpora/one", "/corpora/two"], 1.62, "FEMALE", 41.0, 58.0, "INCHES", 1.62), found
"""


class Preferences(unittest.TestCase):
    def setUp(self) -> None:
        addon_utils.disable("reachcast")
        addon_utils.enable("reachcast", default_set=True)
        self.chosen = preferences.of_addon()
        self.settings = bpy.context.scene.reachcast

    def test_corpora_of_the_folders_are_offered_by_name(self) -> None:
        with tempfile.TemporaryDirectory() as first, tempfile.TemporaryDirectory() as second:
            for folder, name in ((first, "b.sqlite"), (first, "a.sqlite"), (first, "notes.txt"), (second, "c.sqlite")):
                (Path(folder) / name).touch()
            for folder in (first, second, first, "/nowhere/at/all"):
                self.assertEqual(bpy.ops.reachcast.add_corpus_folder(directory=folder), {"FINISHED"})
            names = [path.name for path in preferences.offered_corpora()]
            self.assertEqual(names, ["a.sqlite", "b.sqlite", "c.sqlite"])
            chosen = preferences.offered_corpora()[1]
            self.assertEqual(bpy.ops.reachcast.choose_corpus(path=str(chosen)), {"FINISHED"})
            self.assertEqual(self.settings.corpus, os.path.join(first, "b.sqlite"))
            self.assertEqual(bpy.ops.reachcast.remove_corpus_folder(index=1), {"FINISHED"})
            self.assertEqual([item.folder for item in self.chosen.corpus_folders], [first, first, "/nowhere/at/all"])
            with self.assertRaisesRegex(RuntimeError, "no folder 7"):
                bpy.ops.reachcast.remove_corpus_folder(index=7)

    def test_the_usual_person_holds_until_the_scene_says_another(self) -> None:
        self.chosen.stature, self.chosen.sex, self.chosen.age, self.chosen.mass = 1.62, "FEMALE", 41.0, 58.0
        task = task_of(bpy.context)
        self.assertAlmostEqual(task["stature"], 1.62, places=6)
        self.assertEqual((task["sex"], task["age"], task["mass"]), ("female", 41.0, 58.0))
        self.settings.stature, self.settings.sex, self.settings.age, self.settings.mass = 0.0, "ANY", 0.0, 0.0
        task = task_of(bpy.context)
        self.assertEqual([task[name] for name in ("stature", "sex", "age", "mass")], [None] * 4)

    def test_a_scene_keeps_its_own_person_in_its_file(self) -> None:
        self.settings.stature, self.settings.sex, self.settings.mass = 1.8, "MALE", 80.0
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "own.blend")
            bpy.ops.wm.save_as_mainfile(filepath=path)
            bpy.ops.wm.read_homefile(use_empty=True)
            self.chosen = preferences.of_addon()
            self.chosen.stature, self.chosen.sex = 1.5, "FEMALE"
            self.assertAlmostEqual(bpy.context.scene.reachcast.stature, 1.5)
            bpy.ops.wm.open_mainfile(filepath=path)
        settings = bpy.context.scene.reachcast
        self.assertAlmostEqual(settings.stature, 1.8, places=6)
        self.assertEqual((settings.sex, settings.mass, settings.age), ("MALE", 80.0, 0.0))

    def test_units(self) -> None:
        for units, length, error in (("METRES", "1.20 m", "0.05 mm"), ("CENTIMETRES", "120 cm", "0.05 mm"),
                                     ("INCHES", "47.2 in", "0.002 in")):
            self.chosen.units = units
            self.assertEqual((preferences.length_text(1.2), preferences.error_text(5e-5)), (length, error))
        self.chosen.units = "CENTIMETRES"
        self.assertEqual(preferences.place_text((-0.014, 0.37, 1.2)), "(-1, 37, 120) cm")

    def test_enabled_by_a_script_alone_the_defaults_hold(self) -> None:
        addon_utils.disable("reachcast", default_set=True)
        addon_utils.enable("reachcast")
        self.assertIsNone(preferences.of_addon())
        self.assertEqual(preferences.offered_corpora(), [])
        self.assertEqual((bpy.context.scene.reachcast.stature, preferences.length_text(1.0)), (0.0, "1.00 m"))
        self.assertFalse(bpy.ops.reachcast.add_corpus_folder.poll())


class Kept(unittest.TestCase):
    def test_saved_preferences_are_there_in_the_next_blender(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            environment = dict(os.environ)
            for kind in ("SCRIPTS", "CONFIG", "DATAFILES"):
                (Path(folder) / kind).mkdir()
                environment[f"BLENDER_USER_{kind}"] = os.path.join(folder, kind)
            (Path(folder) / "SCRIPTS" / "addons").mkdir()
            (Path(folder) / "SCRIPTS" / "addons" / "reachcast").symlink_to(Path(reachcast.__file__).parent)
            for code in (_WRITE, _READ):
                done = subprocess.run([bpy.app.binary_path, "-b", "--python-exit-code", "1", "--python-expr", code],
                                      capture_output=True, text=True, env=environment, check=False, timeout=120)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                self.assertNotIn("Traceback", done.stdout + done.stderr)
