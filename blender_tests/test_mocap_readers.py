# SPDX-License-Identifier: GPL-3.0-or-later
"""The readers of reachcast_core against independent ones: BVH by 4x4 matrices in numpy, CSV by Python's csv module.

Plain pytest, no Blender: /usr/bin/python3 -m pytest blender_tests/test_mocap_readers.py
Recordings are looked for in $REACHCAST_MOCAP, else in ../shared/mocap beside the project; without them tests skip.
"""

import csv
import json
import math
import os
import struct
import sys
from pathlib import Path

import numpy as np
import pytest

PROJECT = Path(__file__).resolve().parent.parent
sys.path.insert(0, os.environ.get("REACHCAST_MODULE_DIR", str(PROJECT / "addon" / "reachcast")))
rc = pytest.importorskip("reachcast_core", reason="reachcast_core is not built for this Python")

MOCAP = Path(os.environ.get("REACHCAST_MOCAP", PROJECT.parent / "shared" / "mocap"))
# Joint centres agree to rounding: about ten products of rotations, relative to the farthest coordinate.
RELATIVE = 1e-9
MOST_FRAMES = 60  # per file; matrices in Python are slow


def need(folder):
    if not (MOCAP / folder).is_dir():
        pytest.skip(f"recordings are missing: {MOCAP / folder}")
    return MOCAP / folder


def files_in(folder, pattern):
    """For parametrize: the files, or one that skips with a message."""
    return sorted((MOCAP / folder).glob(pattern)) or [MOCAP / folder / "missing"]


def need_file(path):
    if not path.exists():
        pytest.skip(f"recordings are missing: {path}")


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


def test_joint_map_from_dict_and_json(tmp_path):
    path = need("c3d_trc") / "motion_capture_walk.trc"
    recorded = rc.read_motion(str(path))
    sides = {"left": "L", "right": "R"}
    names = {"ankle": "Ankle", "knee": "Knee", "hip": "ASIS", "shoulder": "Shoulder", "elbow": "Elbow", "wrist": "Wrist"}
    plain = {f"{side}_{joint}": f"{s}.{name}" for side, s in sides.items() for joint, name in names.items()}
    moved = dict(plain)
    moved["left_hip"] = {"points": "L.ASIS+R.ASIS", "offset": [-0.36, 0, 0], "scale": "L.ASIS>R.ASIS", "across": "L.ASIS>R.ASIS"}
    moved["left_ankle"] = [{"points": ["no such marker"]}, {"points": ["L.Ankle", "L.Heel"]}]
    file = tmp_path / "map.json"
    file.write_text(json.dumps(moved))
    clip = rc.canonical(recorded, moved)
    np.testing.assert_array_equal(clip.positions, rc.canonical(recorded, str(file)).positions)
    point = dict(zip(recorded.names, np.moveaxis(recorded.positions, 1, 0)))
    joint = dict(zip(clip.names, np.moveaxis(clip.positions, 1, 0)))
    np.testing.assert_allclose(joint["left_ankle"], (point["L.Ankle"] + point["L.Heel"]) / 2, atol=1e-12)
    across = point["R.ASIS"] - point["L.ASIS"]
    width = np.linalg.norm(across, axis=1)
    expected = (point["L.ASIS"] + point["R.ASIS"]) / 2 - 0.36 * np.median(width) * across / width[:, None]
    np.testing.assert_allclose(joint["left_hip"], expected, atol=2e-4)  # the upper of two medians
    with pytest.raises(ValueError, match="not 'shift'"):
        rc.canonical(recorded, {**plain, "left_hip": {"points": "L.ASIS", "shift": [0, 0, 1]}})
    assert "plug-in gait" in rc.joint_map_names()


