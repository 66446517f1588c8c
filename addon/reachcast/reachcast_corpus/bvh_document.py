# SPDX-License-Identifier: GPL-3.0-or-later
"""The text of a BVH file: a tree of joints at rest, and how each turns over time."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class BvhJoint:
    """Offsets in metres along the file's axes."""

    name: str
    parent: int | None          #: position in the list; the root, which stands first, has none
    offset: np.ndarray          #: (3,) at rest, from the parent
    end: np.ndarray             #: (3,) at rest, of the End Site where there are no children
    turns: np.ndarray           #: (frames, 3, 3): from rest, in the world


def bvh_document(joints: Sequence[BvhJoint], root_places: np.ndarray, rate: float) -> str:
    """joints: parents before children. root_places: (frames, 3), metres. rate: frames per second.

    The root alone is moved; each joint is keyed with its turn against its parent, as angles about z, x and y.
    """
    lines, columns = ["HIERARCHY"], [root_places]
    _write(joints, 0, 0, lines, columns)
    lines += ["MOTION", f"Frames: {len(root_places)}", f"Frame Time: {1.0 / rate:.9f}"]
    lines += [_numbers(row) for row in np.concatenate(columns, axis=1).tolist()]
    return "\n".join(lines) + "\n"


def _write(joints: Sequence[BvhJoint], number: int, depth: int, lines: list[str], columns: list[np.ndarray]) -> None:
    """The joint and all below it, in the order in which their angles stand in the columns."""
    joint, tab = joints[number], "  " * depth
    is_root = joint.parent is None
    places = "Xposition Yposition Zposition " if is_root else ""
    lines += [f"{tab}{'ROOT' if is_root else 'JOINT'} {joint.name}", f"{tab}{{",
              f"{tab}  OFFSET {_numbers(joint.offset)}",
              f"{tab}  CHANNELS {6 if is_root else 3} {places}Zrotation Xrotation Yrotation"]
    above = None if is_root else np.swapaxes(joints[joint.parent].turns, 1, 2)
    columns.append(_zxy_degrees(joint.turns if above is None else above @ joint.turns))
    children = [child for child, other in enumerate(joints) if other.parent == number]
    for child in children:
        _write(joints, child, depth + 1, lines, columns)
    if not children:
        lines += [f"{tab}  End Site", f"{tab}  {{", f"{tab}    OFFSET {_numbers(joint.end)}", f"{tab}  }}"]
    lines.append(f"{tab}}}")


def _numbers(values: Sequence[float]) -> str:
    return " ".join(f"{value:.6f}" for value in values)


def _zxy_degrees(turns: np.ndarray) -> np.ndarray:
    """(frames, 3): z, x, y of turn = Rz Rx Ry, without jumps of a whole turn."""
    x = np.arcsin(np.clip(turns[:, 2, 1], -1.0, 1.0))
    z = np.arctan2(-turns[:, 0, 1], turns[:, 1, 1])
    y = np.arctan2(-turns[:, 2, 0], turns[:, 2, 2])
    return np.degrees(np.unwrap(np.stack([z, x, y], axis=1), axis=0))
