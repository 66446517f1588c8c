# SPDX-License-Identifier: GPL-3.0-or-later
"""What the main job has left behind: its files, whole, and the numbers of its report within their limits.

    /usr/bin/python3 blender_tests/check_lift.py FOLDER REFUSED_LOG

FOLDER holds the results of both rigs in mannequin/ and rigify/, and refused/, which must hold none. REFUSED_LOG is what
the refused run printed.
"""
from __future__ import annotations

import json
import subprocess
import sys
import unittest
from pathlib import Path
from typing import Any

RESULTS = {"lift.blend", "lift.mp4", "contact_sheet.png", "report.json"}
EVENTS = ["grasp", "lift_off", "placed", "release", "end"]
#: The issue's own limits, over every frame of the evaluated scene.
MOST = {"landing_m": 1e-3, "grasp_m": 1e-3, "held_m": 1e-3, "left_foot_m": 1e-3, "fastest_rad_s": 15.0, "stretch": 1e-4}
LEAST = {"least_elbow_deg": 0.0, "least_knee_deg": 0.0}


class LiftResult:
    """The tests of one rig's folder."""

    folder: Path

    def report(self) -> dict[str, Any]:
        return json.loads((self.folder / "report.json").read_text(encoding="utf-8"))

    def test_all_files_and_no_drafts(self) -> None:
        self.assertEqual({item.name for item in self.folder.iterdir()}, RESULTS)

    def test_film_plays_from_first_to_last_frame(self) -> None:
        film = self.folder / "lift.mp4"
        played = subprocess.run(["ffmpeg", "-nostdin", "-v", "error", "-xerror", "-i", film, "-f", "null", "-"],
                                capture_output=True, text=True, check=False)
        self.assertEqual((played.returncode, played.stderr), (0, ""))
        facts = subprocess.run(["ffprobe", "-v", "error", "-show_entries", "stream=codec_name:format=duration",
                                "-of", "default=nokey=1:noprint_wrappers=1", film],
                               capture_output=True, text=True, check=True).stdout.split()
        report = self.report()
        self.assertEqual(facts[0], "h264")
        self.assertGreaterEqual(float(facts[1]), (report["frames"]["end"] - report["first_frame"])
                                / report["frame_rate"])

    def test_contact_sheet_is_a_picture(self) -> None:
        self.assertTrue((self.folder / "contact_sheet.png").read_bytes().startswith(b"\x89PNG\r\n\x1a\n"))

    def test_blend_file_is_one(self) -> None:
        start = (self.folder / "lift.blend").read_bytes()[:7]
        self.assertTrue(start == b"BLENDER" or start[:4] == b"\x28\xb5\x2f\xfd", start)  # plain or Zstandard

    def test_measures_within_limits(self) -> None:
        measured = self.report()["measured_in_evaluated_scene"]
        for name, most in MOST.items():
            self.assertLessEqual(measured[name], most, name)
        for name, least in LEAST.items():
            self.assertGreaterEqual(measured[name], least, name)

    def test_report_says_what_it_rests_on(self) -> None:
        report = self.report()
        frames = [report["frames"][event] for event in EVENTS]
        self.assertEqual(frames, sorted(frames))
        for phase in report["task"]["phases"]:
            self.assertAlmostEqual(sum(near["weight"] for near in report["neighbours"] if near["phase"] == phase), 1.0)
        self.assertEqual(report["outside_data"], bool(report["outside_reasons"]))


class Mannequin(LiftResult, unittest.TestCase):
    pass


class Rigify(LiftResult, unittest.TestCase):
    pass


class Refused(unittest.TestCase):
    folder: Path
    log: Path

    def test_unreachable_shelf_is_one_sentence_and_leaves_no_result(self) -> None:
        said = [line for line in self.log.read_text(encoding="utf-8").splitlines() if "out of reach" in line]
        self.assertEqual(len(said), 1, self.log)
        self.assertNotIn("Traceback", self.log.read_text(encoding="utf-8"))
        self.assertEqual(list(self.folder.iterdir()), [])


def main() -> int:
    folder, Refused.log = Path(sys.argv[1]), Path(sys.argv[2])
    Mannequin.folder, Rigify.folder, Refused.folder = folder / "mannequin", folder / "rigify", folder / "refused"
    suite = unittest.TestSuite(unittest.defaultTestLoader.loadTestsFromTestCase(case)
                               for case in (Mannequin, Rigify, Refused))
    result = unittest.TestResult()
    suite.run(result)
    for test, trace in result.failures + result.errors:
        print(f"FAIL {test.id()}\n{trace}")
    failed = len(result.failures) + len(result.errors)
    print(f"{result.testsRun - failed - len(result.skipped)} passed, {failed} failed, {len(result.skipped)} skipped")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
