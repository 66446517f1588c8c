# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import bpy

from ..properties import ERRANDS, missing
from ..scene.nla_strips import put_on_strips
from ..scene.predict_action import PredictionResult, predict_motion
from ..scene.publish import add_markers, mark_assets
from ..subject_settings import core_sex


class REACHCAST_OT_predict_motion(bpy.types.Operator):
    bl_idname = "reachcast.predict_motion"
    bl_label = "Predict Motion"
    bl_description = "Write a new Action on the rig, from the current frame, in which it carries the box to the shelf"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        reason = missing(context.scene.reachcast)
        if reason:
            cls.poll_message_set(reason)
        return reason is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            result = predict_motion(**task_of(context))
        except (ValueError, RuntimeError) as error:  # a mistake of the user's; a file that cannot be used
            return problem_of(self, context, error)
        context.window_manager.reachcast_problem = ""
        self.report({"INFO"}, summary(result))
        publish(self, context, [result])
        return {"FINISHED"}


def publish(operator: bpy.types.Operator, context: bpy.types.Context, results: Sequence[PredictionResult]) -> None:
    """What *Output* asks for beside the Actions on the panel's rig and box; markers are of the first, which plays."""
    settings = context.scene.reachcast
    if settings.markers:
        add_markers(results[0], context.scene)
    if settings.assets:
        for result in results:
            mark_assets(result)
    if settings.strips:
        try:
            put_on_strips(results, settings.rig, settings.box)
        except ValueError as error:
            operator.report({"WARNING"}, str(error))


def problem_of(operator: bpy.types.Operator, context: bpy.types.Context, error: Exception) -> set[str]:
    """Says what went wrong, in the panel and the status bar."""
    context.window_manager.reachcast_problem = str(error)
    operator.report({"ERROR"}, str(error))
    return {"CANCELLED"}


def task_of(context: bpy.types.Context) -> dict[str, Any]:
    """What the panel says, as arguments of `predict_motion`."""
    settings = context.scene.reachcast
    task = {"rig": settings.rig, "shelf": settings.shelf, "corpus": settings.corpus, "home": settings.home,
            "box": settings.box, "stature": settings.stature or None, "sex": core_sex(settings.sex),
            "age": settings.age or None, "mass": settings.mass or None,
            "bone_map": settings.bone_map or None, "phases": ERRANDS[settings.errand],
            "obstacles": meshes_in(settings.obstacles), "scene": context.scene}
    if settings.working_hands != "BOTH":
        task["hands"] = settings.working_hands.lower()
    elif settings.handle_left and settings.handle_right:
        task["handles"] = (settings.handle_left, settings.handle_right)
    if settings.approach != "FREE":
        task["approach"] = settings.approach.lower()
    return task


def meshes_in(collection: bpy.types.Collection | None) -> list[bpy.types.Object]:
    return [item for item in collection.all_objects if item.type == "MESH"] if collection else []


def summary(result: PredictionResult) -> str:
    where = f"{'outside' if result.outside_data else 'within'} the {result.corpus_kind} data"
    landing = f", lands within {result.errors['landing'] * 1000:.2f} mm" if "landing" in result.errors else ""
    return (f"'{result.action}': frames {result.first_frame} to {result.frames['end']}{landing}, from "
            f"{len(result.neighbours)} motions, {where}")
