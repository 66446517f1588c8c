# SPDX-License-Identifier: GPL-3.0-or-later
"""What is to be carried where: the shelf, the home and the box of a scene, in a rig's body frame."""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np

from ..rigs.rotations import Array
from ..rigs.skeleton import Skeleton
from .transforms import MAX_UNEVEN, Placement, above_matrix, described, placement

HANDLE_HEIGHT = "reachcast_handle_height"   #: custom property of a box, metres above its base
GRIP_DISTANCE = "reachcast_grip_distance"   #: custom property of a box, metres between the centres of the two grips
BOX_MASS = "reachcast_mass"                 #: custom property of a box, kilograms
MAX_UNLEVEL_M = 0.01                        #: between the heights of two handles
DEFAULT_MASS = 5.0
_DEFAULT_SIZE = (0.35, 0.30, 0.25)
_HALF_HAND = 0.02                           #: metres from a box's wall to the middle of a hand that holds it
LEAST_WAY_M = 0.01                          #: the native module's own limit, from home to target
_MOST_METRES = 3.0                          #: no pair of hands holds a larger box
ONE_HAND_SIZE, ONE_HAND_MASS = (0.08, 0.08, 0.20), 1.0   #: of what one hand carries when nothing is said
HANDS = ("both", "left", "right")           #: which hold the object


@dataclass(frozen=True)
class BoxShape:
    """A box in metres, in an upright frame with the grips `grip_distance` apart along x, `handle_height` above its base.
    The frame's origin lies on the base, beneath the middle between the grips."""

    width: float
    depth: float
    height: float
    handle_height: float
    grip_distance: float
    mass: float
    origin_offset: tuple[float, float, float] = (0.0, 0.0, 0.0)  #: from the frame's origin to the object's
    middle: tuple[float, float] = (0.0, 0.0)                     #: from the frame's origin to the middle of the base
    turn: tuple[tuple[float, ...], ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))  #: rows: mesh in the frame


@dataclass(frozen=True)
class Lift:
    """A task in the body frame. Yaws are in (-pi/2, pi/2]: a box looks the same to two hands after half a turn.

    One hand holds the object in the middle between what would be the grips of two."""

    home: Array
    target: Array
    home_yaw: float
    target_yaw: float
    box: BoxShape
    half_turn: bool  #: the mesh stands half a turn away from the box that the hands see
    hands: str = "both"

    def grips(self) -> dict[str, Array]:
        """Where the hands that work hold the box, in the box's frame: "left" and "right" -> (3,) metres."""
        apart = self.box.grip_distance if self.hands == "both" else 0.0
        return {word: np.array([side * apart, 0.0, self.box.handle_height])
                for word, side in (("left", -0.5), ("right", 0.5)) if self.hands in ("both", word)}


def read_lift(skeleton: Skeleton, shelf: bpy.types.Object, home: bpy.types.Object | None,
              box: bpy.types.Object | None, layer: bpy.types.ViewLayer | None = None,
              handles: Sequence[bpy.types.Object] | None = None, hands: str = "both") -> Lift:
    """The task: the box's base goes from `home` (else from where the box stands, else from the front of the body at
    waist height) to `shelf`, as `layer` (the user's own by default) shows them. ValueError names the object, its value
    and the limit."""
    if hands not in HANDS:
        raise ValueError(f"The hands are {hands!r}; they must be {', '.join(HANDS[:-1])} or {HANDS[-1]}")
    if hands != "both" and handles:
        raise ValueError(f"Handles are for both hands; the {hands} hand alone holds the box in its middle")
    if not isinstance(shelf, bpy.types.Object):
        raise ValueError(f"The shelf must be an object (an Empty where the box is to end), not {described(shelf)}")
    if home is not None and not isinstance(home, bpy.types.Object):
        raise ValueError(f"The home must be an object (an Empty where the box starts) or None, not {described(home)}")
    shape = read_box(box, layer, handles) if box is not None else _default_box(hands)
    target = placement(shelf, layer)
    if home is not None:
        return lift_between(skeleton, shape, placement(home, layer), target, hands=hands)
    if box is None:
        return lift_between(skeleton, shape, None, target, hands=hands)
    start = standing(box, shape, layer)
    middle = start.origin + start.rotation @ np.array([*shape.middle, 0.0])
    if np.linalg.norm(middle - target.origin) < LEAST_WAY_M:
        raise ValueError(f"Box '{box.name}' already stands on '{shelf.name}'; go to a frame in which it stands where it "
                         f"is to start, or choose a home")
    return lift_between(skeleton, shape, start, target, stands=True, hands=hands)