def test_gaps_are_filled_and_marked():
    recorded = rc.read_motion(str(need("c3d_trc") / "walkingOptiTrack.c3d"))
    filled = rc.fill_gaps(recorded, limit_s=0.2)
    was_missing = np.isnan(recorded.positions[..., 0])
    assert was_missing.any() and filled.filled.any() and not recorded.filled.any()
    assert filled.guess.unit == "millimetres"
    assert not (filled.filled & ~was_missing).any()
    np.testing.assert_array_equal(filled.filled, was_missing & ~np.isnan(filled.positions[..., 0]))
    for joint in range(was_missing.shape[1]):
        runs, start = [], None
        for frame, missing in enumerate([*was_missing[:, joint], False]):
            if missing and start is None:
                start = frame
            elif not missing and start is not None:
                runs.append((start, frame - 1))
                start = None
        for first, last in runs:
            inside = first > 0 and last < len(was_missing) - 1
            expected = inside and last - first + 1 <= 0.2 * recorded.rate
            assert filled.filled[first : last + 1, joint].all() == expected
            assert filled.filled[first : last + 1, joint].any() == expected


def test_tracking_faults_are_listed():
    clip = rc.canonical(rc.read_motion(str(need("omomo") / "sub3_largebox_003.csv")))
    assert rc.check_tracking(clip) == []
    points = clip.positions
    points[20, clip.names.index("left_wrist")] += [0, 0, 0.5]
    faults = rc.check_tracking(rc.Clip(clip.names, points, clip.rate))
    assert {fault[:3] for fault in faults} == {("left_wrist", 20, 20)}
    assert any("away and back" in fault[3] for fault in faults)


# ---------------------------------------------------------------- from recording to reach


def test_arrays_own_their_memory_and_errors_are_value_errors(tmp_path):
    names = ["a", "b"]
    given = np.arange(24.0).reshape(4, 2, 3)
    clip = rc.Clip(names, given, 50.0)
    clip.positions[:] = 0
    np.testing.assert_array_equal(clip.positions, given)
    with pytest.raises(ValueError, match="positions must have the shape"):
        rc.Clip(["a"], given, 50.0)
    with pytest.raises(ValueError, match="no known set of joint names"):
        rc.canonical(clip)
    with pytest.raises(ValueError, match=r"\.trc or \.amc"):
        rc.read_motion(str(tmp_path / "walk.fbx"))


def test_reach_starts_at_the_ankles_and_faces_forward():
    clip = rc.canonical(rc.read_motion(str(need("omomo") / "sub3_largebox_003.csv")))
    reach = rc.cut_reach(clip, 29, 52, rc.Subject(1.82), "transfer", "test", floor_z=0.0)
    start = dict(zip(clip.names, reach.positions[0]))
    ankles = (start["left_ankle"] + start["right_ankle"]) / 2
    np.testing.assert_allclose(ankles[:2], 0, atol=1e-12)
    assert start["right_hip"][0] > 0 > start["left_hip"][0]
    assert reach.hold_points[0, 1] > 0.2, "the box stands in front"
    assert reach.hold_points[-1, 2] - reach.hold_points[0, 2] > 0.6
    for a, b in (("left_knee", "left_ankle"), ("right_elbow", "right_wrist")):
        world = clip.positions[29:53, clip.names.index(a)] - clip.positions[29:53, clip.names.index(b)]
        body = reach.positions[:, clip.names.index(a)] - reach.positions[:, clip.names.index(b)]
        np.testing.assert_allclose(np.linalg.norm(body, axis=1), np.linalg.norm(world, axis=1), rtol=1e-12)


def test_unknown_phase_and_map_name_the_known_ones():
    clip = rc.canonical(rc.read_motion(str(need("omomo") / "sub3_largebox_003.csv")), "omomo")
    with pytest.raises(ValueError, match="transfer, return, reach or retrieve, not 'lift'"):
        rc.cut_reach(clip, 0, 20, rc.Subject(1.8), "lift")
    with pytest.raises(ValueError, match="omomo, lieblich"):
        rc.canonical(clip, "vicon")
    with pytest.raises(ValueError, match="'left_paw' is not a canonical joint"):
        rc.canonical(clip, {"left_paw": "L_Hand"})
