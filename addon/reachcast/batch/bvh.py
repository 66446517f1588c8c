# SPDX-License-Identifier: GPL-3.0-or-later
"""A posed rig as BVH: the rest pose as offsets, every bone's turn against the bone above it."""
from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..rigs.rotations import Array
from ..rigs.skeleton import Skeleton

_AXES = "ZXY"


def write_bvh(path: Path, skeleton: Skeleton, pose: Any, frame_rate: float) -> None:
    """Metres, z up, world axes in rest: a bone's offset is from the head of the bone above. Only the root is moved.

    ValueError when a bone is moved off its place on the bone above, which this form cannot say.
    """
    turns, heads = np.asarray(pose.turns), np.asarray(pose.heads)          # (K, F, 3, 3), (K, F, 3)
    keyed, bones = list(pose.keyed), skeleton.bones
    pelvis = skeleton.segments["pelvis"]
    shown = [bone for bone in bones.family({pelvis}) if bone in keyed]     # what is above the pelvis does not move
    row = {bone: keyed.index(bone) for bone in shown}
    lines = ["HIERARCHY"]
    columns: list[Array] = [heads[row[pelvis]]]
    _describe(bones, pelvis, shown, 0, lines)
    for bone in _depth_first(bones, pelvis, shown):
        turn = turns[row[bone]]
        if bone != pelvis:
            above = bones.parents[bone]
            back = np.swapaxes(turns[row[above]], 1, 2)
            carried = (back @ (heads[row[bone]] - heads[row[above]])[..., None])[..., 0]
            if (off := float(np.abs(carried - (bones.heads[bone] - bones.heads[above])).max())) > 1e-3:
                raise ValueError(f"Bone '{bones.names[bone]}' moves {1000 * off:.1f} mm on the bone above it, which BVH "
                                 f"cannot say; the limit is 1 mm")
            turn = back @ turn
        columns.append(_zxy_degrees(turn))
    table = np.concatenate(columns, axis=1)
    lines += ["MOTION", f"Frames: {len(table)}", f"Frame Time: {1.0 / frame_rate:.9f}"]
    lines += [" ".join(f"{value:.6f}" for value in values) for values in table.tolist()]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _depth_first(bones: Any, bone: int, shown: list[int]):  # type: ignore[no-untyped-def]
    yield bone
    for child in shown:
        if bones.parents[child] == bone:
            yield from _depth_first(bones, child, shown)


def _describe(bones: Any, bone: int, shown: list[int], depth: int, lines: list[str]) -> None:
    tab, is_root = "  " * depth, depth == 0
    offset = np.zeros(3) if is_root else bones.heads[bone] - bones.heads[bones.parents[bone]]
    channels = [f"{axis}rotation" for axis in _AXES]
    if is_root:
        channels = ["Xposition", "Yposition", "Zposition", *channels]
    lines += [f"{tab}{'ROOT' if is_root else 'JOINT'} {bones.names[bone].replace(' ', '_')}", f"{tab}{{",
              f"{tab}  OFFSET {_numbers(offset)}", f"{tab}  CHANNELS {len(channels)} {' '.join(channels)}"]
    children = [child for child in shown if bones.parents[child] == bone]
    for child in children:
        _describe(bones, child, shown, depth + 1, lines)
    if not children:
        lines += [f"{tab}  End Site", f"{tab}  {{", f"{tab}    OFFSET {_numbers(bones.tails[bone] - bones.heads[bone])}",
                  f"{tab}  }}"]
    lines.append(f"{tab}}}")


def _numbers(values: Array) -> str:
    return " ".join(f"{value:.6f}" for value in values)


def _zxy_degrees(turn: Array) -> Array:
    """(F, 3): z, x, y of turn = Rz Rx Ry."""
    x = np.arcsin(np.clip(turn[:, 2, 1], -1.0, 1.0))
    z = np.arctan2(-turn[:, 0, 1], turn[:, 1, 1])
    y = np.arctan2(-turn[:, 2, 0], turn[:, 2, 2])
    return np.degrees(np.stack([z, x, y], axis=1))
