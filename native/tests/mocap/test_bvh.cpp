// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>

#include "mocap_cases.hpp"
#include "reachcast/mocap/bvh.hpp"

namespace {

using namespace reachcast;
using namespace reachcast::test;

constexpr double kTolerance = 1e-12;  // a handful of products of numbers of size 10

const MotionFileOptions kAsInFile{.metres_per_unit = 1.0, .up = "z", .rate_hz = {}, .interval = {}};

MotionFile parse(const std::string& text, const MotionFileOptions& options = kAsInFile) {
  return parse_bvh(text, "hand.bvh", options);
}

void expect_point(const Vec3& point, const Vec3& expected) {
  EXPECT_LT(glm::distance(point, expected), kTolerance) << point.x << ' ' << point.y << ' ' << point.z;
}

TEST(Bvh, PositionChannelsReplaceTheOffset) {
  expect_point(parse(kSmallBvh).at(0, 0), {1, 2, 3});
}

TEST(Bvh, ComponentsWithoutPositionChannelKeepTheOffset) {
  const std::string text = replaced(replaced(kSmallBvh, "6 Xposition Yposition Zposition", "4 Yposition"),
                                    "1 2 3 0 0 0 0 0 0\n1 2 3 90 0 0 0 90 0\n", "2 0 0 0 0 0 0\n");
  expect_point(parse(text).at(0, 0), {7, 2, 9});
}

TEST(Bvh, RotationsApplyInTheOrderListedInTheFrameOfTheParent) {
  const MotionFile file = parse(kSmallBvh);
  EXPECT_EQ(file.names, (std::vector<std::string>{"Hips", "Arm", "Arm_end"}));
  expect_point(file.at(0, 2), {1, 17, 3});
  // The hips turn 90 degrees about z: y becomes -x. The arm then turns 90 about its x: its y becomes its z.
  expect_point(file.at(1, 1), {-9, 2, 3});
  expect_point(file.at(1, 2), {-9, 2, 8});
}

TEST(Bvh, RotationsBeforePositionsGiveTheSame) {
  const std::string text =
      replaced(replaced(replaced(kSmallBvh, "Xposition Yposition Zposition Zrotation Xrotation Yrotation",
                                 "Zrotation Xrotation Yrotation Xposition Yposition Zposition"),
                        "1 2 3 0 0 0 0 0 0", "0 0 0 1 2 3 0 0 0"),
               "1 2 3 90 0 0 0 90 0", "90 0 0 1 2 3 0 90 0");
  EXPECT_EQ(parse(text).positions, parse(kSmallBvh).positions);
}

TEST(Bvh, LineEndsTabsBlankLinesAndLetterCaseDoNotMatter) {
  const MotionFile plain = parse(kSmallBvh);
  for (const std::string line_end : {"\r\n", "\r", "\n\n \t\n", " \n"}) {
    std::string text = kSmallBvh;
    for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += line_end.size()) {
      text.replace(at, 1, line_end);
    }
    EXPECT_EQ(parse(text).positions, plain.positions);
  }
  std::string tabs = kSmallBvh;
  std::replace(tabs.begin(), tabs.end(), ' ', '\t');
  tabs = replaced(replaced(tabs, "End\tSite", "end  site"), "Frame\tTime:\t", "frame time:");
  EXPECT_EQ(parse("\xEF\xBB\xBF" + tabs).positions, plain.positions);
  EXPECT_EQ(parse(kSmallBvh.substr(0, kSmallBvh.size() - 1)).frames(), 2U) << "no line end after the last frame";
}

TEST(Bvh, FrameTimeMayLackItsLeadingZero) {
  EXPECT_DOUBLE_EQ(parse(kSmallBvh).rate_hz, 20.0);
  MotionFileOptions options = kAsInFile;
  options.rate_hz = 50.0;
  EXPECT_DOUBLE_EQ(parse(kSmallBvh, options).rate_hz, 50.0);
}

TEST(Bvh, FramesPresentAreReadWhateverTheCountSays) {
  EXPECT_TRUE(parse(kSmallBvh).note.empty()) << parse(kSmallBvh).note;
  for (const std::string count : {"1", "3", "0", "700000"}) {
    const MotionFile file = parse(replaced(kSmallBvh, "Frames: 2", "Frames: " + count));
    EXPECT_EQ(file.frames(), 2U);
    EXPECT_NE(file.note.find("announces"), std::string::npos);
  }
}

TEST(Bvh, PointsWithTheSameNameAreNumbered) {
  const std::string text = replaced(replaced(kSmallBvh, "JOINT Arm", "JOINT Hips"), "    End Site\n    {\n",
                                    "    End Site\n    {\n      OFFSET 1 1 1\n    }\n    End Site\n    {\n");
  EXPECT_EQ(parse(text).names, (std::vector<std::string>{"Hips", "Hips_2", "Hips_2_end", "Hips_2_end_2"}));
}

TEST(Bvh, NamesMayHoldBlanks) {
  EXPECT_EQ(parse(replaced(kSmallBvh, "JOINT Arm", "JOINT Left Arm ")).names[1], "Left Arm");
}

TEST(Bvh, EachAxisCanBeUp) {
  MotionFileOptions options = kAsInFile;
  options.up = "y";
  expect_point(parse(kSmallBvh, options).at(0, 0), {1, -3, 2});
  options.up = "x";
  expect_point(parse(kSmallBvh, options).at(0, 0), {2, 3, 1});
}

