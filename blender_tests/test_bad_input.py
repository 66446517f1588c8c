# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad input is refused in one sentence, by the function and by the button, and the scene stays as it was."""
from __future__ import annotations

import math
import os
import shutil
import sqlite3
import unittest
from collections.abc import Callable
from pathlib import Path

import bpy
import corpora
from lift_cases import LiftScene, Place, lift_scene, rig_of
from reachcast.scene.action_writer import curves_of
from reachcast.scene.predict_action import predict_motion

PLACE = Place(0.9, 20, 0.45, facing=True)
WHOLE = ("actions", "objects", "armatures", "meshes", "collections", "scenes", "texts", "materials")


def state() -> str:
    """All that a refusal must leave alone, as text: NaN then equals NaN."""
    bpy.context.view_layer.update()
    scene, layer = bpy.context.scene, bpy.context.view_layer
    parts: list[object] = [scene.frame_current, scene.frame_subframe, sorted(map(str, scene.items()))]
    parts += [sorted(item.name for item in getattr(bpy.data, kind)) for kind in WHOLE]
    parts += [(action.name, action.users, list(map(curve_keys, curves_of(action)))) for action in bpy.data.actions]
    for item in bpy.data.objects:
        parts += [item.name, item.parent and item.parent.name, matrix(item.matrix_basis), matrix(item.matrix_world),
                  item.rotation_mode, animation(item), properties(item), item.select_get(), layer.objects.active]
        for bone in item.pose.bones if item.pose else ():
            parts += [bone.name, bone.rotation_mode, matrix(bone.matrix_basis), matrix(bone.matrix), properties(bone)]
    return repr(parts)


def curve_keys(curve: bpy.types.FCurve) -> tuple[object, ...]:
    return curve.data_path, curve.array_index, [tuple(key.co) for key in curve.keyframe_points]


def matrix(value: object) -> list[tuple[float, ...]]:
    return [tuple(row) for row in value]  # type: ignore[attr-defined]


def animation(item: bpy.types.Object) -> tuple[object, ...] | None:
    data = item.animation_data
    return data and (data.action and data.action.name, len(data.drivers), [track.name for track in data.nla_tracks])


def properties(owner: bpy.types.ID) -> dict[str, str]:
    return {name: repr(value) for name, value in owner.items()}


class Bad(unittest.TestCase):
    def setUp(self) -> None:
        self.corpus = os.fspath(corpora.recorded_corpus())

    def furnish(self) -> LiftScene:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.ops.preferences.addon_enable(module="reachcast")
        scene = lift_scene(rig_of("mannequin", 1.75))
        scene.arrange(PLACE, "waist")
        scene.rig.pose.bones["upper_arm.L"].rotation_quaternion = (0.9, 0.1, 0.3, 0.2)
        scene.box["note"] = "fragile"
        bpy.context.view_layer.update()
        return scene

    def refused(self, *words: str, spoil: Callable[[LiftScene], object] = lambda _: None, name: str = "",
                **options: object) -> None:
        """After `spoil` and with `options` instead of the good input, function and button say these words."""
        with self.subTest(name or ", ".join(words)):
            scene = self.furnish()
            spoil(scene)
            given = {"rig": scene.rig, "shelf": scene.shelf, "home": scene.home, "box": scene.box,
                     "corpus": self.corpus, **options}
            self.refused_by_function(words, given)
            self.refused_by_button(words, given)

    def refused_by_function(self, words: tuple[str, ...], given: dict[str, object]) -> None:
        before = state()
        with self.assertRaises(ValueError) as caught:
            predict_motion(given["rig"], given["shelf"],
                           **{name: value for name, value in given.items() if name not in ("rig", "shelf")})
        self.assert_sentence(str(caught.exception), words)
        self.assertEqual(state(), before, "the function changed the scene")

    def refused_by_button(self, words: tuple[str, ...], given: dict[str, object]) -> None:
        settings = bpy.context.scene.reachcast
        for name, value in given.items():
            if not hasattr(settings, name) or (name == "sex" and value not in ("ANY", "FEMALE", "MALE")) \
                    or (name == "age" and isinstance(value, str)):
                return  # the panel does not offer it
            setattr(settings, name, value)
        before = state()
        with self.assertRaises(RuntimeError) as caught:  # what a report of an error, or a poll, is to a script
            bpy.ops.reachcast.predict_motion()
        said = str(caught.exception).strip().removeprefix("Error: ")
        button = said.removeprefix("Operator bpy.ops.reachcast.predict_motion.poll() ")
        self.assert_sentence(button, words)
        if button == said:  # it ran, so the panel repeats what it reported
            self.assertEqual(bpy.context.window_manager.reachcast_problem, said)
        self.assertEqual(state(), before, "the button changed the scene")

    def assert_sentence(self, text: str, words: tuple[str, ...]) -> None:
        for word in words:
            self.assertIn(word, text)
        for wrong in ("\n", "Traceback", ". ", "std::"):
            self.assertNotIn(wrong, text)


