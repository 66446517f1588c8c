# SPDX-License-Identifier: GPL-3.0-or-later
"""Proportions of the mannequin: nothing but numbers, so that its looks can be tuned without touching code.

A *station* is one cross-section of a segment, eight or nine numbers:

    along  outer  inner  front  back  power  centre_outer  centre_front  [arch]

`along` is measured in the length of the segment's frame (see `mannequin_shape.Frame`), everything else but the power
in thousandths of stature from the segment's axis. `outer` points away from the midline (for the trunk: to the left),
`inner` is its opposite; `front` is where the person looks, on a foot it is up. A negative extent lies beyond the axis.
`power` is the exponent of the superellipse: 2 is an ellipse, 3 is boxy. The centre is where the section is widest.
`arch` moves the middle of the section's front along the axis: a rib cage opens upward, a waistband dips.
"""

from __future__ import annotations

from typing import NamedTuple

BODY, JOINT, ACCENT = 0, 1, 2
MATERIALS = (  # name, linear RGB, roughness; in the order of the three indices above
    ("Reachcast Mannequin Body", (0.58, 0.62, 0.66), 0.55),
    ("Reachcast Mannequin Joint", (0.035, 0.045, 0.06), 0.5),
    ("Reachcast Mannequin Accent", (0.80, 0.22, 0.035), 0.5),
)

Row = tuple[float, ...]


class Loft(NamedTuple):
    """A closed tube through stations; `caps` are the heights of its rounded ends, thousandths of stature."""

    segment: str
    frame: str
    material: int
    caps: tuple[float, float]
    stations: tuple[Row, ...]
    sides: int = 20


class Tube(NamedTuple):
    """A closed round tube along points (along, outer, front), with one radius per point, thousandths of stature."""

    segment: str
    frame: str
    material: int
    points: tuple[Row, ...]
    radii: tuple[float, ...]
    sides: int = 8


class Ball(NamedTuple):
    """An ellipsoid: centre (along, outer, front) and radii along, outward and forward in thousandths of stature.

    `both` repeats it on the other side of a midline segment.
    """

    segment: str
    frame: str
    material: int
    centre: Row
    radii: Row
    both: bool = False


