# SPDX-License-Identifier: GPL-3.0-or-later
"""The readers of reachcast_core against independent ones: BVH by 4x4 matrices in numpy, CSV by Python's csv module.

Plain pytest, no Blender: /usr/bin/python3 -m pytest blender_tests/test_mocap_readers.py
Recordings are looked for in $REACHCAST_MOCAP, else in ../shared/mocap beside the project; without them tests skip.
"""

import csv
import math
import struct

import numpy as np
import pytest
from mocap_cases import files_in, need, need_file, rc

# Joint centres agree to rounding: about ten products of rotations, relative to the farthest coordinate.
RELATIVE = 1e-9
MOST_FRAMES = 60  # per file; matrices in Python are slow


# ---------------------------------------------------------------- BVH, the slow and plain way


def naive_skeleton(words):
    """A recursive-descent reading of HIERARCHY: nodes as dicts in file order, and the words that follow."""
    nodes = []

    def node(at, name, parent):
        assert words[at] == "{"
        me = {"name": name, "parent": parent, "channels": []}
        nodes.append(me)
        at += 1
        while words[at] != "}":
            if words[at] == "OFFSET":
                me["offset"] = [float(w) for w in words[at + 1 : at + 4]]
                at += 4
            elif words[at] == "CHANNELS":
                count = int(words[at + 1])
                me["channels"] = words[at + 2 : at + 2 + count]
                at += 2 + count
            elif words[at] == "JOINT":
                at = node(at + 2, words[at + 1], me)
            elif words[at] == "End":
                at = node(at + 2, name + "_end", me)
            else:
                raise AssertionError(words[at])
        return at + 1

    assert words[:2] == ["HIERARCHY", "ROOT"]
    return nodes, node(3, words[2], None)


def translation(vector):
    matrix = np.eye(4)
    matrix[:3, 3] = vector
    return matrix


def rotation(axis, degrees):
    """Rodrigues' formula about a coordinate axis."""
    k = {"X": (1, 0, 0), "Y": (0, 1, 0), "Z": (0, 0, 1)}[axis]
    cross = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]], float)
    angle = math.radians(degrees)
    matrix = np.eye(4)
    matrix[:3, :3] += math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross
    return matrix


def naive_bvh(path):
    """(nodes, values (F, channels), frame time) with numbers read by float()."""
    head, _, tail = path.read_text().partition("MOTION")
    nodes, _ = naive_skeleton(head.split())
    lines = [line.split() for line in tail.splitlines() if line.strip()]
    assert lines[0][0] == "Frames:" and lines[1][:2] == ["Frame", "Time:"]
    return nodes, np.array([[float(w) for w in line] for line in lines[2:]]), float(lines[1][2])


def naive_positions(nodes, values):
    """(joints, 3): world matrices of one frame, file axes and units."""
    values = iter(values)
    for node in nodes:
        place, turn = list(node["offset"]), np.eye(4)
        for channel in node["channels"]:
            value = next(values)
            if channel.endswith("position"):
                place["XYZ".index(channel[0])] = value
            else:
                turn = turn @ rotation(channel[0], value)
        above = np.eye(4) if node["parent"] is None else node["parent"]["world"]
        node["world"] = above @ translation(place) @ turn
    return np.array([node["world"][:3, 3] for node in nodes])


@pytest.mark.parametrize("path", files_in("bvh", "*.bvh"), ids=lambda path: path.stem)
def test_bvh_joint_centres_agree_with_matrices(path):
    need_file(path)
    nodes, values, frame_time = naive_bvh(path)
    clip = rc.read_motion(str(path), metres_per_unit=1.0, up="z")
    assert clip.positions.shape == (len(values), len(nodes), 3)
    assert clip.rate == pytest.approx(1 / frame_time, rel=1e-12)
    assert clip.names == [node["name"] for node in nodes]
    frames = np.unique(np.linspace(0, len(values) - 1, MOST_FRAMES).astype(int))
    expected = np.array([naive_positions(nodes, values[frame]) for frame in frames])
    assert np.abs(clip.positions[frames] - expected).max() <= RELATIVE * np.abs(expected).max()


