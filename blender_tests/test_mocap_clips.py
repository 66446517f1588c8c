# SPDX-License-Identifier: GPL-3.0-or-later
"""From what was read to reaches, from Python: joint maps, gaps, tracking, phases found and labelled.

Plain pytest, no Blender: /usr/bin/python3 -m pytest blender_tests/test_mocap_clips.py
"""

import json

import numpy as np
import pytest
from mocap_cases import need, rc


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


# ---------------------------------------------------------------- phases


def omomo_lift():
    recorded = rc.read_motion(str(need("omomo") / "sub3_largebox_003.csv"))
    return recorded, rc.canonical(recorded, "omomo")


def test_phases_are_found_and_the_rest_is_named():
    recorded, body = omomo_lift()
    found = rc.find_reaches(body, rc.Subject(1.82), recorded=recorded, origin="lift")
    assert "transfer" in [reach.phase for reach in found.reaches]
    for reach, (first, last) in zip(found.reaches, found.spans, strict=True):
        assert reach.origin == f"lift:{first}-{last}" and len(reach) == last - first + 1
    assert all(left.reason and 0 <= left.first <= left.last < len(body) for left in found.rejections)
    frames = [event.frame for event in found.events]
    assert frames == sorted(frames) and {event.name for event in found.events} >= {"lift-off", "placed"}
    strict_search = rc.find_reaches(body, rc.Subject(1.82), recorded=recorded, least_s=30.0)
    assert not strict_search.reaches and any("at least 30.00 s" in left.reason for left in strict_search.rejections)
    with pytest.raises(ValueError, match="'slips' is not known"):
        rc.find_reaches(body, rc.Subject(1.82), slips=1.0)


def test_labels_cut_what_they_say(tmp_path):
    recorded, body = omomo_lift()
    table = tmp_path / "labels.csv"
    table.write_text("file;phase;first;last;stature_m;sex;grasp_frame\n"
                     "a.csv;transfer;29;52;1.82;m;27\nb.csv;reach;0;20;;;\n")
    first, second = rc.read_labels(str(table))
    assert (first.file, first.phase, first.stature, first.sex, first.events) == ("a.csv", "transfer", 1.82, "male", {"grasp": 27})
    assert first.frames(body) == (29, 52) and second.stature is None
    found = rc.cut_labelled(body, [first, second], None, recorded=recorded, origin="a")
    assert [(reach.phase, reach.origin, reach.subject.stature) for reach in found.reaches] == [("transfer", "a:29-52", 1.82)]
    assert ["stature" in left.reason for left in found.rejections] == [True]
    table.write_text("file,phase,first,last\na.csv,dance,0,9\n")
    with pytest.raises(ValueError, match="labels.csv:2: .*'dance'"):
        rc.read_labels(str(table))
