# SPDX-License-Identifier: GPL-3.0-or-later
"""What is to be carried where: the shelf, the home and the box of a scene, in a rig's body frame."""
from __future__ import annotations

import math
from dataclasses import dataclass

import bpy
import numpy as np

from ..rigs.rotations import Array
from ..rigs.skeleton import Skeleton
from .transforms import MAX_UNEVEN, Placement, above_matrix, described, placement

HANDLE_HEIGHT = "reachcast_handle_height"   #: custom property of a box, metres above its base
GRIP_DISTANCE = "reachcast_grip_distance"   #: custom property of a box, metres between the centres of the two grips
BOX_MASS = "reachcast_mass"                 #: custom property of a box, kilograms
MAX_TILT_DEG = 5.0
DEFAULT_MASS = 5.0
_DEFAULT_SIZE = (0.35, 0.30, 0.25)
_HALF_HAND = 0.02                           #: metres from a box's wall to the middle of a hand that holds it
LEAST_WAY_M = 0.01                          #: the native module's own limit, from home to target
_MOST_METRES = 3.0                          #: no pair of hands holds a larger box


@dataclass(frozen=True)
class BoxShape:
    """A box in metres. The grips are `grip_distance` apart along its own x, `handle_height` above its base."""

    width: float
    depth: float
    height: float
    handle_height: float
    grip_distance: float
    mass: float
    origin_offset: tuple[float, float, float] = (0.0, 0.0, 0.0)  #: from the centre of the base to the object's origin


@dataclass(frozen=True)
class Lift:
    """A task in the body frame. Yaws are in (-pi/2, pi/2]: a box looks the same to two hands after half a turn."""

    home: Array
    target: Array
    home_yaw: float
    target_yaw: float
    box: BoxShape
    half_turn: bool  #: the mesh stands half a turn away from the box that the hands see


def read_lift(skeleton: Skeleton, shelf: bpy.types.Object, home: bpy.types.Object | None,
              box: bpy.types.Object | None, layer: bpy.types.ViewLayer | None = None) -> Lift:
    """The task: the box's base goes from `home` (else from where the box stands, else from the front of the body at
    waist height) to `shelf`, as `layer` (the user's own by default) shows them. ValueError names the object, its value
    and the limit."""
    if not isinstance(shelf, bpy.types.Object):
        raise ValueError(f"The shelf must be an object (an Empty where the box is to end), not {described(shelf)}")
    if home is not None and not isinstance(home, bpy.types.Object):
        raise ValueError(f"The home must be an object (an Empty where the box starts) or None, not {described(home)}")
    shape = read_box(box, layer) if box is not None else _default_box()
    target = placement(shelf, layer)
    target_yaw, _ = _half_turns(_yaw(skeleton, target.rotation))
    if home is not None:
        start = placement(home, layer)
        place, rotation = start.origin, start.rotation
    elif box is not None:
        start = placement(box, layer)
        rotation = start.rotation
        place = start.origin - rotation @ np.array(shape.origin_offset)
        if np.linalg.norm(place - target.origin) < LEAST_WAY_M:
            raise ValueError(f"Box '{box.name}' already stands on '{shelf.name}'; go to a frame in which it stands "
                             f"where it is to start, or choose a home")
    else:
        return Lift(_in_front(skeleton, shape), _placed(skeleton, target.origin), 0.0, target_yaw, shape, False)
    home_yaw, half_turn = _half_turns(_yaw(skeleton, rotation))
    return Lift(_placed(skeleton, place), _placed(skeleton, target.origin), home_yaw, target_yaw, shape, half_turn)


def lift_between(skeleton: Skeleton, shape: BoxShape, home: Placement | None, target: Placement) -> Lift:
    """The task from world placements: of the middle of the box's base at home (None: in front of the body at waist
    height, square to it) and at its end."""
    target_yaw, _ = _half_turns(_yaw(skeleton, target.rotation))
    end = _placed(skeleton, target.origin)
    if home is None:
        return Lift(_in_front(skeleton, shape), end, 0.0, target_yaw, shape, False)
    home_yaw, half_turn = _half_turns(_yaw(skeleton, home.rotation))
    return Lift(_placed(skeleton, home.origin), end, home_yaw, target_yaw, shape, half_turn)


def place_of(skeleton: Skeleton, item: bpy.types.Object, layer: bpy.types.ViewLayer | None = None) -> tuple[Array, float]:
    """Where an Empty puts the middle of the box's base, body frame, and its turn there, in (-pi/2, pi/2]."""
    place = placement(item, layer)
    return _placed(skeleton, place.origin), _half_turns(_yaw(skeleton, place.rotation))[0]


