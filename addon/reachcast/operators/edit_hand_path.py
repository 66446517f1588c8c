# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import bpy

from .. import path_editing
from ..properties import missing
from ..scene.path_session import begin_session
from .predict_motion import problem_of, task_of


class REACHCAST_OT_edit_hand_path(bpy.types.Operator):
    bl_idname = "reachcast.edit_hand_path"
    bl_label = "Edit Hand Path"
    bl_description = ("Predict, and show the path of the hands as a Bezier curve. Move its handles in Edit Mode, or its "
                      "ends, and the whole body follows")
    bl_options = {"REGISTER", "UNDO"}

    all_phases: bpy.props.BoolProperty(
        name="Empty Hands Too", default=False, options={"SKIP_SAVE"},
        description="Also show the paths of the phases in which the hands are empty")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        reason = missing(context.scene.reachcast)
        if reason:
            cls.poll_message_set(reason)
        return reason is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        path_editing.stop()
        task = task_of(context)
        try:
            session = begin_session(task.pop("rig"), task.pop("shelf"), **task,
                                    edited=range(len(task["phases"])) if self.all_phases else None)
        except (ValueError, RuntimeError) as error:
            return problem_of(self, context, error)
        context.window_manager.reachcast_problem = ""
        path_editing.start(session)
        curves = [bpy.data.objects[name] for name in session.curves.values()]
        for item in context.selected_objects:
            item.select_set(False)
        for curve in curves:
            curve.select_set(True)
        context.view_layer.objects.active = curves[0]
        self.report({"INFO"}, f"'{curves[0].name}': press Tab and move its handles; '{session.result.action}' follows")
        return {"FINISHED"}


class REACHCAST_OT_follow_targets(bpy.types.Operator):
    bl_idname = "reachcast.follow_targets"
    bl_label = "Live"
    bl_description = "Predict, and again whenever the Empty on the shelf or at home moves, while the mouse moves it"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return REACHCAST_OT_edit_hand_path.poll.__func__(cls, context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        path_editing.stop()
        task = task_of(context)
        try:
            session = begin_session(task.pop("rig"), task.pop("shelf"), **task, live=True)
        except (ValueError, RuntimeError) as error:
            return problem_of(self, context, error)
        context.window_manager.reachcast_problem = ""
        path_editing.start(session)
        self.report({"INFO"}, f"'{session.result.action}' follows '{session.shelf}' while it is moved")
        return {"FINISHED"}


class REACHCAST_OT_finish_hand_path(bpy.types.Operator):
    bl_idname = "reachcast.finish_hand_path"
    bl_label = "Done"
    bl_description = "Stop following: curves go, the Action stays as it is and can be edited again"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if path_editing.active() is None:
            cls.poll_message_set("Nothing is being edited or followed.")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        if context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        path_editing.stop()
        context.window_manager.reachcast_problem = ""
        return {"FINISHED"}
