# SPDX-License-Identifier: GPL-3.0-or-later
"""Long work step by step: whoever stops keeps what is finished, and to the end it is what is done at once."""
from __future__ import annotations

import bpy
from mathutils import Matrix
from reachcast.scene.family import family_steps
from reachcast.scene.several_targets import target_steps
from reachcast.scene.steps import Progress, run_to_end
from reachcast.scene.variants import variant_steps
from scene_cases import Scene


class Stopped(Scene):
    def setUp(self) -> None:
        super().setUp()
        self.furnish()
        self.task = {"corpus": self.corpus, "home": self.home, "box": self.box, "start_frame": 1}
        self.shelves = [self.shelf, *(self.empty(f"Shelf {number}", Matrix(), (0.05 * number, *self.shelf.location.yz))
                                      for number in (1, 2))]

    def works(self) -> dict[str, object]:
        return {"family": family_steps(self.rig, self.shelf, **self.task),
                "targets": target_steps(self.rig, self.shelves, **self.task),
                "variants": variant_steps(self.rig, self.shelf, count=4, **self.task),
                "ghosts": variant_steps(self.rig, self.shelf, count=4, ghosts=True, **self.task)}

    def stop_after(self, steps, count: int):  # type: ignore[no-untyped-def]
        """The result when the work is stopped after so many steps."""
        total = next(steps).total
        for done in range(1, count + 1):
            self.assertEqual(steps.send(False), Progress(done, total))
        with self.assertRaises(StopIteration) as end:
            steps.send(True)
        return end.exception.value

    def test_what_is_finished_stays(self) -> None:
        for name, steps in self.works().items():
            with self.subTest(work=name):
                found = self.stop_after(steps, 2)
                self.assertEqual((len(found.results), len(found.failed)), (2, 0))
        self.assertFalse([item.name for item in bpy.data.objects if item.name.startswith("Spread")])

    def test_the_first_of_the_finished_targets_is_active(self) -> None:
        found = self.stop_after(self.works()["targets"], 2)
        self.assertEqual(self.rig.animation_data.action.name, found.results[0].action)
        self.assertTrue(all(bpy.data.actions[result.action].use_fake_user for result in found.results))

    def test_stopped_before_anything_is_finished_nothing_is_left(self) -> None:
        before = self.everything()
        for name, steps in self.works().items():
            with self.subTest(work=name):
                next(steps)
                with self.assertRaisesRegex(ValueError, "before"):
                    steps.send(True)
                self.assertEqual(self.everything(), before)
                self.assertFalse(bpy.data.collections)

    def test_to_the_end_all_is_done(self) -> None:
        self.assertEqual([len(run_to_end(steps).results) for steps in self.works().values()], [6, 3, 4, 4])

    def test_all_variants_are_saved_with_the_file(self) -> None:
        found = run_to_end(variant_steps(self.rig, self.shelf, count=3, **self.task))
        for result in found.results:
            for name in (result.action, result.box_action):
                self.assertTrue(bpy.data.actions[name].use_fake_user, name)
