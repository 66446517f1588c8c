# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import bpy

from ..people import Person
from ..properties import missing
from ..scene.family import FamilyResult, family_steps
from ..scene.steps import Steps
from ..subject_settings import core_sex
from .predict_motion import task_of
from .stepwise import Stepwise


class REACHCAST_OT_predict_family(Stepwise, bpy.types.Operator):
    bl_idname = "reachcast.predict_family"
    bl_label = "Predict Family"
    bl_description = ("Do the same task with mannequins of the 5th, 50th and 95th percentile woman and man, side by "
                      "side to the rig's right")
    bl_options = {"REGISTER", "UNDO"}

    spacing: bpy.props.FloatProperty(name="Spacing", description="From one person to the next", default=1.2, min=0.0,
                                     max=100.0, subtype="DISTANCE", unit="LENGTH")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        reason = missing(context.scene.reachcast)
        if reason:
            cls.poll_message_set(reason)
        return reason is None

    def steps(self, context: bpy.types.Context) -> Steps[FamilyResult]:
        return family_steps(**task_of(context), spacing=self.spacing)

    def finish(self, context: bpy.types.Context, found: FamilyResult) -> str:
        if found.failed:
            person, reason = found.failed[0]
            return f"{len(found.results)} can do it, {len(found.failed)} cannot; the {person}: {reason}"
        return f"{len(found.results)} can do it; see collection '{found.collection}'"


class REACHCAST_OT_choose_percentile(bpy.types.Operator):
    bl_idname = "reachcast.choose_percentile"
    bl_label = "Percentile"
    bl_description = "Take the stature of this percentile (US Army survey of 1988)"
    bl_options = {"REGISTER", "UNDO"}

    percentile: bpy.props.FloatProperty(
        name="Percentile", default=50.0, min=0.1, max=99.9,
        description="Of a hundred people of the chosen sex, how many are shorter")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if core_sex(context.scene.reachcast.sex) is None:
            cls.poll_message_set("Choose female or male first: percentiles differ.")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        settings = context.scene.reachcast
        settings.stature = Person(core_sex(settings.sex), self.percentile).stature
        return {"FINISHED"}
