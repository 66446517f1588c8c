// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "damage.hpp"
#include "mocap_cases.hpp"
#include "reachcast/mocap/trc.hpp"

namespace {

using namespace reachcast;
using namespace reachcast::test;

const std::string kTrc =
    "PathFileType\t4\t(X/Y/Z)\tmade.trc\n"
    "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n"
    "50.00\t50.00\t3\t2\tmm\t50.00\t1\t3\n"
    "Frame#\tTime\tHead Top\t\t\tLTOE\t\t\t\n"
    "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\t\n"
    "\n"
    "1\t0.00\t1\t1700\t3\t4\t90\t6\n"
    "2\t0.02\t\t\t\t4.5\t90\t6\t\n"
    "3\t0.04\t1\t1700\t3\t4\t\t\n";

MotionFile parse(const std::string& text, const MotionFileOptions& options = {}) {
  return parse_trc(text, "made.trc", options);
}

TEST(Trc, MarkersRateAndUnitAreRead) {
  const MotionFile file = parse(kTrc);
  EXPECT_EQ(file.names, (std::vector<std::string>{"Head Top", "LTOE"}));
  EXPECT_DOUBLE_EQ(file.rate_hz, 50.0);
  EXPECT_DOUBLE_EQ(file.guess.metres_per_unit, 0.001);
  EXPECT_EQ(file.guess.up, "y");
  EXPECT_EQ(file.guess.up_from, From::data);
  EXPECT_LT(glm::distance(file.at(0, 0), Vec3(0.001, -0.003, 1.7)), 1e-12);
}

TEST(Trc, BlankCellsAreMissing) {
  const MotionFile file = parse(kTrc);
  EXPECT_FALSE(is_finite(file.at(1, 0)));
  EXPECT_TRUE(is_finite(file.at(1, 1)));
  EXPECT_FALSE(is_finite(file.at(2, 1))) << "a marker with one blank is missing";
}

TEST(Trc, LineEndsDoNotMatter) {
  std::string text = kTrc;
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.replace(at, 1, "\r\n");
  EXPECT_EQ(parse(text).frames(), 3U);
}

TEST(Trc, WordsPartedByBlanksAreReadToo) {
  const std::string text =
      "PathFileType 4 (X/Y/Z) made.trc\n"
      "DataRate CameraRate NumFrames NumMarkers Units\n"
      "100 100 1 2 m\n"
      "Frame# Time A B\n"
      " X1 Y1 Z1 X2 Y2 Z2\n"
      "1 0.0 1 2 3  4 5 6\n";
  const MotionFile file = parse(text, {.metres_per_unit = {}, .up = "z", .rate_hz = {}, .interval = {}});
  EXPECT_EQ(file.at(0, 1), Vec3(4, 5, 6));
}

TEST(Trc, MistakesAreAnsweredWithLineExpectedAndFound) {
  const auto answer = [](const std::string& from, const std::string& to) {
    return complaint([&] { (void)parse(replaced(kTrc, from, to)); });
  };
  EXPECT_EQ(answer("PathFileType", "Path"), "made.trc:2: expected PathFileType, found something else");
  EXPECT_EQ(answer("\t3\t2\tmm", "\t4\t2\tmm"), "made.trc:10: expected the 4 frames that NumFrames announces, found 3");
  EXPECT_EQ(answer("\t3\t2\tmm", "\t3\t5\tmm"), "made.trc:4: expected the 5 names that NumMarkers announces, found 2");
  EXPECT_EQ(answer("4.5", "x"), "made.trc:8: expected a number or nothing in column 6, found \"x\"");
  EXPECT_EQ(answer("4\t90\t6\n", "4\n"), "made.trc:7: expected 8 cells in a frame, found 6");
  EXPECT_EQ(answer("50.00\t50.00", "0\t50.00"), "made.trc: the frame rate must be 0.001 to 1e6 Hz, not 0; give rate");
}

TEST(Trc, DamagedTextIsReadOrRefused) {
  for (std::size_t length = 0; length < kTrc.size(); ++length) {
    (void)complaint([&] { (void)parse(kTrc.substr(0, length)); });
  }
  const std::size_t count = survivors(kTrc, 20000, [](const std::string& text) { (void)parse(text); });
  EXPECT_GT(count, 0U);
  EXPECT_LT(count, 20000U);
}

TEST(Trc, RecordedFilesAreRead) {
  REACHCAST_NEED_MOCAP("c3d_trc");
  const auto read = [](const std::string& name) { return read_motion((mocap_folder() / "c3d_trc" / name).string()); };
  const MotionFile blanks = read("dataWithBlanksForMissingMarkers.trc");
  EXPECT_EQ(blanks.frames(), 464U);
  EXPECT_EQ(blanks.joints(), 40U);
  EXPECT_FALSE(is_finite(blanks.at(0, 0)));
  const MotionFile walk = read("motion_capture_walk.trc");
  EXPECT_EQ(walk.frames(), 238U);
  EXPECT_EQ(walk.guess.up, "y");
  EXPECT_LT(glm::distance(walk.at(0, 0), Vec3(-0.652630, 0.094520, 1.529542)), 1e-12);
  EXPECT_GT(walk.guess.stature_m, 1.5);
  EXPECT_LT(walk.guess.stature_m, 2.0);
}

}  // namespace