@pytest.mark.parametrize("path", files_in("bvh", "*.bvh"), ids=lambda path: path.stem)
def test_bvh_bones_keep_their_length(path):
    need_file(path)
    nodes, _, _ = naive_bvh(path)
    points = rc.read_motion(str(path), metres_per_unit=1.0).positions
    scale = np.abs(points).max()
    for i, node in enumerate(nodes):
        if node["parent"] is None:
            continue
        lengths = np.linalg.norm(points[:, i] - points[:, nodes.index(node["parent"])], axis=1)
        assert lengths == pytest.approx(np.linalg.norm(node["offset"]), abs=RELATIVE * scale)


def test_bvh_up_and_unit_turn_and_scale():
    path = need("bvh") / "walk01.bvh"
    raw = rc.read_motion(str(path), metres_per_unit=1.0, up="z").positions
    clip = rc.read_motion(str(path))
    assert (clip.up, clip.metres_per_unit) == ("y", 0.01)
    turned = np.stack([raw[..., 0], -raw[..., 2], raw[..., 1]], -1)
    np.testing.assert_allclose(clip.positions, 0.01 * turned, rtol=1e-14)


def test_z_up_file_is_recognised():
    assert rc.read_motion(str(need("bvh") / "xzy_order.bvh")).up == "z"


def test_wrong_frame_count_is_noticed():
    clip = rc.read_motion(str(need("bvh") / "boxing_toes_wrong_frame_count.bvh"))
    assert len(clip) == 3070
    assert "3069" in clip.note


@pytest.mark.parametrize("lost", [40, 400])
def test_truncated_last_line_is_an_error_with_its_line(tmp_path, lost):
    text = (need("bvh") / "walk01.bvh").read_text().rstrip()[:-lost]
    short = tmp_path / "short.bvh"
    short.write_text(text)
    line = text.count("\n") + 1
    with pytest.raises(ValueError, match=rf"short\.bvh:{line}: expected \d+ numbers in a frame, found only \d+"):
        rc.read_motion(str(short))


def test_skeleton_of_no_human_size_asks_for_the_unit():
    path = need("bvh") / "full_precision_frame_time.bvh"
    with pytest.raises(ValueError, match="give metres_per_unit"):
        rc.read_motion(str(path))
    assert rc.read_motion(str(path), metres_per_unit=0.1).rate == pytest.approx(1 / 0.0417083750417)


# ---------------------------------------------------------------- CSV


def naive_csv(path):
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    return rows[0], np.array([[float(cell) if cell.strip() else math.nan for cell in row] for row in rows[1:]])


CSV_FILES = [
    *files_in("omomo", "sub*.csv")[::8],
    *files_in("lieblich_lifting", "S*.csv")[::5],
    *files_in("becanovic_box_lifting/trials", "*.csv")[::15],
    *files_in("roag_wall_reaching", "*.csv")[::2],
]


@pytest.mark.parametrize("path", CSV_FILES, ids=lambda path: path.stem)
def test_csv_values_agree_with_the_csv_module(path):
    need_file(path)
    header, table = naive_csv(path)
    clip = rc.read_motion(str(path), metres_per_unit=1.0, up="z")
    used = set()
    for joint, name in enumerate(clip.names):
        columns = [header.index(f"{name}_{axis}") for axis in "xyz"]
        used.update(columns)
        np.testing.assert_array_equal(clip.positions[:, joint], table[:, columns])
    assert {header[i] for i in range(len(header)) if i not in used} == set(clip.channels)
    for name, values in clip.channels.items():
        np.testing.assert_array_equal(values, table[:, header.index(name)])


def test_interval_picks_its_rows():
    path = need("roag_wall_reaching") / "p01_h_complete_data.csv"
    header, table = naive_csv(path)
    rows = table[table[:, header.index("interval_label")] == 7]
    clip = rc.read_motion(str(path), interval=7)
    wrist = clip.positions[:, clip.names.index("h_Wrist")]
    np.testing.assert_allclose(wrist, rows[:, [header.index(f"h_Wrist_{axis}") for axis in "xyz"]] / 1000, rtol=1e-14)
    assert clip.rate == 100.0


# ---------------------------------------------------------------- C3D and TRC, the slow and plain way


def vax_float(raw):
    """DEC's F format by its definition: sign, exponent biased by 128, fraction 0.1f with the first bit hidden."""
    high, low = struct.unpack("<HH", raw)
    exponent = high >> 7 & 0xFF
    fraction = (1 << 23 | (high & 0x7F) << 16 | low) / (1 << 24)
    return 0.0 if exponent == 0 else (-1) ** (high >> 15) * fraction * 2.0 ** (exponent - 128)


