# SPDX-License-Identifier: GPL-3.0-or-later
"""What the sidebar shows of the chosen rig: its bone map, and how a control rig's limbs are keyed."""
from __future__ import annotations

import bpy

from .operators import bone_maps
from .panels import Tab
from .rigs.bone_map import OPTIONAL, PARENTS
from .rigs.rig_presets import closest, detect
from .scene.map_editing import lacking
from .scene.read_rig import recognise


def has_controls(rig: bpy.types.Object | None) -> bool:
    """Whether a motion would be written on the controls of a generated Rigify rig."""
    if rig is None or rig.type != "ARMATURE":
        return False
    try:
        return bool(detect([bone.name for bone in rig.data.bones], rig.name).controls)
    except ValueError:  # the panel above says what the rig lacks
        return False


class REACHCAST_PT_control_rig(Tab, bpy.types.Panel):
    bl_label = "Control Rig"
    bl_description = "How a motion is written on this generated rig's limbs, so that it stays editable"
    bl_parent_id = "REACHCAST_PT_lift"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return has_controls(context.scene.reachcast.rig)

    def draw(self, context: bpy.types.Context) -> None:
        rig = context.scene.reachcast.rig
        for words, name in (("Hands", "reachcast_hands"), ("Feet", "reachcast_feet")):
            split = self.layout.split(factor=0.3)
            split.label(text=words)
            split.row().prop(rig, name, expand=True)


class REACHCAST_PT_bone_map(Tab, bpy.types.Panel):
    bl_label = "Bone Map"
    bl_description = "Which bone is which part of the body, and what is missing"
    bl_parent_id = "REACHCAST_PT_lift"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.scene.reachcast.rig is not None

    def draw(self, context: bpy.types.Context) -> None:
        rig, layout = context.scene.reachcast.rig, self.layout
        gaps = set(lacking(rig))
        column = layout.column(align=True)
        if rig.reachcast_bones:
            for row in rig.reachcast_bones:
                _row(column, row.name, row.name in gaps).prop_search(row, "bone", rig.data, "bones", text="")
            layout.operator(bone_maps.REACHCAST_OT_forget_bone_map.bl_idname, icon="LOOP_BACK")
        else:
            self.draw_recognised(column, rig)
            layout.operator(bone_maps.REACHCAST_OT_edit_bone_map.bl_idname, icon="GREASEPENCIL")
        column = layout.column(align=True)
        column.operator(bone_maps.REACHCAST_OT_save_bone_map.bl_idname)
        row = column.row(align=True)
        for operator in (bone_maps.REACHCAST_OT_import_bone_map, bone_maps.REACHCAST_OT_export_bone_map):
            row.operator(operator.bl_idname)

    def draw_recognised(self, column: bpy.types.UILayout, rig: bpy.types.Object) -> None:
        names = {bone.name for bone in rig.data.bones}
        try:
            found = recognise(rig)
        except ValueError:
            found = closest(names)
        column.label(text=found.name)
        for segment in PARENTS:
            bone = found.segments.get(segment, "")
            is_there = bone in names
            _row(column, segment, not is_there and segment not in OPTIONAL).label(text=bone if is_there else "none")


def _row(column: bpy.types.UILayout, segment: str, is_missing: bool) -> bpy.types.UILayout:
    split = column.split(factor=0.45)
    split.label(text=segment, icon="ERROR" if is_missing else "NONE")
    return split