LOFTS = (
    # trunk: along runs from the midpoint of the hips (0) to the midpoint of the shoulders (1)
    Loft("hips", "trunk", BODY, (9, 10), (
        (-0.150, 15, 15, 20, 24, 2.2, 0, -4),
        (-0.090, 38, 38, 40, 50, 2.3, 0, -4),
        (0.000, 72, 72, 52, 65, 2.3, 0, -6),
        (0.090, 85, 85, 55, 64, 2.3, 0, -6),
        (0.170, 84, 84, 55, 55, 2.3, 0, -2, -8),
        (0.235, 78, 78, 53, 48, 2.3, 0, 0, -22)), 28),
    Loft("spine", "trunk", JOINT, (20, 24), (
        (0.090, 66, 66, 44, 44, 2.3, 0, 0),
        (0.260, 70, 70, 50, 42, 2.2, 0, 0),
        (0.380, 69, 69, 51, 42, 2.2, 0, 0),
        (0.480, 70, 70, 52, 43, 2.2, 0, 0),
        (0.560, 62, 62, 46, 40, 2.2, 0, 0)), 28),
    # the ribs slide under the chest when the back bends
    Loft("ribs", "trunk", BODY, (9, 16), (
        (0.420, 77, 77, 57, 50, 2.3, 0, 0, 34),
        (0.530, 84, 84, 64, 57, 2.3, 0, 0, 16),
        (0.640, 87, 87, 66, 59, 2.3, 0, 0),
        (0.740, 82, 82, 60, 58, 2.3, 0, -2)), 28),
    Loft("chest", "trunk", BODY, (7, 2), (
        (0.610, 88, 88, 68, 60, 2.4, 0, 0, 14),
        (0.700, 92, 92, 70, 64, 2.4, 0, 0),
        (0.820, 96, 96, 66, 68, 2.4, 0, -4),
        (0.930, 94, 94, 51, 68, 2.3, 0, -10),
        (1.010, 83, 83, 36, 61, 2.2, 0, -14),
        (1.060, 65, 65, 26, 54, 2.0, 0, -14),
        (1.110, 45, 45, 20, 45, 2.0, 0, -12),
        (1.150, 36, 36, 17, 38, 2.0, 0, -10),
        (1.190, 32, 32, 15, 33, 2.0, 0, -9)), 28),
    Loft("neck", "bone", JOINT, (6, 10), (
        (0.000, 32, 32, 42, 20, 2.0, 0, 10),
        (0.250, 31, 31, 38, 22, 2.0, 0, 8),
        (0.550, 29.5, 29.5, 34, 26, 2.0, 0, 4),
        (0.950, 29, 29, 26, 30, 2.0, 0, 0))),
    # head: along runs from the chin (0) to the crown (1)
    Loft("head", "head", BODY, (5, 0), (
        (0.040, 17, 17, 46, -4, 2.1, 0, 25),
        (0.110, 26, 26, 53, 6, 2.3, 0, 24),
        (0.220, 34, 34, 52, 20, 2.4, 0, 14),
        (0.340, 39, 39, 52, 38, 2.4, 0, 6),
        (0.460, 42, 42, 47.5, 49, 2.4, 0, 0),
        (0.560, 43.5, 43.5, 53, 54, 2.3, 0, -2),
        (0.700, 44, 44, 52, 56, 2.2, 0, -4),
        (0.820, 38.5, 38.5, 45, 51, 2.1, 0, -4),
        (0.900, 31, 31, 36, 42, 2.0, 0, -4),
        (0.950, 22.5, 22.5, 26, 32, 2.0, 0, -4),
        (0.980, 14.5, 14.5, 16, 22, 2.0, 0, -4)), 28),
    Loft("head", "head", BODY, (3, 3), (
        (0.280, 7.5, 7.5, 57, -44, 2.0, 0, 50),
        (0.320, 8.5, 8.5, 62, -42, 2.0, 0, 50),
        (0.400, 5.5, 5.5, 56.5, -40, 2.0, 0, 48),
        (0.520, 4.5, 4.5, 51.5, -40, 2.0, 0, 46)), 12),
    # arms
    Loft("shoulder", "clavicle", JOINT, (4, 8), (
        (0.350, -2, 16, -2, 18, 2.0, -8, -10),
        (0.600, 10, 24, 10, 27, 2.0, 0, -6),
        (0.820, 19, 24, 20, 27, 2.0, 0, -2),
        (1.000, 20, 21, 22, 23, 2.0, 0, 0))),
    Loft("upper_arm", "bone", BODY, (26, 8), (
        (0.000, 27, 25, 29, 29, 2.0, 0, 0),
        (0.100, 30.5, 25, 32, 31, 2.0, 0, 0),
        (0.240, 31, 25, 30, 30, 2.0, 0, 0),
        (0.480, 24, 23, 29, 26, 2.0, 0, 2),
        (0.780, 20, 20, 22, 22, 2.0, 0, 0),
        (0.920, 19, 20, 20, 21, 2.0, 0, 0))),
    Loft("forearm", "bone", BODY, (8, 5), (
        (0.100, 22, 21, 23, 22, 2.0, 0, 0),
        (0.280, 24, 23, 25, 24, 2.0, 0, 0),
        (0.600, 19, 18, 21, 20, 2.0, 0, 0),
        (0.950, 13, 12.5, 17, 16, 2.0, 0, 0))),
    # hand: along runs from the wrist over a hand length; inner is the palm, front the thumb
    Loft("hand", "hand", ACCENT, (4, 5), (
        (0.050, 12, 11, 14, 14, 2.3, 0, 0),
        (0.180, 14, 8, 21, 19, 2.5, 3, 0),
        (0.360, 16, 0, 24, 22, 2.6, 7, 0),
        (0.500, 16.5, -1, 23.5, 21.5, 2.6, 8, 0))),
    # legs
    Loft("thigh", "bone", BODY, (42, 10), (
        (0.000, 49, 42, 46, 50, 2.1, 0, 0),
        (0.140, 51, 44, 50, 51, 2.1, 0, 0),
        (0.380, 45, 41, 50, 44, 2.1, 0, 2),
        (0.680, 34, 34, 40, 33, 2.0, 0, 2),
        (0.860, 29, 30, 32, 29, 2.0, 0, 0),
        (0.940, 28, 28, 30, 28, 2.0, 0, 0)), 22),
    Loft("shin", "bone", BODY, (10, 6), (
        (0.070, 27, 26, 30, 28, 2.0, 0, 0),
        (0.180, 30, 29, 28, 36, 2.0, 0, -4),
        (0.320, 32, 30, 26, 42, 2.0, 0, -6),
        (0.550, 25, 23, 23, 33, 2.0, 0, -5),
        (0.800, 17, 17, 19, 22, 2.0, 0, 0),
        (0.940, 17, 17, 19, 21, 2.0, 0, 0))),
    # foot: along runs over the floor from below the ankle (0) to below the ball (1); front is up
    Loft("foot", "floor", ACCENT, (8, 11), (
        (-0.430, 11, 11, 32, -4, 2.2, 0, 16),
        (-0.290, 17, 16, 43, -3, 2.4, 0, 15),
        (-0.050, 20, 19, 49, -3, 2.4, 0, 15),
        (0.180, 20, 19, 47, -3, 2.4, 0, 14),
        (0.450, 22, 19, 38, -3, 2.4, 0, 12),
        (0.750, 26, 22, 30, -3, 2.4, 0, 11),
        (1.000, 27.5, 23.5, 26, -3, 2.4, 0, 11)), 20),
    Loft("foot", "floor", JOINT, (8, 6), (
        (-0.450, 13, 13, 9, 3, 3.0, 0, 5),
        (-0.240, 19, 18, 9, 3, 3.0, 0, 5),
        (0.350, 20, 16, 9, 3, 3.0, 0, 5),
        (0.750, 27, 23, 9, 3, 3.0, 0, 5),
        (1.000, 29, 25, 9, 3, 3.0, 0, 5)), 16),
    # toe: along runs over the floor from below the ball (0) to the tip (1)
    Loft("toe", "floor", ACCENT, (11, 9), (
        (0.000, 27, 23, 25.5, -3, 2.4, 0, 11),
        (0.350, 25, 23.5, 24, -3, 2.5, 0, 10),
        (0.720, 18, 21, 19.5, -3, 2.4, 1, 9)), 20),
    Loft("toe", "floor", JOINT, (6, 8), (
        (0.000, 28.5, 24.5, 9, 3, 3.0, 0, 5),
        (0.350, 27, 25, 9, 3, 3.0, 0, 5),
        (0.780, 19, 22, 9, 3, 3.0, 1, 5)), 16),
)

