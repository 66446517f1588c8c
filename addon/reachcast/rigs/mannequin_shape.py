# SPDX-License-Identifier: GPL-3.0-or-later
"""The mannequin as plain data: its bones and the closed surface of each bone's segment.

Everything returned is in **figure space**, metres: the Blender object's space, z up, floor at z = 0, the person faces
-y with the left side at +x. It is the body frame (x right, y forward) turned half a turn about z.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from . import mannequin_tables as tables

Posture = Mapping[str, Sequence[float]]
UP, FORWARD, LEFT = np.array([0.0, 0.0, 1.0]), np.array([0.0, -1.0, 0.0]), np.array([1.0, 0.0, 0.0])
SIDES = (("left", ".L"), ("right", ".R"))


@dataclass(frozen=True)
class Bone:
    """A rest bone. `z_hint` is the direction its local z axis is rolled to, so that local x is the hinge."""

    name: str
    parent: str | None
    head: np.ndarray
    tail: np.ndarray
    z_hint: np.ndarray
    connected: bool = False


@dataclass(frozen=True)
class Surface:
    """One or more closed shells with outward faces; `materials` has one index of `tables.MATERIALS` per face."""

    vertices: np.ndarray
    faces: tuple[tuple[int, ...], ...]
    materials: np.ndarray


@dataclass(frozen=True)
class Frame:
    """Axes that a table row is laid out in: `along` carries the length of its unit, the other two are unit vectors."""

    origin: np.ndarray
    along: np.ndarray
    outer: np.ndarray
    front: np.ndarray

    def place(self, points: np.ndarray) -> np.ndarray:
        """Points (..., 3) as (along in units, outer m, front m), in figure space."""
        return self.origin + points @ np.stack([self.along, self.outer, self.front])


def figure_points(posture: Posture) -> dict[str, np.ndarray]:
    """Joint centres from the body frame to figure space."""
    return {name: np.array([-p[0], -p[1], p[2]], dtype=float) for name, p in posture.items()}


def estimated_stature(posture: Posture) -> float:
    """Stature in metres of a person who stands with the nasion at the height it has in the posture."""
    return float(posture["nasion"][2]) / tables.NASION_HEIGHT


def skeleton(posture: Posture, stature: float) -> tuple[Bone, ...]:
    """The bones, parents first. All hinges (knee, elbow, trunk) flex with positive rotation about local x."""
    points = figure_points(posture)
    hips = 0.5 * (points["left_hip"] + points["right_hip"])
    l5s1, c7t1 = points["l5s1"], points["c7t1"]
    ribs, chest = (l5s1 + start * (c7t1 - l5s1) for start in (tables.RIBS_START, tables.CHEST_START))
    skull = points["tragion"]
    crown = np.array([skull[0], skull[1], stature])
    trunk = (
        Bone("hips", None, hips, l5s1, FORWARD),
        Bone("spine", "hips", l5s1, ribs, FORWARD, True),
        Bone("ribs", "spine", ribs, chest, FORWARD, True),
        Bone("chest", "ribs", chest, c7t1, FORWARD, True),
        Bone("neck", "chest", c7t1, skull, FORWARD, True),
        Bone("head", "neck", skull, crown, FORWARD, True),
    )
    return trunk + tuple(bone for side, suffix in SIDES for bone in _limbs(points, side, suffix, stature))


def _limbs(points: Mapping[str, np.ndarray], side: str, suffix: str, stature: float) -> tuple[Bone, ...]:
    """Arm and leg of one side."""
    at = {key.removeprefix(side + "_"): p for key, p in points.items() if key.startswith(side + "_")}
    forward = _unit((at["ball"] - at["ankle"]) * (1.0, 1.0, 0.0))
    tip = at["ball"] + tables.TOE_LENGTH * stature * forward
    chains = (
        ("shoulder", "chest", "clavicle", at["shoulder"], FORWARD),
        ("upper_arm", "shoulder", "shoulder", at["elbow"], FORWARD),
        ("forearm", "upper_arm", "elbow", at["wrist"], FORWARD),
        ("hand", "forearm", "wrist", at["grip"], FORWARD),
        ("thigh", "hips", "hip", at["knee"], -FORWARD),
        ("shin", "thigh", "knee", at["ankle"], -FORWARD),
        ("foot", "shin", "ankle", at["ball"], -UP),
        ("toe", "foot", "ball", tip, -UP),
    )
    return tuple(
        Bone(name + suffix, parent if parent in ("chest", "hips") else parent + suffix, at[start], end, hint,
             parent not in ("chest", "hips"))
        for name, parent, start, end, hint in chains
    )


def surfaces(posture: Posture, stature: float, sex: str | None) -> dict[str, Surface]:
    """The surface of every bone by bone name. `sex` is "female", "male" or None, which lies between the two."""
    bones = skeleton(posture, stature)
    points = figure_points(posture)
    parts: dict[str, list[Surface]] = {bone.name: [] for bone in bones}
    for bone in bones:
        segment = bone.name.partition(".")[0]
        across, deep = _proportions(segment, sex, points, stature)
        scale = 1e-3 * stature * np.array([across, deep])
        for row in (*tables.LOFTS, *tables.TUBES, *tables.BALLS):
            if row.segment == segment:
                parts[bone.name] += [_shell(row, frame, scale) for frame in _frames(row, bone, points, stature)]
    return {name: _joined(shells) for name, shells in parts.items()}


def _proportions(segment: str, sex: str | None, points: Mapping[str, np.ndarray],
                 stature: float) -> tuple[float, float]:
    """How much wider and deeper than the tables a segment is; the trunk follows its joints where they are unusual."""
    weight = {"female": 1.0, "male": 0.0}.get((sex or "").lower(), 0.5)
    across, deep = (1.0 + weight * (factor - 1.0) for factor in tables.FEMALE[segment])
    if segment in tables.JOINT_WIDTHS:
        joint, usual = tables.JOINT_WIDTHS[segment]
        across *= np.clip(abs(points[f"left_{joint}"][0]) / (usual * stature), 0.85, 1.15)
    return float(across), float(deep)


# ---- frames ---------------------------------------------------------------------------------------------------------

def _frames(row: tables.Loft | tables.Tube | tables.Ball, bone: Bone, points: Mapping[str, np.ndarray],
            stature: float) -> list[Frame]:
    """The frame a row asks for, and its mirror image when the row is meant for both sides."""
    outward = -LEFT if bone.name.endswith(".R") else LEFT
    if row.frame == "trunk":
        low, high = (0.5 * (points[f"left_{j}"] + points[f"right_{j}"]) for j in ("hip", "shoulder"))
        frame = _frame(low, high - low, FORWARD, outward)
    elif row.frame == "head":
        chin = np.array([bone.head[0], bone.head[1], tables.CHIN_HEIGHT * stature])
        frame = _frame(chin, UP * (stature - chin[2]), FORWARD, outward)
    elif row.frame == "hand":
        frame = _frame(bone.head, _unit(bone.tail - bone.head) * tables.HAND_LENGTH * stature, FORWARD, outward)
    elif row.frame == "clavicle":
        root = np.array([bone.head[0], bone.tail[1], bone.tail[2]])
        frame = _frame(root, bone.tail - root, FORWARD, UP)
    elif row.frame == "floor":
        level = np.array([1.0, 1.0, 0.0])
        frame = _frame(bone.head * level, (bone.tail - bone.head) * level, UP, outward)
    else:
        frame = _frame(bone.head, bone.tail - bone.head, FORWARD, outward)
    both = isinstance(row, tables.Ball) and row.both
    return [frame, Frame(frame.origin, frame.along, -frame.outer, frame.front)] if both else [frame]


def _frame(origin: np.ndarray, along: np.ndarray, front: np.ndarray, outward: np.ndarray) -> Frame:
    """Axes at right angles: `along` as given, `front` nearest to its hint, `outer` on the given side."""
    axis = _unit(along)
    front = _unit(front - axis * (front @ axis))
    outer = np.cross(axis, front)
    return Frame(origin, along, outer if outer @ outward > 0.0 else -outer, front)


def _unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.linalg.norm(vector)


# ---- shells ---------------------------------------------------------------------------------------------------------

def _shell(row: tables.Loft | tables.Tube | tables.Ball, frame: Frame, scale: np.ndarray) -> Surface:
    """One closed shell; `scale` is metres per table unit across and in depth."""
    unit = float(np.linalg.norm(frame.along))
    if isinstance(row, tables.Loft):
        rings = _loft_rings(row, scale, unit)
    elif isinstance(row, tables.Tube):
        rings = _tube_rings(row, scale, unit)
    else:
        rings = _ball_rings(row, scale, unit)
    rings = frame.place(rings)
    if row.frame == "floor":
        rings[..., 2] = np.maximum(rings[..., 2], 0.0)
    return _closed(rings, row.material)


def _loft_rings(row: tables.Loft, scale: np.ndarray, unit: float) -> np.ndarray:
    """Rings (n, sides, 3) of superellipses through the stations, the first and last shrunk to a point."""
    stations = np.array([station + (0.0,) * (9 - len(station)) for station in row.stations])
    stations = _through(stations[:, 0], stations, 2)
    along, outer, inner, front, back, power, centre_outer, centre_front, arch = stations.T[..., None]
    angle = 2.0 * np.pi * np.arange(row.sides) / row.sides
    cosine, sine = np.cos(angle), np.sin(angle)
    across = np.where(cosine > 0.0, outer - centre_outer, inner + centre_outer)
    deep = np.where(sine > 0.0, front - centre_front, back + centre_front)
    across = across * np.sign(cosine) * np.abs(cosine) ** (2.0 / power)
    deep = deep * np.sign(sine) * np.abs(sine) ** (2.0 / power)
    raised = along + arch * np.maximum(sine, 0.0) ** 2 * scale.mean() / unit
    rings = np.stack([raised, scale[0] * (centre_outer + across),
                      scale[1] * (centre_front + deep)], axis=-1)
    middle = np.concatenate([along, scale[0] * centre_outer, scale[1] * centre_front], axis=-1)
    reach = np.array(row.caps) * scale.mean() / unit
    if crown := row.caps[1] == 0.0:  # the last cap is shallow and ends exactly where the frame does
        reach[1] = 1.0 - stations[-1, 0]
    first = _cap(rings[0], middle[0], np.array([-reach[0], 0.0, 0.0]), fine=row.caps[0] > 15)
    last = _cap(rings[-1], middle[-1], np.array([reach[1], 0.0, 0.0]), fine=crown or row.caps[1] > 15, shallow=crown)
    return np.concatenate([first[::-1], rings, last])


def _cap(ring: np.ndarray, middle: np.ndarray, rise: np.ndarray, fine: bool = False,
         shallow: bool = False) -> np.ndarray:
    """Rings from `ring` (left out) to a point `rise` away from `middle`: a dome, or a shallow parabola."""
    angle = np.linspace(0.0, 0.5 * np.pi, 6 if fine else 4)[1:, None, None]
    shrink = np.cos(angle).round(12)
    lift = 1.0 - shrink**2 if shallow else np.sin(angle)
    return middle + (ring - middle) * shrink + rise * lift


def _tube_rings(row: tables.Tube, scale: np.ndarray, unit: float) -> np.ndarray:
    """Round rings at right angles to a curved path, with domes of the end radii."""
    points = np.array(row.points, dtype=float) * (1.0, *scale)
    step = np.linalg.norm(np.diff(points * (unit, 1.0, 1.0), axis=0), axis=1)
    fine = _through(np.concatenate([[0.0], np.cumsum(step)]), np.column_stack([points, row.radii]), 2)
    path, radius = fine[:, :3] * (unit, 1.0, 1.0), fine[:, 3, None] * scale.mean()
    tangent = np.gradient(path, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    first = np.cross(tangent, (0.0, 1.0, 0.0))
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    second = np.cross(tangent, first)
    angle = 2.0 * np.pi * np.arange(row.sides)[:, None] / row.sides
    rings = np.array([p + r * (np.cos(angle) * a + np.sin(angle) * b)
                      for p, r, a, b in zip(path, radius, first, second)])
    start, end = _cap(rings[0], path[0], -radius[0] * tangent[0]), _cap(rings[-1], path[-1], radius[-1] * tangent[-1])
    return np.concatenate([start[::-1], rings, end]) / (unit, 1.0, 1.0)


def _ball_rings(row: tables.Ball, scale: np.ndarray, unit: float) -> np.ndarray:
    """Rings of an ellipsoid from pole to pole."""
    polar = np.linspace(0.0, np.pi, 10)[:, None]
    angle = 2.0 * np.pi * np.arange(16) / 16
    sine = np.sin(polar).round(12)
    sphere = np.stack(np.broadcast_arrays(-np.cos(polar), sine * np.cos(angle), sine * np.sin(angle)), axis=-1)
    size = np.array([scale.mean() / unit, *scale])
    return np.array(row.centre) * (1.0, *scale) + sphere * row.radii * size


def _through(at: np.ndarray, rows: np.ndarray, steps: int) -> np.ndarray:
    """Rows interpolated without overshoot (Fritsch and Carlson's monotone cubic), `steps` pieces per interval."""
    width = np.diff(at)[:, None]
    slope = np.diff(rows, axis=0) / width
    left, right = slope[:-1], slope[1:]
    with np.errstate(divide="ignore", invalid="ignore"):
        harmonic = 2.0 * left * right / (left + right)
    inner = np.where(left * right > 0.0, harmonic, 0.0)
    tangent = np.concatenate([slope[:1], inner, slope[-1:]])
    u = (np.arange(steps) / steps)[:, None, None]
    fine = ((1 + 2 * u) * (1 - u) ** 2 * rows[:-1] + u**2 * (3 - 2 * u) * rows[1:]
            + u * (1 - u) ** 2 * width * tangent[:-1] - u**2 * (1 - u) * width * tangent[1:])
    return np.concatenate([fine.swapaxes(0, 1).reshape(-1, rows.shape[1]), rows[-1:]])


# ---- faces ----------------------------------------------------------------------------------------------------------

def _closed(rings: np.ndarray, material: int) -> Surface:
    """A surface from rings whose first and last have shrunk to one point each, faces outward."""
    count, sides = len(rings) - 2, rings.shape[1]
    vertices = np.concatenate([rings[:1, 0], rings[1:-1].reshape(-1, 3), rings[-1:, 0]])
    last = len(vertices) - 1
    here = np.arange(sides)
    after = (here + 1) % sides
    faces = [(0, 1 + b, 1 + a) for a, b in zip(here, after)]
    for row in range(count - 1):
        base = 1 + row * sides
        faces += [(base + a, base + b, base + sides + b, base + sides + a) for a, b in zip(here, after)]
    base = 1 + (count - 1) * sides
    faces += [(base + a, base + b, last) for a, b in zip(here, after)]
    if signed_volume(vertices, faces) < 0.0:
        faces = [face[::-1] for face in faces]
    faces = [tuple(int(i) for i in face) for face in faces]
    return Surface(vertices, tuple(faces), np.full(len(faces), material))


def signed_volume(vertices: np.ndarray, faces: Sequence[Sequence[int]]) -> float:
    """Enclosed volume in m^3, positive when the faces wind outward."""
    corners = np.array([(f[0], f[i], f[i + 1]) for f in faces for i in range(1, len(f) - 1)])
    a, b, c = vertices[corners].swapaxes(0, 1)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def _joined(shells: Sequence[Surface]) -> Surface:
    """All shells of a segment as one surface."""
    starts = np.cumsum([0] + [len(shell.vertices) for shell in shells])
    vertices = np.concatenate([shell.vertices for shell in shells])
    faces = tuple(tuple(i + int(start) for i in face) for shell, start in zip(shells, starts) for face in shell.faces)
    materials = np.concatenate([shell.materials for shell in shells])
    return Surface(vertices, faces, materials)
