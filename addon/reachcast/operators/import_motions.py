# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bpy
from bpy_extras.io_utils import ImportHelper

from .. import native
from ..corpus_settings import refresh
from ..subject_settings import core_sex
from ..reachcast_corpus import importing
from ..reachcast_corpus.importing import FileReport
from ..reachcast_corpus.recordings import KINDS, ReadingOptions, find_files
from ..scene.capture import capture_motion
from .predict_motion import problem_of

_REPORT = "Reachcast Import"  #: the text that lists what became of every file


def _no_own_corpus(context: bpy.types.Context) -> str | None:
    if context.scene.reachcast.corpus:
        return native.reason()
    return native.reason() or ("Choose a corpus file of your own to add to; where there is none it is made. "
                               "The one that ships stays as it is.")


class _ToOwnCorpus:
    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        reason = _no_own_corpus(context)
        if reason:
            cls.poll_message_set(reason)
        return reason is None


class REACHCAST_OT_import_motions(_ToOwnCorpus, bpy.types.Operator, ImportHelper):
    bl_idname = "reachcast.import_motions"
    bl_label = "Import Motions"
    bl_description = ("Cut reaches out of recordings (BVH, C3D, TRC, AMC, CSV) and add them to the corpus. A file is "
                      "stored as a whole or not at all; Esc keeps what is finished")
    bl_options = {"UNDO"}

    filter_glob: bpy.props.StringProperty(default=";".join(f"*{kind}" for kind in KINDS), options={"HIDDEN"})
    files: bpy.props.CollectionProperty(type=bpy.types.OperatorFileListElement, options={"HIDDEN", "SKIP_SAVE"})
    directory: bpy.props.StringProperty(subtype="DIR_PATH", options={"HIDDEN", "SKIP_SAVE"})
    labels: bpy.props.StringProperty(name="Labels", subtype="FILE_PATH",
                                     description="A table that says where the phases are; empty finds them")
    stature: bpy.props.FloatProperty(name="Stature", min=0.0, max=2.6, subtype="DISTANCE", unit="LENGTH",
                                     description="Height of the recorded person; 0 takes what the recording shows")
    mirror: bpy.props.BoolProperty(name="Mirror Images", default=True, description="Add each motion mirrored, too")
    backwards: bpy.props.BoolProperty(name="Backwards", description="Add each motion played backwards, too")

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            self._begin(context)
        except (ValueError, RuntimeError) as error:
            return problem_of(self, context, error)
        if bpy.app.background:
            while not self._step(context):
                pass
            return self._end(context, "")
        window = context.window_manager
        window.progress_begin(0, len(self._files))
        self._timer = window.event_timer_add(0.01, window=context.window)
        window.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type == "ESC":
            return self._end(context, "stopped: ")
        if event.type == "TIMER" and self._step(context):
            return self._end(context, "")
        return {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        self._end(context, "stopped: ")

    def _begin(self, context: bpy.types.Context) -> None:
        core, chosen = native.core(), [Path(self.directory) / item.name for item in self.files if item.name]
        self._files = find_files(chosen or [bpy.path.abspath(self.filepath)])
        if not self._files:
            raise ValueError(f"'{self.filepath}' holds no recording; known kinds are {', '.join(KINDS)}")
        options = ReadingOptions(stature=self.stature or None, sex=core_sex(context.scene.reachcast.sex),
                                 mirror=self.mirror, backwards=self.backwards)
        labels = importing.labels_by_file(core, bpy.path.abspath(self.labels) if self.labels else None)
        self._corpus = importing.open_or_create(core, bpy.path.abspath(context.scene.reachcast.corpus))
        self._reports: list[FileReport] = []
        self._steps: Iterator[FileReport] = importing.import_files(core, self._corpus, self._files, options, labels)
        self._problem: Exception | None = None
        self._timer: Any = None

    def _step(self, context: bpy.types.Context) -> bool:
        """Imports one file; True when there is none left."""
        try:
            report = next(self._steps, None)
        except (ValueError, RuntimeError) as error:
            self._problem = error
            return True
        if report is None:
            return True
        self._reports.append(report)
        context.window_manager.progress_update(len(self._reports))
        if context.workspace:
            context.workspace.status_text_set(f"Importing motions: {len(self._reports)} of {len(self._files)} files, "
                                              f"{sum(r.motions for r in self._reports)} motions. Esc: stop here")
        return False

    def _end(self, context: bpy.types.Context, how: str) -> set[str]:
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
            context.window_manager.progress_end()
            self._timer = None
        if context.workspace:
            context.workspace.status_text_set(None)
        self._corpus.close()
        write_report(self._reports)
        if self._problem:
            return problem_of(self, context, self._problem)
        refresh(context)
        states = Counter(report.state for report in self._reports)
        rejected = sum(len(report.rejections) for report in self._reports)
        context.window_manager.reachcast_problem = ""
        self.report({"INFO"}, f"{how}{states['imported']} files imported, {states['known']} there already, "
                              f"{states['failed']} unreadable; {sum(r.motions for r in self._reports)} motions, "
                              f"{rejected} rejected: see the text '{_REPORT}'")
        return {"FINISHED"}


class REACHCAST_OT_capture_motion(_ToOwnCorpus, bpy.types.Operator):
    bl_idname = "reachcast.capture_motion"
    bl_label = "Capture Rig's Motion"
    bl_description = ("Add what the rig does in the scene's frame range to the corpus, whatever file it came from: the "
                      "way in for FBX, glTF and USD")
    bl_options = {"UNDO"}

    phase: bpy.props.EnumProperty(
        name="Phase", default="FIND", description="What the frames are",
        items=(("FIND", "Find phases", "Cut where the hands rest"), ("reach", "One reach", "Empty hands to the box"),
               ("transfer", "One transfer", "With the box, from home to the shelf"),
               ("return", "One return", "Empty hands back to the sides"),
               ("retrieve", "One retrieve", "With the box, from the shelf home")))

    def execute(self, context: bpy.types.Context) -> set[str]:
        settings, scene = context.scene.reachcast, context.scene
        try:
            if settings.rig is None:
                raise ValueError("Choose the rig whose motion is captured")
            with importing.open_or_create(native.core(), bpy.path.abspath(settings.corpus)) as corpus:
                report = capture_motion(settings.rig, corpus, scene.frame_start, scene.frame_end, scene=scene,
                                        bone_map=settings.bone_map or None,
                                        options=ReadingOptions(stature=settings.stature or None,
                                                               sex=core_sex(settings.sex)),
                                        phase=None if self.phase == "FIND" else self.phase)
            refresh(context)
        except (ValueError, RuntimeError) as error:
            return problem_of(self, context, error)
        write_report([report])
        context.window_manager.reachcast_problem = ""
        self.report({"INFO"}, str(report).splitlines()[0])
        return {"FINISHED"}


def write_report(reports: list[FileReport]) -> None:
    """What became of every file, in a text of the .blend: nothing disappears silently."""
    text = bpy.data.texts.get(_REPORT) or bpy.data.texts.new(_REPORT)
    text.from_string("\n".join(map(str, reports)) + "\n")
