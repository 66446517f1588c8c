# SPDX-License-Identifier: GPL-3.0-or-later
"""A batch's glTF, read back by Blender's own importer and measured against the prediction."""
from __future__ import annotations

import json
import os
import shutil
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import bpy
import numpy as np
from reachcast import native
from reachcast.batch.run import run_batch
from reachcast.batch.stage import Stage
from reachcast.batch.tasks import read_task, units_of
from reachcast.corpora import default_corpus, opened_corpus
from reachcast.rigs.joints import INDEX
from reachcast.scene.predict_action import write_solved
from reachcast.scene.prepare import Solved, solve

ROW = {"id": "g", "home": "0 0.42 0.1", "target": "0.2 0.45 1.0 20", "phases": "reach transfer return", "stature": 1.7,
       "outputs": "gltf"}
EXACT_M = 1e-4     #: single precision, over a chain of bones
HEADS = {"spine": "l5s1", "neck": "c7t1", **{f"{bone}.{side[0].upper()}": f"{side}_{joint}" for side in ("left", "right")
         for bone, joint in (("upper_arm", "shoulder"), ("forearm", "elbow"), ("hand", "wrist"), ("thigh", "hip"),
                             ("shin", "knee"), ("foot", "ankle"), ("toe", "ball"))}}


def evaluated(name: str) -> bpy.types.Object:
    return bpy.context.scene.objects[name].evaluated_get(bpy.context.evaluated_depsgraph_get())


def spread(name: str) -> np.ndarray:
    """(2, 3) world: lowest and highest vertex of a mesh along each axis."""
    shown = evaluated(name)
    places = np.array([tuple(shown.matrix_world @ vertex.co) for vertex in shown.data.vertices])
    return np.array([places.min(axis=0), places.max(axis=0)])


class Gltf(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="reachcast-gltf-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def predicted(self, frames: list[int]) -> tuple[Solved, dict[tuple[str, int], np.ndarray]]:
        """The motion of the task, and where the worn meshes and the box are at some frames when Blender plays it."""
        stage = Stage(opened_corpus(native.core(), os.fspath(default_corpus())))
        prepared, worker, load = stage.prepared(units_of(read_task(ROW, 1))[0])
        solved = solve(prepared)
        write_solved(prepared, solved, worker.rig, load.box, "g", 1, bpy.context.view_layer)
        places = {}
        for frame in frames:
            bpy.context.scene.frame_set(frame)
            for item in (load.box, *(child for child in worker.rig.children if child.type == "MESH")):
                places[item.name, frame] = spread(item.name)
        return solved, places

    def test_bones_meshes_and_box_come_back_where_they_were_predicted(self) -> None:
        table = self.folder / "tasks.jsonl"
        table.write_text(json.dumps(ROW) + "\n")
        run_batch(table, self.folder / "out", say=lambda _: None)
        bpy.ops.wm.read_factory_settings(use_empty=True)
        frames = [1, 45, 70, 110]
        solved, places = self.predicted(frames)
        bpy.ops.wm.read_factory_settings(use_empty=True)
        with mock.patch.object(np, "bool", bool, create=True):  # Blender 3.4's importer knows no NumPy 1.24
            bpy.ops.import_scene.gltf(filepath=os.fspath(self.folder / "out" / "tasks" / "g" / "motion.glb"))
        scene = bpy.context.scene
        rig = next(item for item in scene.objects if item.type == "ARMATURE")
        carried = next(item.name for item in scene.objects if item.name.startswith("Box"))
        for frame in range(1, len(solved.joints) + 1):
            scene.frame_set(frame)
            shown = evaluated(rig.name)
            heads = np.array([tuple(shown.matrix_world @ shown.pose.bones[bone].head) for bone in HEADS])
            expected = solved.joints[frame - 1, [INDEX[joint] for joint in HEADS.values()]]
            self.assertLess(np.linalg.norm(heads - expected, axis=1).max(), EXACT_M, frame)
            box = np.array(evaluated(carried).matrix_world)
            np.testing.assert_allclose(box[:3, 3], solved.places[0][frame - 1], atol=EXACT_M)
            np.testing.assert_allclose(box[:3, :3], solved.places[1][frame - 1], atol=EXACT_M)
            if frame in frames:
                for (name, when), place in places.items():
                    if when == frame:
                        np.testing.assert_allclose(spread(name), place, atol=EXACT_M, err_msg=f"{name} at {frame}")


if __name__ == "__main__":
    unittest.main()