def lift_between(skeleton: Skeleton, shape: BoxShape, home: Placement | None, target: Placement,
                 stands: bool = False, hands: str = "both") -> Lift:
    """The task from world placements of the middle of the box's base at home (None: in front of the body, or of the
    shoulder of the one hand, at waist height, square to it) and at its end. stands: home is beneath the grips instead,
    as `standing` has it."""
    target_yaw, _ = _half_turns(_yaw(skeleton, target.rotation))
    end = _placed(skeleton, target.origin)
    if home is None:
        return Lift(_in_front(skeleton, shape, hands), end, 0.0, target_yaw, shape, False, hands)
    home_yaw, half_turn = _half_turns(_yaw(skeleton, home.rotation))
    start = _placed(skeleton, home.origin)
    if not stands:
        start = start - beneath_grips(home_yaw, shape, half_turn)
    return Lift(start, end - beneath_grips(target_yaw, shape, half_turn), home_yaw, target_yaw, shape, half_turn, hands)


def standing(box: bpy.types.Object, shape: BoxShape, layer: bpy.types.ViewLayer | None = None) -> Placement:
    """Where the frame of the shape of a mesh is in the world: beneath its grips, upright."""
    place = placement(box, layer)
    rotation = place.rotation @ np.array(shape.turn).T
    return Placement(place.origin - rotation @ np.array(shape.origin_offset), rotation, place.scale)


def place_of(skeleton: Skeleton, item: bpy.types.Object, lift: Lift,
             layer: bpy.types.ViewLayer | None = None) -> tuple[Array, float]:
    """Where an Empty puts the box of `lift`, body frame, and its turn there, in (-pi/2, pi/2]."""
    place = placement(item, layer)
    yaw = _half_turns(_yaw(skeleton, place.rotation))[0]
    return _placed(skeleton, place.origin) - beneath_grips(yaw, lift.box, lift.half_turn), yaw


def beneath_grips(yaw: float, shape: BoxShape, half_turn: bool) -> Array:
    """(3,) body frame: from beneath the middle of the grips to the middle of the base, which an Empty marks."""
    x, y = (-part if half_turn else part for part in shape.middle)
    return np.array([x * math.cos(yaw) - y * math.sin(yaw), x * math.sin(yaw) + y * math.cos(yaw), 0.0])


def read_box(box: bpy.types.Object, layer: bpy.types.ViewLayer | None = None,
             handles: Sequence[bpy.types.Object] | None = None) -> BoxShape:
    """Size and handles of a mesh as it lies, from the bounds of what is shown of it; ValueError when it cannot be carried.

    Hands hold it at the middles of its left and right side, along its own x (its y when x stands upright), or at two
    objects, the `handles`. It keeps the tilt that it has.
    """
    if not isinstance(box, bpy.types.Object) or box.type != "MESH":
        raise ValueError(f"The box must be a mesh object, not {described(box)}")
    place = placement(box, layer)
    grips = None if not handles else _handle_places(box, handles, layer)
    frame = _upright(place.rotation) if grips is None else _along(grips[1] - grips[0])
    points = (_vertices(box, layer) * place.scale) @ place.rotation.T @ frame
    low, high = points.min(axis=0), points.max(axis=0)
    size, middle = high - low, 0.5 * (low + high)
    for axis, length in zip(("width (x)", "depth (y)", "height (z)"), size):
        if not 1e-3 <= length <= _MOST_METRES:
            raise ValueError(f"Box '{box.name}' has a {axis} of {length:g} m; it must be from 0.001 to "
                             f"{_MOST_METRES:g} m")
    mass = _number(box, BOX_MASS, DEFAULT_MASS, 0.0, 200.0)
    if grips is None:
        under = np.array([*middle[:2], low[2]])
        handle = _number(box, HANDLE_HEIGHT, 0.5 * float(size[2]), 0.0, float(size[2]))
        apart = _number(box, GRIP_DISTANCE, float(size[0]) + 2.0 * _HALF_HAND, 0.02, _MOST_METRES + 1.0)
    else:
        held = (0.5 * (grips[0] + grips[1]) - place.origin) @ frame
        under = np.array([*held[:2], low[2]])
        handle, apart = float(held[2] - low[2]), float(np.linalg.norm(grips[1] - grips[0]))
        if not 0.0 <= handle <= size[2]:
            raise ValueError(f"The handles of box '{box.name}' are {handle:.3f} m above its base; it must be from 0 to "
                             f"its height, {size[2]:.3f} m")
    width, depth = 2.0 * np.maximum(high - under, under - low)[:2]
    return BoxShape(float(width), float(depth), float(size[2]), handle, apart, mass, tuple(map(float, -under)),
                    tuple(map(float, (middle - under)[:2])),
                    tuple(tuple(map(float, row)) for row in frame.T @ place.rotation))


