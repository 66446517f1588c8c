# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on comes and goes without a trace, works without its native module and says what it lacks."""
from __future__ import annotations

import ast
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import addon_utils
import bpy
import fake_core
import reachcast
from lift_cases import cuboid
from reachcast import native, registration
from reachcast.properties import missing, needs
from reachcast.scene.read_task import read_box
from rig_cases import mannequin

CYCLES = 5


def traces() -> dict[str, object]:
    """Everything an add-on could leave behind."""
    return {
        "classes": sorted(name for name in dir(bpy.types) if "reachcast" in name.lower()),
        "operators": dir(bpy.ops.reachcast),
        "scene": sorted(name for name in bpy.types.Scene.bl_rna.properties.keys() if "reachcast" in name),
        "window manager": sorted(name for name in dir(bpy.types.WindowManager) if "reachcast" in name),
        "handlers": {name: [repr(handler) for handler in getattr(bpy.app.handlers, name)]
                     for name in dir(bpy.app.handlers) if isinstance(getattr(bpy.app.handlers, name), list)},
        "menu": len(bpy.types.VIEW3D_MT_armature_add._dyn_ui_initialize()),
    }


class ComesAndGoes(unittest.TestCase):
    def test_five_cycles_leave_nothing(self) -> None:
        on = traces()
        addon_utils.disable("reachcast")
        off = traces()
        self.assertEqual(off["classes"], [])
        self.assertEqual(off["scene"], [])
        self.assertEqual(off["window manager"], [])
        for _ in range(CYCLES):
            addon_utils.enable("reachcast")
            self.assertEqual(traces(), on)
            addon_utils.disable("reachcast")
            self.assertEqual(traces(), off)
        addon_utils.enable("reachcast")

    def test_bl_info_is_literal(self) -> None:
        tree = ast.parse(Path(reachcast.__file__).read_text(encoding="utf-8"))
        value = next(node.value for node in tree.body if isinstance(node, ast.Assign)
                     and getattr(node.targets[0], "id", "") == "bl_info")
        info = ast.literal_eval(value)
        self.assertEqual((info["blender"], info["category"]), ((3, 4, 0), "Animation"))

    def test_every_class_is_registered(self) -> None:
        for cls in registration.CLASSES:
            self.assertTrue(cls.is_registered, cls)


class NativeModule(unittest.TestCase):
    def load(self, *files: str) -> str:
        """The reason given when the add-on's folder has only these files."""
        with tempfile.TemporaryDirectory() as folder:
            for name in files:
                (Path(folder) / name).write_bytes(b"not a library")
            with mock.patch.object(native, "FOLDER", Path(folder)), mock.patch.dict(sys.modules):
                sys.modules.pop("reachcast_core", None)
                reason = native.reason()
                with self.assertRaisesRegex(ValueError, "reachcast_core"):
                    native.core()
        self.assertIsNotNone(reason)
        self.assertNotIn("\n", str(reason))
        return str(reason)

    def test_missing_file_says_how_to_build(self) -> None:
        self.assertIn("cmake", self.load())

    def test_other_python_names_both(self) -> None:
        reason = self.load("reachcast_core.cpython-39-x86_64-linux-gnu.so")
        self.assertIn("cpython-39", reason)
        self.assertIn(f"cpython-{sys.version_info[0]}{sys.version_info[1]}", reason)

    def test_broken_file_says_so(self) -> None:
        suffix = f"cpython-{sys.version_info[0]}{sys.version_info[1]}-x86_64-linux-gnu.so"
        self.assertIn("cannot be loaded", self.load(f"reachcast_core.{suffix}"))

    def test_is_loaded_once(self) -> None:
        with fake_core.installed():
            self.assertIs(native.core(), sys.modules["reachcast_core"])
            self.assertIs(native.core(), native.core())

    def test_without_it_the_button_is_off_and_says_why(self) -> None:
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(native, "FOLDER", Path(folder)), \
                mock.patch.dict(sys.modules):
            sys.modules.pop("reachcast_core", None)
            self.assertFalse(bpy.ops.reachcast.predict_motion.poll())
            self.assertIn("missing", str(missing(bpy.context.scene.reachcast)))


class Readiness(unittest.TestCase):
    def setUp(self) -> None:
        installed = fake_core.installed()
        installed.start()
        self.addCleanup(installed.stop)

    def test_each_need_is_named_until_all_are_met(self) -> None:
        settings = bpy.context.scene.reachcast
        self.assertIn("armature", str(missing(settings)))
        settings.rig = mannequin()
        self.assertIn("Empty", str(missing(settings)))
        settings.shelf = bpy.data.objects.new("Shelf", None)
        settings.corpus = "/nowhere/lifts.sqlite"
        self.assertIn("/nowhere/lifts.sqlite", str(missing(settings)))
        self.assertFalse(bpy.ops.reachcast.predict_motion.poll())
        settings.corpus = __file__
        self.assertIsNone(missing(settings))
        self.assertTrue(bpy.ops.reachcast.predict_motion.poll())

    def test_a_rig_with_missing_bones_names_them(self) -> None:
        settings = bpy.context.scene.reachcast
        settings.rig = mannequin()
        settings.rig.data.bones["shin.L"].name = "stick"
        reason = next(need.reason for need in needs(settings) if need.name == "Rig")
        self.assertIn("shin.L", str(reason))


class BoxMass(unittest.TestCase):
    def test_it_is_the_custom_property_that_predictions_read(self) -> None:
        box = cuboid("Box", (0.3, 0.3, 0.3))
        self.assertEqual(box.reachcast_box_mass, read_box(box).mass)
        box.reachcast_box_mass = 12.5
        self.assertEqual((box["reachcast_mass"], read_box(box).mass), (12.5, 12.5))
        box["reachcast_mass"] = "heavy"
        self.assertEqual(box.reachcast_box_mass, 0.0)
        with self.assertRaisesRegex(ValueError, "reachcast_mass is 'heavy'"):
            read_box(box)


class AddMannequin(unittest.TestCase):
    def test_menu_entry_adds_a_figure_of_the_stature_at_the_cursor(self) -> None:
        with fake_core.installed():
            bpy.context.scene.cursor.location = (1.0, 2.0, 0.5)
            self.assertEqual(bpy.ops.reachcast.add_mannequin(stature=1.62, sex="FEMALE"), {"FINISHED"})
        rig = bpy.context.scene.reachcast.rig
        self.assertEqual(rig.type, "ARMATURE")
        bpy.context.view_layer.update()
        top = (rig.matrix_world @ rig.data.bones["head"].tail_local).z
        self.assertAlmostEqual(top - 0.5, 1.62, delta=0.02)
        self.assertAlmostEqual(rig.matrix_world.translation.x, 1.0)
