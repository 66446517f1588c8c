# SPDX-License-Identifier: GPL-3.0-or-later
"""Who moves, as the panel asks for it. What a scene does not say is taken from the add-on's preferences."""
from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy

from .preferences import SEXES, preferred

_SEXES = [identifier for identifier, _, _ in SEXES]


def _kept(name: str) -> tuple[Callable[[Any], float], Callable[[Any, float], None]]:
    """Getter and setter of a number that is kept with the scene once it has been set."""
    def get(settings: Any) -> float:
        return settings.get(name, preferred(name))

    def put(settings: Any, value: float) -> None:
        settings[name] = value
    return get, put


def _sex(settings: Any) -> int:
    return settings.get("sex", _SEXES.index(preferred("sex")))


def _set_sex(settings: Any, value: int) -> None:
    settings["sex"] = value


_GET_STATURE, _SET_STATURE = _kept("stature")
_GET_AGE, _SET_AGE = _kept("age")
_GET_MASS, _SET_MASS = _kept("mass")


class SubjectSettings:
    """Part of `ReachcastSettings`."""

    stature: bpy.props.FloatProperty(
        name="Stature", min=0.0, max=2.6, precision=4, subtype="DISTANCE", unit="LENGTH", get=_GET_STATURE,
        set=_SET_STATURE,
        description="Height of the person to move like; 0 takes the rig's own")
    sex: bpy.props.EnumProperty(name="Sex", items=SEXES, get=_sex, set=_set_sex,
                                description="Whose motions count as similar")
    age: bpy.props.FloatProperty(
        name="Age", min=0.0, max=130.0, precision=0, get=_GET_AGE, set=_SET_AGE,
        description="Years, for schemes that compare ages; 0 does not tell")
    mass: bpy.props.FloatProperty(
        name="Body Mass", min=0.0, max=500.0, precision=0, get=_GET_MASS, set=_SET_MASS,
        description="Kilograms, for schemes that compare body masses; 0 does not tell")


def core_sex(identifier: str) -> str | None:
    """The native module's word for an item of the sex property."""
    return None if identifier == "ANY" else identifier.lower()