class Rigs(Bad):
    def test_no_rig(self) -> None:
        self.refused("armature", rig=None)

    def test_a_rig_that_is_no_armature(self) -> None:
        scene = self.furnish()
        self.refused_by_function(("armature", "Box"), {"rig": scene.box, "shelf": scene.shelf, "corpus": self.corpus})

    def test_every_unmapped_joint_is_named(self) -> None:
        lost = ("forearm.L", "shin.R", "neck")

        def rename(scene: LiftScene) -> None:
            for bone in lost:
                scene.rig.data.bones[bone].name = f"strange {bone}"
        self.refused("Worker", *lost, spoil=rename)

    def test_a_rig_whose_transform_is_no_number(self) -> None:
        for channel in ("location", "rotation_euler", "scale"):
            self.refused("Worker", "not a number", spoil=setting("rig", channel, (0.0, 1.0, math.nan)), name=channel)

    def test_a_rig_of_no_mirrored_or_uneven_scale(self) -> None:
        self.refused("Worker", "scale", spoil=setting("rig", "scale", (0.0, 0.0, 0.0)), name="zero")
        self.refused("Worker", "scale", spoil=setting("rig", "scale", (1.0, 0.0, 1.0)), name="flat")
        self.refused("Worker", "scale", spoil=setting("rig", "scale", (-1.0, 1.0, 1.0)), name="mirrored")
        self.refused("Worker", "scale", spoil=setting("rig", "scale", (-1.0, -1.0, -1.0)), name="mirrored thrice")
        self.refused("Worker", "unevenly", spoil=setting("rig", "scale", (1.0, 1.0, 1.2)), name="uneven")


class Places(Bad):
    def test_no_shelf(self) -> None:
        self.refused("Empty", shelf=None)

    def test_a_shelf_out_of_reach_says_by_how_much_from_which_joint(self) -> None:
        for place in ((0.0, -1.6, 1.2), (0.0, -0.4, 2.6), (1.5, 0.0, 1.0)):
            self.refused("cm out of reach from the", "target", name=f"shelf at {place}",
                         spoil=setting("shelf", "location", place))

    def test_a_home_out_of_reach(self) -> None:
        self.refused("cm out of reach from the", "home", spoil=setting("home", "location", (0.0, -2.8, 0.5)))

    def test_a_shelf_where_the_box_already_is(self) -> None:
        self.refused("apart", spoil=lambda scene: setattr(scene.shelf, "matrix_world", scene.home.matrix_world))

    def test_transforms_that_are_no_numbers(self) -> None:
        for which, name in (("shelf", "Shelf"), ("home", "Home"), ("box", "Box")):
            self.refused(name, "not a number", spoil=setting(which, "location", (math.nan, 0.0, 0.0)),
                         name=f"{which} at nan")
            self.refused(name, "not a number", spoil=setting(which, "rotation_euler", (0.0, math.nan, 0.0)),
                         name=f"{which} turned by nan")
            self.refused(name, "not a number", spoil=setting(which, "scale", (1.0, math.nan, 1.0)),
                         name=f"{which} scaled by nan")

    def test_scales_of_zero_and_below(self) -> None:
        for which, name in (("shelf", "Shelf"), ("home", "Home"), ("box", "Box")):
            self.refused(name, "above zero", spoil=setting(which, "scale", (1.0, 0.0, 1.0)), name=f"{which} flat")
            self.refused(name, "above zero", spoil=setting(which, "scale", (1.0, 1.0, -1.0)), name=f"{which} mirrored")

    def test_numbers_about_the_person(self) -> None:
        self.refused("stature", stature=math.nan, name="stature nan")
        self.refused("stature", "3.1", stature=3.1, sex=None, name="stature 3.1")
        self.refused("mass", mass=-3.0)
        self.refused("age", age=math.nan)
        self.refused("sex", sex="neither", age=None)
        self.refused("k is 0", k=0)
        self.refused("age must be a number", "'old'", age="old")
        self.refused("wrong kind", "k='many'", k="many")
        self.refused("unknown option 'wings'", wings=2)
        self.refused("phase", "'fly'", phases=["fly"])


