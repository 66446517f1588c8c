# SPDX-License-Identifier: GPL-3.0-or-later
"""Reachcast: predicts how a person carries a box to a shelf and writes it as an Action on a rig."""
from __future__ import annotations

bl_info = {
    "name": "Reachcast",
    "author": "The Reachcast authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > Reachcast; Add > Armature > Reachcast Mannequin",
    "description": "Predicts from recorded motions how a person moves a box to a shelf, as an Action on your rig",
    "category": "Animation",
}


def register() -> None:
    from . import registration
    registration.register()


def unregister() -> None:
    from . import registration
    registration.unregister()