def naive_c3d(path):
    """(points (F, J, 3) in file units with NaN for missing, rate), by the header alone."""
    data = path.read_bytes()
    is_dec = data[(data[0] - 1) * 512 + 3] == 85
    real = vax_float if is_dec else (lambda raw: struct.unpack("<f", raw)[0])
    joints, analog, first, last = struct.unpack("<4H", data[2:10])
    scale, rate = real(data[12:16]), real(data[20:24])
    width = 4 if scale < 0 else 2
    at = (struct.unpack("<H", data[16:18])[0] - 1) * 512
    points = np.full((last - first + 1, joints, 3), math.nan)
    for frame in range(len(points)):
        for joint in range(joints):
            here = at + width * (frame * (4 * joints + analog) + 4 * joint)
            raw = [data[here + width * i : here + width * (i + 1)] for i in range(4)]
            if width == 4:
                x, y, z, residual = map(real, raw)
            else:
                x, y, z, residual = (struct.unpack("<h", part)[0] for part in raw)
                x, y, z = x * scale, y * scale, z * scale
            if residual >= 0:
                points[frame, joint] = x, y, z
    return points, rate


@pytest.mark.parametrize("path", files_in("c3d_trc", "*.c3d"), ids=lambda path: path.stem)
def test_c3d_points_agree_with_a_plain_reading(path):
    need_file(path)
    expected, rate = naive_c3d(path)
    clip = rc.read_motion(str(path), metres_per_unit=1.0, up="z")
    assert clip.positions.shape == expected.shape
    assert clip.rate == pytest.approx(rate, rel=1e-6)
    np.testing.assert_array_equal(np.isnan(clip.positions), np.isnan(expected))
    np.testing.assert_allclose(clip.positions, expected, rtol=1e-12)


@pytest.mark.parametrize("path", files_in("c3d_trc", "*.trc"), ids=lambda path: path.stem)
def test_trc_points_agree_with_a_plain_reading(path):
    need_file(path)
    lines = path.read_text().splitlines()
    names = [name for name in lines[3].split("\t")[2:] if name.strip()]
    rows = [line.split("\t") for line in lines[5:] if line.strip()]
    table = np.array([[float(c) if c.strip() else math.nan for c in row[2 : 2 + 3 * len(names)]] for row in rows])
    clip = rc.read_motion(str(path), metres_per_unit=1.0, up="z")
    assert clip.names == [name.strip() for name in names]
    np.testing.assert_array_equal(clip.positions, table.reshape(len(rows), -1, 3))
    assert clip.rate == float(lines[2].split()[0])


def test_guess_is_shown_and_can_be_overridden():
    path = need("c3d_trc") / "motion_capture_walk.trc"
    guess = rc.read_motion(str(path)).guess
    assert (guess.unit, guess.unit_from, guess.up, guess.up_from) == ("millimetres", "file", "y", "data")
    assert (guess.facing, guess.facing_from, guess.rate, guess.rate_from) == ("x", "data", 100.0, "file")
    assert 1.5 < guess.stature < 2.0
    assert "millimetres (file), up y (data), facing x (data), 100 Hz (file)" in str(guess)
    plain = rc.read_motion(str(path)).positions
    turned = rc.read_motion(str(path), facing="x", rate=50)
    np.testing.assert_allclose(turned.positions, np.stack([-plain[..., 1], plain[..., 0], plain[..., 2]], -1))
    assert (turned.guess.facing_from, turned.guess.rate_from, turned.rate) == ("argument", "argument", 50.0)
    upside_down = rc.read_motion(str(path), up="-y").positions
    np.testing.assert_allclose(upside_down[..., 2], -plain[..., 2])
    with pytest.raises(ValueError, match="facing must be a horizontal axis of the file, not 'y'"):
        rc.read_motion(str(path), facing="y")
    with pytest.raises(ValueError, match="up must be 'x', 'y', 'z', '-x', '-y' or '-z', not 'w'"):
        rc.read_motion(str(path), up="w")


def test_wrong_unit_in_the_file_is_noticed(tmp_path):
    text = (need("c3d_trc") / "motion_capture_walk.trc").read_text()
    wrong = tmp_path / "wrong.trc"
    wrong.write_text(text.replace("\t\t mm\t", "\t\t m\t", 1))
    clip = rc.read_motion(str(wrong))
    assert (clip.guess.unit, clip.guess.unit_from) == ("millimetres", "data")
    assert "The file states metres, but the person would be 17" in clip.note