def setting(which: str, name: str, value: object) -> Callable[[LiftScene], None]:
    def change(scene: LiftScene) -> None:
        setattr(getattr(scene, which), name, value)
        bpy.context.view_layer.update()
    return change


class Corpora(Bad):
    def file(self, name: str, contents: bytes = b"") -> str:
        path = corpora.folder() / name
        path.write_bytes(contents)
        self.addCleanup(path.unlink, missing_ok=True)
        return os.fspath(path)

    def test_a_file_that_is_not_there(self) -> None:
        self.refused("lost.sqlite", "orpus", corpus=os.fspath(corpora.folder() / "lost.sqlite"))

    def test_a_folder(self) -> None:
        self.refused(corpora.folder().name, "orpus", corpus=os.fspath(corpora.folder()))

    def test_an_empty_file(self) -> None:
        self.refused("nothing.sqlite", corpus=self.file("nothing.sqlite"))

    def test_a_corpus_without_motions(self) -> None:
        self.refused("empty.sqlite", "no motions", corpus=os.fspath(corpora.empty_corpus()))

    def test_a_file_that_is_not_sqlite(self) -> None:
        self.refused("letter.sqlite", corpus=self.file("letter.sqlite", b"Dear reader, this is no database.\n" * 200))

    def test_a_database_of_something_else(self) -> None:
        path = self.file("other.sqlite")
        with sqlite3.connect(path) as database:
            database.execute("CREATE TABLE birds (name TEXT)")
        database.close()
        self.refused("other.sqlite", corpus=path)

    def test_a_newer_schema(self) -> None:
        path = self.file("newer.sqlite")
        shutil.copyfile(self.corpus, path)
        with sqlite3.connect(path) as database:
            database.execute("PRAGMA user_version = 99")
        database.close()
        self.refused("newer.sqlite", "99", corpus=path)

    def test_a_file_that_was_cut_off(self) -> None:
        whole = Path(self.corpus).read_bytes()
        for share in (0.02, 0.3, 0.9):
            cut = self.file("cut.sqlite", whole[:int(share * len(whole))])
            self.refused("cut.sqlite", corpus=cut, name=f"{share:.0%} of the file")
        self.refused("cut.sqlite", "damaged", corpus=self.file("cut.sqlite", whole[:20_000]), name="20,000 bytes")

    def test_a_corpus_that_has_lost_its_motions_contents(self) -> None:
        path = self.file("hollow.sqlite")
        shutil.copyfile(self.corpus, path)
        with sqlite3.connect(path) as database:
            database.execute("DELETE FROM codes")
        database.close()
        self.refused("hollow.sqlite", "damaged", "coefficients", corpus=path)


class Undo(Bad):
    def test_undo_brings_back_the_pose_and_leaves_no_action(self) -> None:
        scene, settings = self.furnish(), bpy.context.scene.reachcast
        settings.rig, settings.shelf, settings.home, settings.box = scene.rig, scene.shelf, scene.home, scene.box
        settings.corpus = self.corpus
        bpy.ops.ed.undo_push(message="before")
        before = state()
        self.assertEqual(bpy.ops.reachcast.predict_motion(), {"FINISHED"})
        self.assertEqual(len(bpy.data.actions), 2)
        self.assertNotEqual(state(), before)
        bpy.ops.ed.undo_push(message="after")
        bpy.ops.ed.undo()
        self.assertEqual(len(bpy.data.actions), 0)
        bpy.context.view_layer.update()
        rig = bpy.data.objects["Worker"]
        for got, wanted in zip(rig.pose.bones["upper_arm.L"].rotation_quaternion, (0.9, 0.1, 0.3, 0.2)):
            self.assertAlmostEqual(got, wanted, places=6)
        for name in ("Worker", "Box", "Shelf", "Home"):
            data = bpy.data.objects[name].animation_data
            self.assertTrue(data is None or data.action is None, name)

    def test_undo_after_a_second_prediction_leaves_the_first(self) -> None:
        scene, settings = self.furnish(), bpy.context.scene.reachcast
        settings.rig, settings.shelf, settings.corpus = scene.rig, scene.shelf, self.corpus
        bpy.ops.reachcast.predict_motion()
        first = bpy.data.objects["Worker"].animation_data.action.name
        bpy.ops.ed.undo_push(message="first")
        bpy.ops.reachcast.predict_motion()
        bpy.ops.ed.undo_push(message="second")
        bpy.ops.ed.undo()
        self.assertEqual([action.name for action in bpy.data.actions], [first])
        self.assertEqual(bpy.data.objects["Worker"].animation_data.action.name, first)