def _handle_places(box: bpy.types.Object, handles: Sequence[bpy.types.Object],
                   layer: bpy.types.ViewLayer | None) -> tuple[Array, Array]:
    if len(handles) != 2 or not all(isinstance(item, bpy.types.Object) for item in handles):
        raise ValueError(f"The handles of box '{box.name}' must be two objects, such as Empties parented to it")
    first, second = (placement(item, layer).origin for item in handles)
    if (uneven := abs(float(second[2] - first[2]))) > MAX_UNLEVEL_M:
        raise ValueError(f"The handles of box '{box.name}' differ in height by {uneven:.3f} m; the limit is "
                         f"{MAX_UNLEVEL_M:g} m")
    if (apart := math.dist(first[:2], second[:2])) < 0.02:
        raise ValueError(f"The handles of box '{box.name}' are {apart:.3f} m apart; it must be at least 0.02 m")
    return first, second


def _upright(rotation: Array) -> Array:
    """(3, 3): columns x, y, z of a frame with z up and x along the object's own x, or its y when x stands upright."""
    return _along(rotation[:, 0] if abs(rotation[2, 0]) < 0.75 else rotation[:, 1])


def _along(way: Array) -> Array:
    x, y = way[:2] / math.hypot(*way[:2])
    return np.array([[x, -y, 0.0], [y, x, 0.0], [0.0, 0.0, 1.0]])


def _vertices(box: bpy.types.Object, layer: bpy.types.ViewLayer | None) -> Array:
    """(V, 3) in the object's own axes, as modifiers leave them; of a hidden mesh, as it was modelled."""
    shown = box.evaluated_get((layer or bpy.context.view_layer).depsgraph)
    mesh = shown.data if shown.is_evaluated else box.data
    places = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    if not len(places):
        raise ValueError(f"Box '{box.name}' has no vertices, so it has no size")
    mesh.vertices.foreach_get("co", places)
    return places.reshape(-1, 3).astype(float)


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


def _default_box(hands: str) -> BoxShape:
    (width, depth, height), mass = (_DEFAULT_SIZE, DEFAULT_MASS) if hands == "both" else (ONE_HAND_SIZE, ONE_HAND_MASS)
    return BoxShape(width, depth, height, 0.5 * height, width + 2.0 * _HALF_HAND, mass)


def _placed(skeleton: Skeleton, place: Array) -> Array:
    """A world point in the body frame, without the noise of single precision (a tenth of a micrometre)."""
    return np.round(skeleton.to_body(place), 7) + 0.0


def _in_front(skeleton: Skeleton, shape: BoxShape, hands: str) -> Array:
    """Faraway 2004, p. 546: "a position in front of the body at waist height"."""
    waist = skeleton.to_body(skeleton.joint("l5s1"))
    if hands != "both":
        shoulder = skeleton.to_body(skeleton.joint(f"{hands}_shoulder"))
        return np.array([shoulder[0], waist[1] + 0.2 * skeleton.height, waist[2] - shape.handle_height])
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
