// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <random>

#include "c3d_writer.hpp"
#include "damage.hpp"
#include "mocap_cases.hpp"
#include "reachcast/mocap/c3d.hpp"

namespace {

using namespace reachcast;
using namespace reachcast::test;

const MotionFileOptions kAsInFile{.metres_per_unit = 1.0, .up = "z", .rate_hz = {}, .interval = {}};
constexpr C3dFlavour kFlavours[] = {{false, true}, {true, true}, {false, false}, {true, false}};

C3dContent made(std::size_t joints, std::size_t frames, unsigned seed = 1) {
  std::mt19937 random(seed);
  C3dContent content;
  for (std::size_t i = 0; i < joints; ++i) content.names.push_back(std::to_string(i) + "M");
  for (std::size_t i = 0; i < joints * frames; ++i) {
    const auto coordinate = [&] { return static_cast<double>(random() % 40001) / 10.0 - 2000.0; };
    const double x = coordinate(), y = coordinate(), z = coordinate();
    content.points.emplace_back(i % 7 == 3 ? Vec3(kMissing) : Vec3(x, y, z));
  }
  return content;
}

MotionFile parse(const std::string& bytes, const MotionFileOptions& options = kAsInFile) {
  return parse_c3d(bytes, "made.c3d", options);
}

void expect_points(const MotionFile& file, const Points& expected, double tolerance) {
  ASSERT_EQ(file.positions.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_EQ(is_finite(file.positions[i]), is_finite(expected[i])) << i;
    if (!is_finite(expected[i])) continue;
    ASSERT_LT(glm::distance(file.positions[i], expected[i]), tolerance) << i;
  }
}

TEST(C3d, EveryFlavourReadsBackWhatWasWritten) {
  for (const C3dFlavour flavour : kFlavours) {
    for (const std::size_t analog : {0, 6}) {
      C3dContent content = made(5, 40);
      content.analog = analog;
      content.rate_hz = 119.88;
      const MotionFile file = parse(C3dWriter(flavour).write(content));
      EXPECT_EQ(file.names, content.names);
      EXPECT_NEAR(file.rate_hz, 119.88, 1e-4);
      expect_points(file, content.points, 1e-3);  // floats of size 4000, and integers in tenths
    }
  }
}

TEST(C3d, ExtremeNumbersOfADecComeOut) {
  C3dContent content = made(1, 6);
  content.points = {
      Vec3(0.0, -0.0, 1.0), Vec3(-1.5, 3.0e-30, -2.5e8), Vec3(0.1, 1.0 / 3.0, -1e-3), Vec3(1024, 65536, 8388607),
      Vec3(-1, -2, -4),     Vec3(0.5, 0.25, 0.75)};
  const MotionFile file = parse(C3dWriter({true, true}).write(content));
  for (std::size_t i = 0; i < content.points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_FLOAT_EQ(static_cast<float>(file.positions[i][axis]), static_cast<float>(content.points[i][axis]));
    }
  }
}

TEST(C3d, MoreFramesThanAHeaderCanCount) {
  const C3dContent content = made(1, 70000);
  const MotionFile file = parse(C3dWriter({false, false}).write(content));
  EXPECT_EQ(file.frames(), 70000U);
  expect_points(file, content.points, 1e-3);
}

TEST(C3d, MoreNamesThanOneParameterHolds) {
  const C3dContent content = made(300, 2);
  EXPECT_EQ(parse(C3dWriter({}).write(content)).names, content.names);
}

TEST(C3d, AnglesAndForcesAreNoMarkers) {
  C3dContent content = made(4, 3);
  content.names = {"LKNE", "LKneeAngles", "LANK", "LKNE"};
  content.angles = {"LKneeAngles"};
  const MotionFile file = parse(C3dWriter({}).write(content));
  EXPECT_EQ(file.names, (std::vector<std::string>{"LKNE", "LANK", "LKNE_2"}));
  EXPECT_LT(glm::distance(file.at(0, 1), content.points[2]), 1e-3);
}

TEST(C3d, UnitRateAndUpComeFromTheFile) {
  C3dContent content = made(3, 3);
  content.y_screen = "-Y";
  content.units = "cm";
  const MotionFile file = parse(C3dWriter({}).write(content), {});
  EXPECT_DOUBLE_EQ(file.guess.metres_per_unit, 0.01);
  EXPECT_EQ(file.guess.unit_from, From::file);
  EXPECT_EQ(file.guess.up, "-y");
  EXPECT_EQ(file.guess.up_from, From::file);
  EXPECT_NEAR(file.at(0, 0).z, -0.01 * content.points[0].y, 1e-6);
}

TEST(C3d, MistakesAreNamed) {
  C3dContent content = made(3, 50);
  content.processor = 86;
  EXPECT_EQ(complaint([&] { (void)parse(C3dWriter({}).write(content)); }),
            "made.c3d: expected Intel or DEC numbers, found MIPS (SGI) numbers, which are not supported");
  content.processor = 0;
  const std::string whole = C3dWriter({}).write(content);
  EXPECT_NE(complaint([&] { (void)parse(whole.substr(0, whole.size() - 1024)); }).find("the 50 frames announced"),
            std::string::npos);
  EXPECT_NE(complaint([&] { (void)parse("not a recording"); }).find("expected a C3D file"), std::string::npos);
  EXPECT_NE(complaint([&] { (void)parse(""); }).find("found 0 bytes"), std::string::npos);
}

TEST(C3d, CutAtAnyByteTheFileIsReadOrRefused) {
  const std::string whole = C3dWriter({false, false}).write(made(3, 50));
  for (std::size_t length = 0; length < whole.size(); ++length) {
    (void)complaint([&] { (void)parse(whole.substr(0, length)); });
  }
}

TEST(C3d, DamagedFilesAreReadOrRefused) {
  for (const C3dFlavour flavour : kFlavours) {
    const std::string whole = C3dWriter(flavour).write(made(4, 30));
    constexpr int cases = 10000;
    const auto read = [&](const std::string& bytes) {
      const MotionFile file = parse(bytes, {});
      ASSERT_LE(file.positions.size() * 8, bytes.size()) << "more points than bytes can hold";
    };
    const std::size_t count = survivors(whole, cases, read, 1536);
    EXPECT_GT(count, 0U);
    EXPECT_LT(count, static_cast<std::size_t>(cases));
  }
}

TEST(C3d, RecordedFilesAreRead) {
  REACHCAST_NEED_MOCAP("c3d_trc");
  const auto read = [](const std::string& name) { return read_motion((mocap_folder() / "c3d_trc" / name).string()); };
  const MotionFile cmu = read("cmu_02_01.c3d");
  EXPECT_EQ(cmu.frames(), 343U);
  EXPECT_EQ(cmu.joints(), 41U);
  EXPECT_DOUBLE_EQ(cmu.rate_hz, 120.0);
  EXPECT_EQ(cmu.guess.up, "z");
  EXPECT_GT(cmu.guess.stature_m, 1.5);
  EXPECT_LT(cmu.guess.stature_m, 1.9);
  const MotionFile dec = read("walkingOptiTrack.c3d");
  EXPECT_EQ(dec.frames(), 3361U);
  EXPECT_DOUBLE_EQ(dec.guess.metres_per_unit, 0.001);
}

}  // namespace
