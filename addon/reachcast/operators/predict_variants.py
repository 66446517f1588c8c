# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import bpy

from ..properties import missing
from ..scene.steps import Steps
from ..scene.variants import VariantsResult, variant_steps
from .predict_motion import publish, task_of
from .stepwise import Stepwise


class REACHCAST_OT_predict_variants(Stepwise, bpy.types.Operator):
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

    def steps(self, context: bpy.types.Context) -> Steps[VariantsResult]:
        settings = context.scene.reachcast
        return variant_steps(**task_of(context), count=settings.variants, seed=settings.seed, amount=settings.variation,
                             ghosts=settings.variants_as == "GHOSTS", spacing=settings.spacing, tube=settings.spread)

    def finish(self, context: bpy.types.Context, found: VariantsResult) -> str:
        if found.collection is None:
            publish(self, context, found.results)
        if found.failed:
            seeds = ", ".join(str(seed) for seed, _ in found.failed)
            return f"{len(found.results)} variants; not with seed {seeds}: {found.failed[0][1]}"
        return f"{len(found.results)} variants, seeds {found.seeds[0]} to {found.seeds[-1]}"
