# SPDX-License-Identifier: GPL-3.0-or-later
"""What the add-on adds to Blender, in one order, and takes away in the reverse."""
from __future__ import annotations

import bpy

from . import (corpora, corpus_settings, left_out, panels, panels_corpus, panels_rig, path_editing, preferences,
               properties)
from .operators import (add_mannequin, bone_maps, corpus_choice, corpus_motions, edit_hand_path, import_motions,
                        pose_ghosts, predict_family, predict_motion, predict_targets, predict_variants)
from .scene import map_editing, target_cloud

CLASSES: tuple[type, ...] = (
    preferences.CorpusFolder,
    preferences.ReachcastPreferences,
    map_editing.SegmentBone,
    properties.ReachcastSettings,
    corpus_settings.ListedMotion,
    corpus_settings.MotionListing,
    *bone_maps.CLASSES,
    predict_motion.REACHCAST_OT_predict_motion,
    predict_variants.REACHCAST_OT_predict_variants,
    predict_targets.REACHCAST_OT_predict_targets,
    predict_family.REACHCAST_OT_predict_family,
    predict_family.REACHCAST_OT_choose_percentile,
    pose_ghosts.REACHCAST_OT_pose_ghosts,
    edit_hand_path.REACHCAST_OT_edit_hand_path,
    edit_hand_path.REACHCAST_OT_follow_targets,
    edit_hand_path.REACHCAST_OT_finish_hand_path,
    add_mannequin.REACHCAST_OT_add_mannequin,
    corpus_motions.REACHCAST_OT_list_motions,
    corpus_motions.REACHCAST_OT_play_motion,
    corpus_motions.REACHCAST_OT_forget_motion,
    import_motions.REACHCAST_OT_import_motions,
    import_motions.REACHCAST_OT_capture_motion,
    *corpus_choice.CLASSES,
    panels_corpus.REACHCAST_UL_motions,
    panels.REACHCAST_MT_corpora,
    panels.REACHCAST_PT_lift,
    panels.REACHCAST_PT_subject,
    panels_rig.REACHCAST_PT_control_rig,
    panels_rig.REACHCAST_PT_bone_map,
    panels.REACHCAST_PT_output,
    panels.REACHCAST_PT_hand_path,
    panels.REACHCAST_PT_variants,
    panels.REACHCAST_PT_others,
    panels_corpus.REACHCAST_PT_corpus,
    panels.REACHCAST_PT_result,
)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Scene.reachcast = bpy.props.PointerProperty(type=properties.ReachcastSettings)
    bpy.types.WindowManager.reachcast_problem = properties.PROBLEM
    bpy.types.WindowManager.reachcast_motions = bpy.props.PointerProperty(type=corpus_settings.MotionListing)
    bpy.types.Object.reachcast_hands, bpy.types.Object.reachcast_feet = properties.HANDS, properties.FEET
    bpy.types.Object.reachcast_box_mass = properties.MASS
    bpy.types.Object.reachcast_bones = bpy.props.CollectionProperty(type=map_editing.SegmentBone)
    bpy.types.Object.reachcast_map = bpy.props.StringProperty(name="Bone Map", options={"HIDDEN"})
    bpy.types.VIEW3D_MT_armature_add.append(add_mannequin.draw_menu_entry)


def unregister() -> None:
    path_editing.forget()
    left_out.forget()
    target_cloud.show(False)
    bpy.types.VIEW3D_MT_armature_add.remove(add_mannequin.draw_menu_entry)
    del bpy.types.Object.reachcast_map, bpy.types.Object.reachcast_bones
    del bpy.types.Object.reachcast_hands, bpy.types.Object.reachcast_feet, bpy.types.Object.reachcast_box_mass
    del bpy.types.WindowManager.reachcast_motions, bpy.types.WindowManager.reachcast_problem
    del bpy.types.Scene.reachcast
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
    corpora.close_all()
