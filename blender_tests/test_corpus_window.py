# SPDX-License-Identifier: GPL-3.0-or-later
"""The Corpus part of the panel in a real window: an import that is stopped with Esc and finished later, the list, one
motion played, and the targets drawn around the rig.

    xvfb-run -a -s "-screen 0 1280x900x24" blender --factory-startup --enable-event-simulate \\
        --window-geometry 0 0 1280 800 --python blender_tests/test_corpus_window.py -- [--out DIR]

Writes panel_corpus.png; exit status 1 when something is not as it should be.
"""
from __future__ import annotations

import argparse
import math
import os
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [os.fspath(HERE.parent / "addon"), os.fspath(HERE)]

import addon_utils  # noqa: E402
import bpy  # noqa: E402
from test_panel_window import arguments, look_at_all, open_tab, picture, player, view_3d  # noqa: E402

RECORDINGS = 60
#: Panels above the list that are closed, so that it is in the picture. Python can only say which begin closed.
CLOSED = ("REACHCAST_PT_subject", "REACHCAST_PT_result")


def write_recordings(folder: Path) -> tuple[Path, Path]:
    """A folder of tables of joint centres out of the corpus that ships, and the labels beside it."""
    from reachcast import native
    from reachcast.corpora import default_corpus
    from reachcast.reachcast_corpus.exporting import export_motion
    core = native.core()
    recordings, rows = folder / "recordings", ["file,phase,start_s,end_s,stature_m"]
    recordings.mkdir()
    with core.Corpus.open(str(default_corpus())) as shipped:
        long = [motion for motion in shipped.motions() if motion.phase == "transfer" and motion.duration > 1.0
                and math.dist(motion.home, motion.target) > 0.4]
        for motion in long[::len(long) // RECORDINGS][:RECORDINGS]:
            name = export_motion(core, shipped, motion, recordings, "csv").name
            rows.append(f"{name},transfer,0,{motion.duration - 0.05:.2f},{motion.subject.stature:.2f}")
    labels = folder / "labels.csv"
    labels.write_text("\n".join(rows) + "\n")
    return recordings, labels


def begin_import(recordings: Path, labels: Path) -> None:
    area, region = view_3d()
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=area, region=region):
        assert bpy.ops.reachcast.import_motions(filepath=str(recordings), labels=str(labels)) == {"RUNNING_MODAL"}


def stored(path: str) -> tuple[int, int]:
    """How many motions, and from how many files."""
    from reachcast import native
    with native.core().Corpus.open(path) as corpus:
        return len(corpus), len(corpus.sources())


def story(options: argparse.Namespace, folder: Path) -> Iterator[float | None]:
    settings, listing = bpy.context.scene.reachcast, bpy.context.window_manager.reachcast_motions
    window = bpy.context.window_manager.windows[0]
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()
    bpy.ops.reachcast.add_mannequin()
    settings.corpus = str(folder / "own.sqlite")
    recordings, labels = write_recordings(folder)
    view_3d()[0].spaces.active.show_region_ui = True
    yield None
    open_tab()
    yield None
    begin_import(recordings, labels)
    yield 0.15
    window.event_simulate(type="ESC", value="PRESS")
    window.event_simulate(type="ESC", value="RELEASE")
    yield 1.0
    motions, files = stored(settings.corpus)
    assert 0 < files < RECORDINGS and motions == 2 * files, f"{motions} motions of {files} files after Esc"
    begin_import(recordings, labels)
    while stored(settings.corpus)[1] < RECORDINGS:
        yield 0.2
    yield 0.5
    assert listing.total == stored(settings.corpus)[0] > RECORDINGS, listing.total
    listing.active = 5
    area, region = view_3d()
    with bpy.context.temp_override(window=window, area=area, region=region):
        assert bpy.ops.reachcast.play_motion() == {"FINISHED"}
    listing.show_targets = True
    bpy.context.scene.frame_set(30)
    look_at_all()
    yield None
    picture(options.out / "panel_corpus.png")
    from reachcast.scene import target_cloud
    assert target_cloud.is_shown()
    listing.show_targets = False
    assert not target_cloud.is_shown()


def main() -> None:
    options = arguments()
    options.out.mkdir(parents=True, exist_ok=True)
    from reachcast import panels, panels_corpus
    panels_corpus.REACHCAST_PT_corpus.bl_options = set()
    for name in CLOSED:
        getattr(panels, name).bl_options = {"DEFAULT_CLOSED"}
    addon_utils.enable("reachcast")
    bpy.context.preferences.view.show_splash = False
    folder = tempfile.TemporaryDirectory()
    bpy.app.timers.register(player(story(options, Path(folder.name))), first_interval=1.0)
    main.folder = folder  # kept until the process ends


if __name__ == "__main__":
    main()
