# SPDX-License-Identifier: GPL-3.0-or-later
"""Every control says in its tooltip more than its name says, and `docs/panel.md` tells of every one."""
from __future__ import annotations

import re
import unittest
from collections.abc import Iterator
from pathlib import Path

import bpy
from reachcast import registration

DOCUMENT = Path(__file__).resolve().parent.parent / "docs" / "panel.md"
LEAST_WORDS = 4


def words(text: str) -> set[str]:
    return set(re.findall(r"[a-z0-9]+", text.lower()))


def rna_of(cls: type) -> bpy.types.Struct:
    if issubclass(cls, bpy.types.Operator):
        return getattr(bpy.ops.reachcast, cls.bl_idname.split(".")[1]).get_rna_type()
    return cls.bl_rna


def is_shown(item: bpy.types.Property) -> bool:
    """Not what only holds other properties."""
    holds = item.type == "COLLECTION" or (item.type == "POINTER" and item.fixed_type.identifier in
                                          {cls.__name__ for cls in registration.CLASSES})
    return item.is_runtime and not item.is_hidden and not holds


def own_properties(cls: type) -> Iterator[bpy.types.Property]:
    return filter(is_shown, rna_of(cls).properties)


def on_other_types() -> Iterator[bpy.types.Property]:
    return (item for cls in (bpy.types.Scene, bpy.types.Object, bpy.types.WindowManager)
            for item in cls.bl_rna.properties if item.identifier.startswith("reachcast") and is_shown(item))


def shown(*kinds: type) -> list[type]:
    return [cls for cls in registration.CLASSES if issubclass(cls, kinds)]


class Tooltips(unittest.TestCase):
    def assert_says_more(self, what: str, name: str, description: str) -> None:
        with self.subTest(what=what):
            self.assertGreaterEqual(len(description.split()), LEAST_WORDS, description)
            self.assertGreaterEqual(len(words(description) - words(name)), LEAST_WORDS - 1, description)
            self.assertFalse(description.endswith("."), "Blender adds the full stop")

    def test_operators_panels_and_menus(self) -> None:
        for cls in shown(bpy.types.Operator, bpy.types.Panel, bpy.types.Menu):
            self.assert_says_more(cls.__name__, cls.bl_label, getattr(cls, "bl_description", ""))

    def test_properties(self) -> None:
        found = [(cls.__name__, item) for cls in registration.CLASSES for item in own_properties(cls)]
        self.assertGreater(len(found), 40)
        for owner, item in [*found, *(("", item) for item in on_other_types())]:
            self.assertTrue(item.name, f"{owner}.{item.identifier}")
            self.assert_says_more(f"{owner}.{item.identifier}", item.name, item.description)

    def test_choices(self) -> None:
        for cls in registration.CLASSES:
            for item in own_properties(cls):
                for choice in item.enum_items if item.type == "ENUM" else ():
                    with self.subTest(choice=f"{cls.__name__}.{item.identifier}.{choice.identifier}"):
                        self.assertGreaterEqual(len(choice.description.split()), 2)


class Documented(unittest.TestCase):
    def test_every_panel_button_and_setting_is_in_the_document(self) -> None:
        text = DOCUMENT.read_text(encoding="utf-8")
        named = {cls.bl_label for cls in shown(bpy.types.Operator, bpy.types.Panel, bpy.types.Menu)}
        for cls in shown(bpy.types.PropertyGroup, bpy.types.AddonPreferences):
            named |= {item.name for item in own_properties(cls) if cls.__name__ not in ("ListedMotion", "SegmentBone")}
        named |= {item.name for item in on_other_types()}
        self.assertEqual([name for name in sorted(named) if f"*{name}*" not in text], [])

    def test_its_pictures_are_there_and_small(self) -> None:
        pictures = re.findall(r"!\[[^\]]+\]\(([^)]+)\)", DOCUMENT.read_text(encoding="utf-8"))
        self.assertGreaterEqual(len(pictures), 3)
        for picture in pictures:
            self.assertLess((DOCUMENT.parent / picture).stat().st_size, 200_000, picture)

    def test_the_readme_leads_to_it(self) -> None:
        self.assertTrue("(docs/panel.md)" in (DOCUMENT.parent.parent / "README.md").read_text(encoding="utf-8"))
