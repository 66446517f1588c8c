# SPDX-License-Identifier: GPL-3.0-or-later
"""A rig's bone map edited by hand, saved as a preset, found again on another rig, exported and imported."""
from __future__ import annotations

import tempfile
import unittest
from pathlib import Path
from unittest import mock

import bpy
from reachcast.scene import map_editing
from reachcast.scene.read_rig import read_rig, recognise
from rig_cases import mannequin


def renamed() -> bpy.types.Object:
    """A mannequin one hand of which has a name that no preset knows."""
    rig = mannequin()
    rig.data.bones["hand.L"].name = "paw"
    bpy.context.scene.reachcast.rig = rig
    return rig


class MapEditing(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        replaced = mock.patch.object(map_editing, "preset_folder", lambda create=False: self.folder)
        replaced.start()
        self.addCleanup(replaced.stop)

    def test_a_missing_bone_is_marked_and_chosen(self) -> None:
        rig = renamed()
        with self.assertRaisesRegex(ValueError, "hand.L"):
            read_rig(rig)
        self.assertEqual(bpy.ops.reachcast.edit_bone_map(), {"FINISHED"})
        self.assertEqual(map_editing.lacking(rig), ["hand.L"])
        self.assertFalse(bpy.ops.reachcast.export_bone_map.poll())
        with self.assertRaisesRegex(ValueError, "hand.L is not mapped"):
            map_editing.save_preset(rig, "Mine")
        rig.reachcast_bones["hand.L"].bone = "paw"
        self.assertEqual(read_rig(rig).bone_map.segments["hand.L"], "paw")
        self.assertEqual(bpy.ops.reachcast.forget_bone_map(), {"FINISHED"})
        with self.assertRaisesRegex(ValueError, "hand.L"):
            read_rig(rig)

    def test_a_saved_map_is_recognised_on_the_next_rig(self) -> None:
        rig = renamed()
        bpy.ops.reachcast.edit_bone_map()
        rig.reachcast_bones["hand.L"].bone = "paw"
        self.assertEqual(bpy.ops.reachcast.save_bone_map(preset="Mine: one"), {"FINISHED"})
        self.assertEqual([path.name for path in self.folder.iterdir()], ["Mine_one.json"])
        found = recognise(renamed())
        self.assertEqual((found.name, found.segments["hand.L"]), ("Mine: one", "paw"))
        (self.folder / "broken.json").write_text("{")
        self.assertEqual(recognise(renamed()).name, "Mine: one")
        with self.assertRaisesRegex(ValueError, "name is ' '|name is ''"):
            map_editing.save_preset(rig, " ")

    def test_exported_and_imported(self) -> None:
        rig, path = renamed(), str(self.folder / "out.txt")
        self.assertFalse(bpy.ops.reachcast.forget_bone_map.poll())
        bpy.ops.reachcast.edit_bone_map()
        rig.reachcast_bones["hand.L"].bone = "paw"
        self.assertEqual(bpy.ops.reachcast.export_bone_map(filepath=path), {"FINISHED"})
        other = renamed()
        self.assertEqual(bpy.ops.reachcast.import_bone_map(filepath=path), {"FINISHED"})
        self.assertEqual(read_rig(other).bone_map.segments, read_rig(rig).bone_map.segments)
        Path(path).write_text("[]")
        with self.assertRaisesRegex(ValueError, "segments"):
            map_editing.import_map(other, path)


if __name__ == "__main__":
    unittest.main()
