// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "damage.hpp"
#include "mocap_cases.hpp"
#include "reachcast/mocap/acclaim.hpp"
#include "reachcast/mocap/bvh.hpp"

namespace {

using namespace reachcast;
using namespace reachcast::test;

const std::string kAsf =
    "# made for a test\n:version 1.10\n:name made\n:units\n  mass 1.0\n  length 0.45\n  angle deg\n"
    ":documentation\n  words words\n"
    ":root\n  order TX TY TZ RX RY RZ\n  axis XYZ\n  position 0 0 0\n  orientation 0 0 0\n"
    ":bonedata\n"
    "  begin\n  id 1\n  name thigh\n  direction 0 -1 0\n  length 7\n  axis 0 0 20 XYZ\n  dof rx ry rz\n"
    "  limits (-160.0 20.0)\n  (-70.0 70.0)\n  (-60.0 70.0)\n  end\n"
    "  begin\n  id 2\n  name shin\n  direction 0 -2 1\n  length 6\n  axis 0 0 0 XYZ\n  dof rx\n  limits (0 170)\n  "
    "end\n"
    "  begin\n  id 3\n  name stump\n  direction 1 0 0\n  length 2\n  axis 0 0 0 XYZ\n  end\n"
    ":hierarchy\n  begin\n  root thigh stump\n  thigh shin\n  end\n";
const std::string kAmc =
    "#!made\n:FULLY-SPECIFIED\n:DEGREES\n"
    "1\nroot 1 2 3 0 0 0\nthigh 0 0 0\nshin 0\n"
    "2\nroot 1 2 3 0 90 0\nthigh 90 0 0\nshin 90\n";

const MotionFileOptions kOptions{.metres_per_unit = 1.0, .up = "z", .rate_hz = 120.0, .interval = {}};

MotionFile parse(const std::string& amc, const std::string& asf = kAsf, const MotionFileOptions& options = kOptions) {
  return parse_amc(amc, "made.amc", asf, "made.asf", options);
}

Vec3 at(const MotionFile& file, std::size_t frame, const char* name) {
  return file.at(frame, file.find(name).value());
}

TEST(Acclaim, BonesAreNamedByTheirStartAndTipsByTheirEnd) {
  const MotionFile file = parse(kAmc);
  EXPECT_EQ(file.names, (std::vector<std::string>{"root", "thigh", "shin", "stump", "shin_end", "stump_end"}));
  EXPECT_EQ(file.frames(), 2U);
  EXPECT_EQ(file.rate_hz, 120.0);
}

TEST(Acclaim, RestPoseFollowsDirectionsAndLengths) {
  const MotionFile file = parse(kAmc);
  const Vec3 root(1, 2, 3);
  EXPECT_LT(glm::distance(at(file, 0, "shin"), root + Vec3(0, -7, 0)), 1e-12);
  EXPECT_LT(glm::distance(at(file, 0, "stump_end"), root + Vec3(2, 0, 0)), 1e-12);
  EXPECT_LT(glm::distance(at(file, 0, "shin_end"), root + Vec3(0, -7, 0) + 6.0 * glm::normalize(Vec3(0, -2, 1))),
            1e-12);
}

TEST(Acclaim, BonesTurnInTheirOwnAxes) {
  // The root turns by 90 about y: x becomes -z, z becomes x. The thigh turns by 90 about the x of its own axes, which
  // lie 20 degrees about z from the root's: C Rx(90) C^-1 (0, -7, 0).
  const MotionFile file = parse(kAmc);
  const double s = std::sin(20.0 * kPi / 180.0), c = std::cos(20.0 * kPi / 180.0);
  // C^-1 (0,-7,0) = (-7s, -7c, 0); Rx(90): (-7s, 0, -7c); C: (-7s c, -7 s s, -7c).
  const Vec3 in_root(-7 * s * c, -7 * s * s, -7 * c);
  const Vec3 in_world(in_root.z, in_root.y, -in_root.x);
  EXPECT_LT(glm::distance(at(file, 1, "shin"), Vec3(1, 2, 3) + in_world), 1e-12);
}

TEST(Acclaim, WithoutOwnAxesItIsTheSameAsABvh) {
  const std::string asf = replaced(kAsf, "axis 0 0 20 XYZ", "axis 0 0 0 XYZ");
  const std::string bvh =
      "HIERARCHY\nROOT root\n{\nOFFSET 0 0 0\n"
      "CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\n"
      "JOINT shin\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Yrotation Xrotation\n"
      "End Site\n{\nOFFSET 0 -7 0\n}\n}\n}\nMOTION\nFrames: 1\nFrame Time: 0.01\n"
      "1 2 3 13 -57 71 29 11 -42\n";
  const std::string amc = ":FULLY-SPECIFIED\n:DEGREES\n1\nroot 1 2 3 71 -57 13\nthigh -42 11 29\nshin 0\n";
  const MotionFile expected = parse_bvh(bvh, "same.bvh", kOptions);
  EXPECT_LT(glm::distance(at(parse(amc, asf), 0, "shin"), expected.at(0, 2)), 1e-12);
}

TEST(Acclaim, BonesThatAFrameLeavesOutAreAtRest) {
  const MotionFile file = parse(":DEGREES\n1\nroot 0 0 0 0 0 0\n2\nroot 0 0 0 0 0 0\nthigh 10 0 0\n");
  EXPECT_LT(glm::distance(at(file, 0, "shin"), Vec3(0, -7, 0)), 1e-12);
  EXPECT_GT(glm::distance(at(file, 1, "shin"), Vec3(0, -7, 0)), 1.0);
}

TEST(Acclaim, RadiansAreRead) {
  const std::string in_radians =
      replaced(replaced(replaced(kAmc, ":DEGREES", ":RADIANS"), "0 90 0", "0 1.5707963267948966 0"),
               "thigh 90 0 0\nshin 90", "thigh 1.5707963267948966 0 0\nshin 1.5707963267948966");
  EXPECT_LT(glm::distance(at(parse(in_radians), 1, "shin_end"), at(parse(kAmc), 1, "shin_end")), 1e-9);
}

TEST(Acclaim, MistakesAreNamed) {
  const auto amc = [](const std::string& from, const std::string& to) {
    return complaint([&] { (void)parse(replaced(kAmc, from, to)); });
  };
  const auto asf = [](const std::string& from, const std::string& to) {
    return complaint([&] { (void)parse(kAmc, replaced(kAsf, from, to)); });
  };
  MotionFileOptions no_rate = kOptions;
  no_rate.rate_hz = {};
  EXPECT_EQ(complaint([&] { (void)parse(kAmc, kAsf, no_rate); }), "made.amc: the file states no frame rate; give rate");
  EXPECT_EQ(asf("dof rx\n", "dof rx tz\n"),
            "made.asf:33: expected bones that only turn (dof rx, ry, rz): one that moves or stretches leaves its "
            "joint, found \"tz\"");
  EXPECT_NE(asf("dof rx\n", "dof rx l\n").find("that only turn"), std::string::npos);
  EXPECT_NE(asf("thigh shin\n", "thigh foot\n").find("expected the name of a bone, found \"foot\""), std::string::npos);
  EXPECT_NE(asf("root thigh stump", "root stump").find("loose"), std::string::npos);
  EXPECT_EQ(amc("shin 0", "shin"), "made.amc:7: expected 1 numbers of \"shin\", found only 0");
  EXPECT_EQ(amc("shin 0", "shin 0 1"), "made.amc:7: expected the line to end after 1 numbers of \"shin\", found \"1\"");
  EXPECT_NE(amc("shin 0", "tail 0").find("expected the name of a bone"), std::string::npos);
}

TEST(Acclaim, DamagedTextIsReadOrRefused) {
  for (std::size_t length = 0; length < kAsf.size(); ++length) {
    (void)complaint([&] { (void)parse(kAmc, kAsf.substr(0, length)); });
  }
  EXPECT_GT(survivors(kAsf, 10000, [](const std::string& text) { (void)parse(kAmc, text); }), 0U);
  EXPECT_GT(survivors(kAmc, 10000, [](const std::string& text) { (void)parse(text); }), 0U);
}

TEST(Acclaim, TheSkeletonIsFoundBesideTheMotion) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / "reachcast_acclaim_test";
  fs::remove_all(folder);
  fs::create_directories(folder);
  const auto write = [&](const std::string& name, const std::string& text) { std::ofstream(folder / name) << text; };
  write("02_01.amc", kAmc);
  const auto read = [&] { return read_motion((folder / "02_01.amc").string(), kOptions); };
  EXPECT_NE(complaint([&] { (void)read(); }).find("expected its skeleton 02_01.asf beside it, found no .asf"),
            std::string::npos);
  write("02.asf", kAsf);
  write("other.asf", "nonsense");
  EXPECT_EQ(read().frames(), 2U);
  MotionFileOptions given = kOptions;
  given.skeleton = (folder / "other.asf").string();
  EXPECT_NE(complaint([&] { (void)read_motion((folder / "02_01.amc").string(), given); }).find("other.asf:1"),
            std::string::npos);
  EXPECT_NE(complaint([&] { (void)read_motion((folder / "02.asf").string()); }).find("give the .amc"),
            std::string::npos);
  fs::remove_all(folder);
}

}  // namespace
