# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's preferences: folders with corpora, the usual person, and the unit in which the panel tells lengths."""
from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import bpy

SEXES = (("ANY", "Any", "Do not tell"), ("FEMALE", "Female", "A woman"), ("MALE", "Male", "A man"))
UNITS = (("METRES", "Metres", "As 1.20 m and 0.03 mm"), ("CENTIMETRES", "Centimetres", "As 120 cm and 0.03 mm"),
         ("INCHES", "Inches", "As 47.2 in and 0.001 in"))
#: What holds while the add-on has no preferences, as when a script enables it for one session.
UNSAID: dict[str, Any] = {"stature": 0.0, "sex": "ANY", "age": 0.0, "mass": 0.0, "units": "METRES"}


class CorpusFolder(bpy.types.PropertyGroup):
    """A folder that is searched for corpora."""

    folder: bpy.props.StringProperty(name="Folder", subtype="DIR_PATH",
                                     description="Corpora (*.sqlite) in it are offered in the panel")


class ReachcastPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    corpus_folders: bpy.props.CollectionProperty(
        name="Corpus Folders", type=CorpusFolder, description="Folders whose corpora are offered in the panel")
    stature: bpy.props.FloatProperty(
        name="Stature", min=0.0, max=2.6, precision=4, subtype="DISTANCE", unit="LENGTH",
        description="Height of the usual person, for scenes that do not say another; 0 takes the rig's own")
    sex: bpy.props.EnumProperty(name="Sex", items=SEXES, description="Sex of the usual person")
    age: bpy.props.FloatProperty(name="Age", min=0.0, max=130.0, precision=0,
                                 description="Age of the usual person in years; 0 does not tell")
    mass: bpy.props.FloatProperty(name="Body Mass", min=0.0, max=500.0, precision=0,
                                  description="Body mass of the usual person in kilograms; 0 does not tell")
    units: bpy.props.EnumProperty(name="Lengths in", items=UNITS,
                                  description="How the panel tells lengths. Errors of the native module stay in metres")

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        column = layout.column(align=True)
        column.label(text="Folders with corpora:")
        for number, item in enumerate(self.corpus_folders):
            row = column.row(align=True)
            row.prop(item, "folder", text="")
            row.operator("reachcast.remove_corpus_folder", text="", icon="X").index = number
        column.operator("reachcast.add_corpus_folder", icon="ADD")
        column = layout.column(align=True)
        column.label(text="Usual person, for scenes that do not say another:")
        for name in ("stature", "sex", "age", "mass"):
            column.prop(self, name)
        layout.prop(self, "units")


def of_addon() -> ReachcastPreferences | None:
    """None when the add-on is enabled without being among the user's add-ons."""
    addon = bpy.context.preferences.addons.get(__package__)
    return addon.preferences if addon else None


def preferred(name: str) -> Any:
    """The value of a preference, or what holds without any."""
    found = of_addon()
    return getattr(found, name) if found else UNSAID[name]


def offered_corpora() -> list[Path]:
    """Corpora in the folders of the preferences, folder by folder, by name. Folders inside them are not looked into."""
    found = of_addon()
    folders = [Path(bpy.path.abspath(item.folder)) for item in found.corpus_folders if item.folder] if found else []
    return list(dict.fromkeys(path for folder in folders for path in sorted(folder.glob("*.sqlite"))))


def length_text(metres: float) -> str:
    """A length of the size of a body."""
    return {"METRES": f"{metres:.2f} m", "CENTIMETRES": f"{metres * 100.0:.0f} cm",
            "INCHES": f"{metres / 0.0254:.1f} in"}[preferred("units")]


def place_text(metres: Iterable[float]) -> str:
    """A point, or several lengths in one unit."""
    texts = [length_text(value).split() for value in metres]
    return f"({', '.join(number for number, _ in texts)}) {texts[0][1]}"


def expected_text(metres: float) -> str:
    """A length of the size of a hand, such as the error of a prediction."""
    return f"{metres / 0.0254:.1f} in" if preferred("units") == "INCHES" else f"{metres * 100.0:.1f} cm"


def error_text(metres: float) -> str:
    """A length that should be small: a landing, a grip."""
    return f"{metres / 0.0254:.3f} in" if preferred("units") == "INCHES" else f"{metres * 1000.0:.2f} mm"
