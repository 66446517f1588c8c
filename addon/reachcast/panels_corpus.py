# SPDX-License-Identifier: GPL-3.0-or-later
"""What is inside the corpus: a list of motions, and what can be done with one."""
from __future__ import annotations

import bpy

from .corpus_settings import MOST_LISTED
from .operators.corpus_motions import (REACHCAST_OT_forget_motion, REACHCAST_OT_list_motions, REACHCAST_OT_play_motion)
from .operators.import_motions import REACHCAST_OT_capture_motion, REACHCAST_OT_import_motions
from .panels import Tab, lines


class REACHCAST_UL_motions(bpy.types.UIList):
    def draw_item(self, _context: bpy.types.Context, layout: bpy.types.UILayout, _data: object,
                  item: bpy.types.PropertyGroup, _icon: int, _active_data: object, _active: str) -> None:
        split = layout.split(factor=0.42)
        split.label(text=item.phase)
        split = split.split(factor=0.54)
        split.label(text=item.place)
        split.label(text=item.duration)


class REACHCAST_PT_corpus(Tab, bpy.types.Panel):
    bl_label = "Corpus"
    bl_description = "What was learned from: import recordings, list them, play one, see where they reach"
    bl_parent_id = "REACHCAST_PT_lift"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        listing = context.window_manager.reachcast_motions
        column = self.layout.column(align=True)
        column.operator(REACHCAST_OT_import_motions.bl_idname, icon="IMPORT")
        column.operator(REACHCAST_OT_capture_motion.bl_idname, icon="REC")
        row = self.layout.row(align=True)
        row.prop(listing, "phase", text="")
        row.operator(REACHCAST_OT_list_motions.bl_idname, icon="FILE_REFRESH")
        if listing.rows:
            self.layout.template_list("REACHCAST_UL_motions", "", listing, "rows", listing, "active", rows=6)
            if listing.total > MOST_LISTED:
                self.layout.label(text=f"The first {MOST_LISTED} of {listing.total}.")
            if 0 <= listing.active < len(listing.rows):
                lines(self.layout, context, listing.rows[listing.active].words, "INFO")
            row = self.layout.row(align=True)
            row.operator(REACHCAST_OT_play_motion.bl_idname, text="Play", icon="PLAY")
            row.operator(REACHCAST_OT_forget_motion.bl_idname, text="Forget", icon="TRASH")
        self.layout.prop(listing, "show_targets")
