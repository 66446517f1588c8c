# SPDX-License-Identifier: GPL-3.0-or-later
"""What the sidebar shows of the chosen rig: how a control rig's limbs are keyed."""
from __future__ import annotations

import bpy

from .rigs.rig_presets import detect


def has_controls(rig: bpy.types.Object | None) -> bool:
    """Whether a motion would be written on the controls of a generated Rigify rig."""
    if rig is None or rig.type != "ARMATURE":
        return False
    try:
        return bool(detect([bone.name for bone in rig.data.bones], rig.name).controls)
    except ValueError:  # the panel above says what the rig lacks
        return False


class REACHCAST_PT_control_rig(bpy.types.Panel):
    bl_label = "Control Rig"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Reachcast"
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