TEST(Bvh, UnitIsGuessedFromTheHeightOrAskedFor) {
  const auto scaled = [](const std::string& arm) {
    return parse_bvh(replaced(kSmallBvh, "OFFSET 0 10 0", "OFFSET 0 " + arm + " 0"), "hand.bvh");
  };
  EXPECT_DOUBLE_EQ(scaled("165").guess.metres_per_unit, 0.01);
  EXPECT_DOUBLE_EQ(scaled("1600").guess.metres_per_unit, 0.001);
  EXPECT_DOUBLE_EQ(scaled("60").guess.metres_per_unit, 0.0254);
  EXPECT_DOUBLE_EQ(scaled("25").guess.metres_per_unit, 0.0254 / 0.45);
  EXPECT_EQ(scaled("165").guess.up, "y");
  EXPECT_EQ(complaint([&] { scaled("10"); }),
            "hand.bvh: expected a skeleton 1.15 to 2.1 m tall in some known unit, found 15 units from foot to head; "
            "give metres_per_unit");
}

struct Mistake {
  std::string from, to, message;
};

TEST(Bvh, MalformedTextIsAnsweredWithLineExpectedAndFound) {
  const std::vector<Mistake> mistakes{
      {"HIERARCHY", "HIERARCHIE", "hand.bvh:1: expected HIERARCHY, found \"HIERARCHIE\""},
      {"ROOT", "BOOT", "hand.bvh:2: expected ROOT or MOTION, found \"BOOT\""},
      {"Hips\n{", "Hips\n", "hand.bvh:4: expected {, found \"OFFSET\""},
      {"OFFSET 0 10 0", "OFFSET 0 ten 0", "hand.bvh:8: expected a number of OFFSET, found \"ten\""},
      {"OFFSET 0 10 0", "OFFSET 0 nan 0", "hand.bvh:8: expected a number of OFFSET, found \"nan\""},
      {"    OFFSET 0 10 0\n", "", "hand.bvh:13: expected OFFSET of joint \"Arm\", found \"}\""},
      {"CHANNELS 3", "CHANNELS 4", "hand.bvh:10: expected a channel such as Xposition or Zrotation, found \"End\""},
      {"CHANNELS 3", "CHANNELS -1", "hand.bvh:9: expected a number of channels from 0 to 12, found another number"},
      {"JOINT Arm", "JOINT", "hand.bvh:6: expected the name of a joint, found none"},
      {"Frames: 2", "Frame: 2", "hand.bvh:17: expected Frames:, found \"Frame: 2\""},
      {"Frames: 2", "Frames: two", "hand.bvh:17: expected a number after Frames:, found \"two\""},
      {"Frame Time: .05", "Frame Time: 0",
       "hand.bvh:18: expected a Frame Time between 1e-6 and 1000 s (or give rate), found 0"},
      {"1 2 3 0 0 0 0 0 0\n", "1 2 3 0 0 0 0 0\n", "hand.bvh:19: expected 9 numbers in a frame, found only 8"},
      {"90 0 0 0 90 0\n", "90 0 0 0", "hand.bvh:20: expected 9 numbers in a frame, found only 7"},
      {"1 2 3 0 0", "1 2 3 0 0 0", "hand.bvh:19: expected the line to end after 9 numbers, found \"0\""},
      {"90 0 0 0 90 0", "90 0 0 0 9O 0", "hand.bvh:20: expected a number, found \"9O\""},
      {"90 0 0 0 90 0", "90 0 0 0 1e99 0", "hand.bvh:20: expected a number, found \"1e99\""},
      {"1 2 3 0 0 0 0 0 0\n1 2 3 90 0 0 0 90 0\n", "", "hand.bvh:19: expected at least one frame, found none"},
  };
  for (const Mistake& mistake : mistakes) {
    EXPECT_EQ(complaint([&] { (void)parse(replaced(kSmallBvh, mistake.from, mistake.to)); }), mistake.message);
  }
  EXPECT_EQ(complaint([] { (void)parse(""); }), "hand.bvh:1: expected HIERARCHY, found the end of the file");
}

TEST(Bvh, HostileNestingIsRefused) {
  std::string text = "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n";
  for (int i = 0; i < 100000; ++i) text += "JOINT a\n{\nOFFSET 0 0 0\n";
  EXPECT_NE(complaint([&] { (void)parse(text); }).find("expected at most 512 nested joints, found more"),
            std::string::npos);
}

TEST(Bvh, OptionsOutOfRangeAreNamed) {
  MotionFileOptions options;
  options.metres_per_unit = -2.0;
  EXPECT_EQ(complaint([&] { (void)parse(kSmallBvh, options); }),
            "metres_per_unit must be over 0 and at most 1e6, not -2");
  EXPECT_EQ(
      complaint([&] { (void)parse(kSmallBvh, {.metres_per_unit = {}, .up = "w", .rate_hz = {}, .interval = {}}); }),
      "up must be 'x', 'y', 'z', '-x', '-y' or '-z', not 'w'");
}

TEST(ReadMotion, AnotherEndingIsAnsweredWithTheKnownOnes) {
  EXPECT_EQ(complaint([] { (void)read_motion("walk.fbx"); }),
            "walk.fbx: expected a file that ends in .bvh, .csv, .c3d, .trc or .amc, found \".fbx\"");
  EXPECT_EQ(complaint([] { (void)read_motion("/no/such/walk.BVH"); }),
            "/no/such/walk.BVH: cannot be read as a file of at most 4 GB");
  EXPECT_NE(complaint([] { (void)read_bvh("/"); }), "");
}

}  // namespace
