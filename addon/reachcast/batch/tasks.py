# SPDX-License-Identifier: GPL-3.0-or-later
"""One row of a table as a checked task, and the units of work that it stands for. No Blender in here."""
from __future__ import annotations

import hashlib
import json
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass

OUTPUTS = ("action", "csv", "bvh", "gltf", "png", "mp4", "sheet")
ENGINES = ("EEVEE", "WORKBENCH", "CYCLES")
HANDS = ("both", "left", "right")
PHASES = ("reach", "transfer", "return", "retrieve")
MOST_VARIANTS = 1000
_ID = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,99}")

Place = tuple[float, ...] | str   #: metres, world: x, y, z and, if given, degrees about z; or an object's name


@dataclass(frozen=True)
class Task:
    """What one row asks for. Metres, kilograms, years, world axes."""

    id: str
    target: Place
    home: Place | None = None         #: None: in front of the body at waist height
    rig: str | None = None            #: an armature of the scene; None: a mannequin at the origin that faces +y
    stature: float | None = None      #: None: the rig's own height, 1.75 for a mannequin
    sex: str | None = None
    age: float | None = None
    mass: float | None = None         #: of the person
    object: tuple[float, ...] | str | None = None  #: width, depth, height of a box, or a mesh of the scene
    load: float | None = None         #: mass of the object; None: what the mesh says, else 5
    hands: str = "both"               #: or left or right: which hold the object
    phases: tuple[str, ...] = ("transfer",)
    variants: int = 0                 #: 0: the mean motion
    seed: int = 1                     #: of the first variant
    outputs: tuple[str, ...] = ("csv",)
    engine: str = "EEVEE"             #: of the pictures, as are all below
    camera: str | None = None         #: one of the scene; None: one that sees the whole motion
    resolution: tuple[int, int] = (640, 480)
    frame_step: int = 1               #: every so many frames is drawn


@dataclass(frozen=True)
class Unit:
    """One motion: a task and, for a variant, its seed."""

    task: Task
    seed: int | None

    @property
    def id(self) -> str:
        return self.task.id if self.seed is None else f"{self.task.id}_seed{self.seed}"

    def checksum(self, world: str) -> str:
        """Changes with the row, the seed and `world`: corpus, scene and version."""
        said = json.dumps([vars(self.task), self.seed, world], sort_keys=True)
        return hashlib.sha256(said.encode()).hexdigest()


def units_of(task: Task) -> list[Unit]:
    if not task.variants:
        return [Unit(task, None)]
    return [Unit(task, seed) for seed in range(task.seed, task.seed + task.variants)]


def read_task(row: Mapping[str, object], number: int) -> Task:
    """A task of a row's cells; ValueError names the column, the value and what is allowed. number: for a missing id."""
    unknown = sorted(set(row) - set(_COLUMNS))
    if unknown:
        raise ValueError(f"there is no column '{unknown[0]}'; the columns are {', '.join(_COLUMNS)}")
    given = {name: read(name, row[name]) for name, read in _COLUMNS.items() if not _is_empty(row.get(name))}
    if "target" not in given:
        raise ValueError("target is empty; it must be 'x y z', 'x y z degrees' or an object's name")
    given.setdefault("id", f"row-{number:05d}")
    return Task(**given)  # type: ignore[arg-type]


def _is_empty(value: object) -> bool:
    return value is None or value == [] or (isinstance(value, str) and not value.strip())


def _identifier(name: str, value: object) -> str:
    text = str(value).strip()
    if not _ID.fullmatch(text):
        raise ValueError(f"{name} is {text!r}; it must be 1 to 100 letters, digits, '.', '_' or '-' and begin with a "
                         f"letter or a digit")
    return text


def _text(name: str, value: object) -> str:
    if not isinstance(value, str):
        raise ValueError(f"{name} is {value!r}; it must be a name")
    return value.strip()


def _number(least: float, most: float) -> Callable[[str, object], float]:
    def read(name: str, value: object) -> float:
        try:
            number = math.nan if isinstance(value, bool) else float(value)  # type: ignore[arg-type]
        except (TypeError, ValueError):
            number = math.nan
        if not least <= number <= most:
            raise ValueError(f"{name} is {value!r}; it must be a number from {least:g} to {most:g}")
        return number
    return read


def _whole(least: int, most: int) -> Callable[[str, object], int]:
    def read(name: str, value: object) -> int:
        number = _number(least, most)(name, value)
        if number != int(number):
            raise ValueError(f"{name} is {value!r}; it must be a whole number")
        return int(number)
    return read


def _numbers(value: object) -> tuple[float, ...] | None:
    parts = value.replace(",", " ").split() if isinstance(value, str) else value
    if not isinstance(parts, (list, tuple)):
        return None
    try:
        return tuple(map(float, parts))
    except (TypeError, ValueError):
        return None


def _place(name: str, value: object) -> Place:
    numbers = _numbers(value)
    if numbers is None and isinstance(value, str):
        return value.strip()
    if numbers is None or len(numbers) not in (3, 4) or not all(abs(part) <= 1000.0 for part in numbers):
        raise ValueError(f"{name} is {value!r}; it must be 'x y z', 'x y z degrees' or an object's name")
    return numbers


def _object(name: str, value: object) -> tuple[float, ...] | str:
    numbers = _numbers(value.replace("x", " ") if isinstance(value, str) else value)
    if numbers is None and isinstance(value, str):
        return value.strip()
    if numbers is None or len(numbers) != 3 or not all(0.001 <= part <= 3.0 for part in numbers):
        raise ValueError(f"{name} is {value!r}; it must be width x depth x height, 0.001 to 3 m each, or a mesh's name")
    return numbers


def _words(allowed: tuple[str, ...]) -> Callable[[str, object], tuple[str, ...]]:
    def read(name: str, value: object) -> tuple[str, ...]:
        words = tuple(re.split(r"[\s,;+]+", value.strip()) if isinstance(value, str) else value)  # type: ignore[arg-type]
        for word in words:
            if word not in allowed:
                raise ValueError(f"{name} has {word!r}; it may have {', '.join(allowed)}")
        return words
    return read


def _one_of(*allowed: str) -> Callable[[str, object], str]:
    def read(name: str, value: object) -> str:
        if value not in allowed:
            raise ValueError(f"{name} is {value!r}; it must be {', '.join(allowed[:-1])} or {allowed[-1]}")
        return str(value)
    return read


def _resolution(name: str, value: object) -> tuple[int, int]:
    """Even, as films need it."""
    numbers = _numbers(value.replace("x", " ") if isinstance(value, str) else value)
    if numbers is None or len(numbers) != 2 or not all(16 <= part <= 4096 and part % 2 == 0 for part in numbers):
        raise ValueError(f"{name} is {value!r}; it must be width x height, even numbers of pixels from 16 to 4096 each")
    return int(numbers[0]), int(numbers[1])


_COLUMNS: dict[str, Callable[[str, object], object]] = {
    "id": _identifier, "rig": _text, "stature": _number(0.5, 2.5), "sex": _one_of("female", "male"),
    "age": _number(0.0, 120.0), "mass": _number(1.0, 400.0), "home": _place, "target": _place, "object": _object,
    "load": _number(0.0, 200.0), "hands": _one_of(*HANDS), "phases": _words(PHASES), "variants": _whole(0, MOST_VARIANTS), "seed": _whole(0, 2 ** 31 - 1 - MOST_VARIANTS),
    "outputs": _words(OUTPUTS), "engine": _one_of(*ENGINES), "camera": _text, "resolution": _resolution,
    "frame_step": _whole(1, 100)}
