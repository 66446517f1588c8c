# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import bpy

from .. import native
from ..preferences import SEXES, preferred
from ..subject_settings import core_sex
from ..scene.mannequin import build_mannequin, standing_posture


class REACHCAST_OT_add_mannequin(bpy.types.Operator):
    bl_idname = "reachcast.add_mannequin"
    bl_label = "Reachcast Mannequin"
    bl_description = "Add a jointed figure of a given stature at the 3D cursor"
    bl_options = {"REGISTER", "UNDO"}

    stature: bpy.props.FloatProperty(
        name="Stature", description="Height from the floor to the top of the head", default=1.75, min=1.2, max=2.2,
        subtype="DISTANCE", unit="LENGTH")
    sex: bpy.props.EnumProperty(
        name="Sex", description="Whose proportions the figure has", default="ANY",
        items=(("ANY", "Any", "In between"), *SEXES[1:]))

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        reason = native.reason()
        if reason:
            cls.poll_message_set(reason)
            return False
        if context.mode != "OBJECT":
            cls.poll_message_set("Leave to Object Mode first.")
            return False
        return True

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        if not self.properties.is_property_set("stature") and preferred("stature"):
            self.stature = min(max(preferred("stature"), 1.2), 2.2)
        if not self.properties.is_property_set("sex"):
            self.sex = preferred("sex")
        return self.execute(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        sex = core_sex(self.sex)
        try:
            joints = standing_posture(self.stature, sex)
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        rig = build_mannequin(context.collection, joints, sex, name="Worker", stature=self.stature)
        rig.location = context.scene.cursor.location
        if context.scene.reachcast.rig is None:
            context.scene.reachcast.rig = rig
        return {"FINISHED"}


def draw_menu_entry(menu: bpy.types.Menu, _context: bpy.types.Context) -> None:
    menu.layout.operator(REACHCAST_OT_add_mannequin.bl_idname, icon="ARMATURE_DATA")