def read_box(box: bpy.types.Object, layer: bpy.types.ViewLayer | None = None) -> BoxShape:
    """Size and handles of a box mesh from the bounds of its own vertices in its own axes; ValueError when it cannot be
    carried. What modifiers make of the mesh is not counted: hands hold the box as it was modelled."""
    if not isinstance(box, bpy.types.Object) or box.type != "MESH":
        raise ValueError(f"The box must be a mesh object, not {described(box)}")
    place = placement(box, layer)
    tilt = math.degrees(math.acos(float(np.clip(place.rotation[2, 2], -1.0, 1.0))))
    if tilt > MAX_TILT_DEG:
        raise ValueError(f"Box '{box.name}' is tilted by {tilt:.0f} degrees; the limit is {MAX_TILT_DEG:.0f}")
    low, high = (corner * place.scale for corner in _bounds(box))
    size = high - low
    for axis, length in zip(("width (x)", "depth (y)", "height (z)"), size):
        if not 1e-3 <= length <= _MOST_METRES:
            raise ValueError(f"Box '{box.name}' has a {axis} of {length:g} m; it must be from 0.001 to "
                             f"{_MOST_METRES:g} m")
    handle = _number(box, HANDLE_HEIGHT, 0.5 * float(size[2]), 0.0, float(size[2]))
    grips = _number(box, GRIP_DISTANCE, float(size[0]) + 2.0 * _HALF_HAND, 0.02, _MOST_METRES + 1.0)
    mass = _number(box, BOX_MASS, DEFAULT_MASS, 0.0, 200.0)
    base = np.array([*(0.5 * (low + high))[:2], low[2]])
    return BoxShape(*(float(length) for length in size), handle, grips, mass, tuple(float(part) for part in -base))


def _bounds(box: bpy.types.Object) -> tuple[Array, Array]:
    """The least and the greatest x, y, z of the mesh's own vertices."""
    places = np.empty(3 * len(box.data.vertices), dtype=np.float32)
    if not len(places):
        raise ValueError(f"Box '{box.name}' has no vertices, so it has no size")
    box.data.vertices.foreach_get("co", places)
    corners = places.reshape(-1, 3).astype(float)
    return corners.min(axis=0), corners.max(axis=0)


def refuse_held_box(box: bpy.types.Object, layer: bpy.types.ViewLayer | None = None) -> None:
    """ValueError when keys on the box could not bring it where the hands are."""
    if any(box.delta_location) or any(box.delta_rotation_euler) or tuple(box.delta_scale) != (1.0, 1.0, 1.0) \
            or tuple(box.delta_rotation_quaternion) != (1.0, 0.0, 0.0, 0.0):
        raise ValueError(f"Box '{box.name}' has delta transforms; clear them first")
    lengths = np.linalg.norm(above_matrix(box, layer)[:3, :3], axis=0)
    if not np.all(np.isfinite(lengths)) or np.ptp(lengths) > MAX_UNEVEN * np.max(lengths):
        raise ValueError(f"Box '{box.name}' has a parent that is scaled unevenly; give the parent an even scale")


def _number(item: bpy.types.Object, name: str, default: float, least: float, most: float) -> float:
    value = item.get(name, default)
    if not isinstance(value, (int, float)) or not math.isfinite(value) or not least <= value <= most:
        raise ValueError(f"Box '{item.name}': its property {name} is {value!r}; it must be from {least:g} to {most:g}")
    return float(value)


def _default_box() -> BoxShape:
    width, depth, height = _DEFAULT_SIZE
    return BoxShape(width, depth, height, 0.5 * height, width + 2.0 * _HALF_HAND, DEFAULT_MASS)


def _placed(skeleton: Skeleton, place: Array) -> Array:
    """A world point in the body frame, without the noise of single precision (a tenth of a micrometre)."""
    return np.round(skeleton.to_body(place), 7) + 0.0


def _in_front(skeleton: Skeleton, shape: BoxShape) -> Array:
    """Faraway 2004, p. 546: "a position in front of the body at waist height"."""
    waist = skeleton.to_body(skeleton.joint("l5s1"))
    forward = 0.12 * skeleton.height + 0.5 * shape.depth
    return np.array([0.0, waist[1] + forward, waist[2] - shape.handle_height])


def _yaw(skeleton: Skeleton, rotation: Array) -> float:
    """Turn about z from the body's x axis to the object's own, seen from above."""
    x_axis = skeleton.axes @ rotation[:, 0]
    if math.hypot(x_axis[0], x_axis[1]) < 1e-6:
        return 0.0
    return math.atan2(x_axis[1], x_axis[0])


def _half_turns(yaw: float) -> tuple[float, bool]:
    """The same direction of the handles within a quarter turn, and whether half a turn was taken off."""
    turns = math.ceil((yaw - 1e-9) / math.pi - 0.5)
    return yaw - turns * math.pi, turns % 2 != 0