# Fingertips, thumb and palm end in the plane of the grip: a box held from its sides touches them all.
TUBES = (
    Tube("hand", "hand", ACCENT, ((0.48, 8, 17), (0.65, 12, 18), (0.80, 11, 17), (0.92, 4.5, 16)), (6, 5.6, 5.2, 4.4)),
    Tube("hand", "hand", ACCENT, ((0.48, 8, 6), (0.67, 14, 6), (0.85, 12, 6), (0.98, 4.5, 5)), (6, 5.8, 5.3, 4.5)),
    Tube("hand", "hand", ACCENT, ((0.48, 8, -5), (0.65, 13, -5), (0.82, 11, -5), (0.94, 4, -5)), (6, 5.6, 5.2, 4.4)),
    Tube("hand", "hand", ACCENT, ((0.47, 8, -15), (0.61, 12, -16), (0.74, 10, -16), (0.84, 4, -15)), (5.4, 5, 4.6, 4)),
    Tube("hand", "hand", ACCENT, ((0.12, 5, 9), (0.30, 6, 24), (0.45, 5, 33), (0.58, 3.5, 37)), (8, 7.5, 6.2, 5)),
)

BALLS = (
    Ball("head", "head", BODY, (0.44, 43, -6), (15, 5, 9), True),
    Ball("upper_arm", "bone", JOINT, (1.0, 0, 0), (20.5, 20.5, 20.5)),
    Ball("forearm", "bone", JOINT, (1.0, 0, 0), (13, 12.5, 15)),
    Ball("thigh", "bone", JOINT, (1.0, 0, 0), (28.5, 28.5, 29.5)),
    Ball("shin", "bone", JOINT, (1.0, 0, 0), (18, 18, 19)),
)

# Multiples of the extents across and in depth, by sex and segment. The tables above are the male figure.
FEMALE = {
    "hips": (0.98, 0.98), "spine": (0.89, 0.93), "ribs": (0.98, 0.94), "chest": (1.01, 0.95), "neck": (0.84, 0.88), "head": (0.98, 0.98),
    "shoulder": (0.86, 0.86), "upper_arm": (0.87, 0.88), "forearm": (0.87, 0.88), "hand": (0.90, 0.90),
    "thigh": (1.02, 1.02), "shin": (0.96, 0.97), "foot": (0.93, 0.95), "toe": (0.93, 0.95),
}

# Skeleton lengths that no joint centre tells, in statures.
CHIN_HEIGHT = 0.870
NASION_HEIGHT = 0.934
RIBS_START, CHEST_START = 0.28, 0.55  # of the way from l5s1, where the spine starts, to c7t1
TOE_LENGTH = 0.042
HAND_LENGTH = 0.108

# Joints whose half distance widens a segment, and the distance in statures that the tables were drawn for.
JOINT_WIDTHS = {"hips": ("hip", 0.050), "ribs": ("shoulder", 0.107), "chest": ("shoulder", 0.107)}
