# SPDX-License-Identifier: GPL-3.0-or-later
"""Buttons around a rig's bone map. Each calls one plain function of scene/map_editing.py."""
from __future__ import annotations

import os

import bpy

from ..scene.map_editing import (export_map, forget_map, import_map, lacking, preset_folder, save_preset,
                                  start_editing)
from ..scene.read_rig import recognise


class _OnRig:
    bl_options = {"REGISTER", "UNDO"}
    needs_map = True
    needs_all = False

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        rig = context.scene.reachcast.rig
        reason = None
        if rig is None:
            reason = "Choose the armature that carries the box."
        elif rig.mode == "EDIT":
            reason = f"Leave Edit Mode on '{rig.name}' first."
        elif cls.needs_map and not rig.reachcast_bones:
            reason = "Press Edit Bone Map first."
        elif cls.needs_all and (gaps := lacking(rig)):
            reason = f"Choose bones for {', '.join(gaps)} first."
        if reason:
            cls.poll_message_set(reason)
        return reason is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            self.act(context.scene.reachcast.rig)
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class _WithFile(_OnRig):
    filepath: bpy.props.StringProperty(name="File", subtype="FILE_PATH", description="The JSON file of the bone map")
    filter_glob: bpy.props.StringProperty(default="*.json", options={"HIDDEN"})

    def folder(self) -> str:
        """Where the file browser opens."""
        return os.path.dirname(bpy.data.filepath)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        if not self.filepath:
            self.filepath = os.path.join(self.folder(), "bone_map.json")
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}


class REACHCAST_OT_edit_bone_map(_OnRig, bpy.types.Operator):
    bl_idname = "reachcast.edit_bone_map"
    bl_label = "Edit Bone Map"
    bl_description = "Choose by hand which bone is which part of the body, beginning with what is recognised"
    needs_map = False

    def act(self, rig: bpy.types.Object) -> None:
        try:
            recognised = recognise(rig)
        except ValueError:  # then the closest preset shows what is missing
            recognised = None
        start_editing(rig, recognised)


class REACHCAST_OT_forget_bone_map(_OnRig, bpy.types.Operator):
    bl_idname = "reachcast.forget_bone_map"
    bl_label = "Recognise Again"
    bl_description = "Drop the edited bone map; the bones are recognised by their names or the skeleton's shape"

    def act(self, rig: bpy.types.Object) -> None:
        forget_map(rig)


class REACHCAST_OT_save_bone_map(_OnRig, bpy.types.Operator):
    bl_idname = "reachcast.save_bone_map"
    bl_label = "Save as Preset"
    bl_description = "Keep this bone map for all rigs with these bones, in Blender's folder for the user's presets"
    needs_all = True
    preset: bpy.props.StringProperty(name="Name", default="My rig",
                                     description="What the preset and its file are called")

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        return context.window_manager.invoke_props_dialog(self)

    def act(self, rig: bpy.types.Object) -> None:
        self.report({"INFO"}, f"Saved as {save_preset(rig, self.preset)}")


class REACHCAST_OT_import_bone_map(_WithFile, bpy.types.Operator):
    bl_idname = "reachcast.import_bone_map"
    bl_label = "Load"
    bl_description = "Read a bone map from a JSON file: a preset that you saved, or any other"
    needs_map = False

    def folder(self) -> str:
        return os.fspath(preset_folder() or super().folder())

    def act(self, rig: bpy.types.Object) -> None:
        import_map(rig, bpy.path.abspath(self.filepath))


class REACHCAST_OT_export_bone_map(_WithFile, bpy.types.Operator):
    bl_idname = "reachcast.export_bone_map"
    bl_label = "Export"
    bl_description = "Write this bone map to a JSON file"
    needs_all = True

    def act(self, rig: bpy.types.Object) -> None:
        export_map(rig, bpy.path.abspath(self.filepath))


CLASSES = (REACHCAST_OT_edit_bone_map, REACHCAST_OT_forget_bone_map, REACHCAST_OT_save_bone_map,
           REACHCAST_OT_import_bone_map, REACHCAST_OT_export_bone_map)
