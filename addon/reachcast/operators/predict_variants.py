# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import bpy

from ..properties import missing
from ..scene.variants import predict_variants
from .predict_motion import problem_of, task_of


class REACHCAST_OT_predict_variants(bpy.types.Operator):
    bl_idname = "reachcast.predict_variants"
    bl_label = "Predict Variants"
    bl_description = "Write several motions of the same task, as people vary, each drawn from its seed"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        reason = missing(context.scene.reachcast)
        if reason:
            cls.poll_message_set(reason)
        return reason is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        settings = context.scene.reachcast
        try:
            found = predict_variants(**task_of(context), count=settings.variants, seed=settings.seed,
                                     amount=settings.variation, ghosts=settings.variants_as == "GHOSTS",
                                     spacing=settings.spacing, tube=settings.spread)
        except (ValueError, RuntimeError) as error:
            return problem_of(self, context, error)
        context.window_manager.reachcast_problem = ""
        if found.failed:
            seeds = ", ".join(str(seed) for seed, _ in found.failed)
            self.report({"WARNING"}, f"{len(found.results)} variants; not with seed {seeds}: {found.failed[0][1]}")
        else:
            self.report({"INFO"}, f"{len(found.results)} variants, seeds {found.seeds[0]} to {found.seeds[-1]}")
        return {"FINISHED"}
