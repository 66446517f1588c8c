# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import bpy

from .. import preferences


class REACHCAST_OT_choose_corpus(bpy.types.Operator):
    bl_idname = "reachcast.choose_corpus"
    bl_label = "Choose Corpus"
    bl_description = "Learn from this file"
    bl_options = {"REGISTER", "UNDO"}

    path: bpy.props.StringProperty(name="Corpus", description="The file; empty takes the one that ships",
                                   options={"SKIP_SAVE"})

    def execute(self, context: bpy.types.Context) -> set[str]:
        context.scene.reachcast.corpus = self.path
        return {"FINISHED"}


class _OfPreferences:
    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
        if preferences.of_addon() is None:
            cls.poll_message_set("Enable the add-on in the preferences first: a script enabled it for this session only.")
            return False
        return True


class REACHCAST_OT_add_corpus_folder(_OfPreferences, bpy.types.Operator):
    bl_idname = "reachcast.add_corpus_folder"
    bl_label = "Add Folder"
    bl_description = "Choose a folder whose corpora are offered in the panel"

    directory: bpy.props.StringProperty(name="Folder", subtype="DIR_PATH", description="Where the corpora are")

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        preferences.of_addon().corpus_folders.add().folder = self.directory
        context.preferences.is_dirty = True
        return {"FINISHED"}


class REACHCAST_OT_remove_corpus_folder(_OfPreferences, bpy.types.Operator):
    bl_idname = "reachcast.remove_corpus_folder"
    bl_label = "Remove Folder"
    bl_description = "Search this folder no longer; its files stay"

    index: bpy.props.IntProperty(name="Number", min=0, description="Place in the list, from 0")

    def execute(self, context: bpy.types.Context) -> set[str]:
        folders = preferences.of_addon().corpus_folders
        if self.index >= len(folders):
            self.report({"ERROR"}, f"There is no folder {self.index}; there are {len(folders)}")
            return {"CANCELLED"}
        folders.remove(self.index)
        context.preferences.is_dirty = True
        return {"FINISHED"}


CLASSES = (REACHCAST_OT_choose_corpus, REACHCAST_OT_add_corpus_folder, REACHCAST_OT_remove_corpus_folder)
