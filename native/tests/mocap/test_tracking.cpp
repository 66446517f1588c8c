// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "mocap_cases.hpp"
#include "reachcast/mocap/joint_map.hpp"
#include "reachcast/mocap/motion_file.hpp"
#include "reachcast/mocap/tracking.hpp"

namespace {

using namespace reachcast;
using namespace reachcast::test;

/// Four pairs of points that swing at walking pace, 100 Hz, 3 s, a millimetre of noise.
Clip walking() {
  Clip clip;
  clip.source = "walking";
  clip.rate_hz = 100.0;
  clip.names = {"LANK", "RANK", "LKNE", "RKNE", "LWRA", "RWRA", "LSHO", "RSHO"};
  clip.derived.assign(clip.names.size(), false);
  unsigned noise = 1;
  for (std::size_t frame = 0; frame < 300; ++frame) {
    const double t = 0.01 * static_cast<double>(frame);
    for (std::size_t joint = 0; joint < clip.names.size(); ++joint) {
      const double side = joint % 2 == 0 ? -1.0 : 1.0;
      noise = noise * 1664525U + 1013904223U;
      clip.positions.emplace_back(0.15 * side, 1.2 * t + 0.3 * side * std::sin(6.0 * t),
                                  0.1 + 0.4 * static_cast<double>(joint / 2) + 1e-3 * (noise >> 16) / 65536.0);
    }
  }
  return clip;
}

void exchange(Clip& clip, std::size_t a, std::size_t b, std::size_t first, std::size_t last) {
  for (std::size_t frame = first; frame <= last; ++frame) std::swap(clip.at(frame, a), clip.at(frame, b));
}

void expect_fault(const TrackingFault& fault, const std::string& joint, std::size_t first, std::size_t last,
                  const std::string& reason) {
  EXPECT_EQ(fault.joint, joint);
  EXPECT_EQ(fault.first, first);
  EXPECT_EQ(fault.last, last);
  EXPECT_NE(fault.reason.find(reason), std::string::npos) << fault.reason;
}

TEST(Tracking, SoundMotionHasNoFaults) {
  EXPECT_TRUE(check_tracking(walking()).empty());
}

TEST(Tracking, SpikesAreOneFault) {
  Clip clip = walking();
  clip.at(100, 4) += Vec3(0.2, 0, 0);
  const auto faults = check_tracking(clip);
  ASSERT_EQ(faults.size(), 1U);
  expect_fault(faults[0], "LWRA", 100, 100, "jumps 0.2 m away and back");
}

TEST(Tracking, ExcursionsAreOneFaultOverTheirFrames) {
  Clip clip = walking();
  for (std::size_t frame = 100; frame < 120; ++frame) clip.at(frame, 4) += Vec3(0, 0, 0.3);
  const auto faults = check_tracking(clip);
  ASSERT_EQ(faults.size(), 1U);
  expect_fault(faults[0], "LWRA", 100, 119, "jumps 0.3 m away and back");
}

TEST(Tracking, AJumpForGoodIsAFault) {
  Clip clip = walking();
  for (std::size_t frame = 150; frame < 300; ++frame) clip.at(frame, 6) += Vec3(0, 0, 0.3);
  const auto faults = check_tracking(clip);
  ASSERT_EQ(faults.size(), 1U);
  expect_fault(faults[0], "LSHO", 149, 150, "jumps 0.3 m");
}

TEST(Tracking, FrozenPointsAreFound) {
  Clip clip = walking();
  for (std::size_t frame = 100; frame < 150; ++frame) clip.at(frame, 2) = clip.at(100, 2);
  const auto faults = check_tracking(clip);
  ASSERT_FALSE(faults.empty());
  expect_fault(faults[0], "LKNE", 100, 149, "frozen for 0.5 s");
}

TEST(Tracking, FeetThatArePinnedToTheFloorAreNoFault) {
  Clip clip = walking();
  clip.names[2] = "left_ball";
  for (std::size_t frame = 100; frame < 150; ++frame) clip.at(frame, 2) = clip.at(100, 2);
  for (const TrackingFault& fault : check_tracking(clip)) EXPECT_EQ(fault.reason.find("frozen"), std::string::npos);
}

TEST(Tracking, AStillPersonIsNotFrozen) {
  Clip clip = walking();
  for (std::size_t frame = 1; frame < 300; ++frame) {
    for (std::size_t joint = 0; joint < clip.joints(); ++joint) clip.at(frame, joint) = clip.at(0, joint);
  }
  EXPECT_TRUE(check_tracking(clip).empty());
}

TEST(Tracking, ExchangedSidesAreFound) {
  Clip clip = walking();
  exchange(clip, 0, 1, 80, 109);
  const auto faults = check_tracking(clip);
  ASSERT_EQ(faults.size(), 2U);
  expect_fault(faults[0], "LANK", 80, 109, "exchanged with RANK");
  expect_fault(faults[1], "RANK", 80, 109, "exchanged with LANK");
}

TEST(Tracking, ExchangedToTheEndAndThroughout) {
  Clip to_end = walking();
  exchange(to_end, 0, 1, 250, 299);
  ASSERT_FALSE(check_tracking(to_end).empty());
  expect_fault(check_tracking(to_end)[0], "LANK", 250, 299, "exchanged with RANK");
  Clip from_start = walking();
  exchange(from_start, 0, 1, 0, 49);
  ASSERT_FALSE(check_tracking(from_start).empty());
  expect_fault(check_tracking(from_start)[0], "LANK", 0, 49, "exchanged with RANK");
  Clip throughout = walking();
  exchange(throughout, 4, 5, 0, 299);
  ASSERT_EQ(check_tracking(throughout).size(), 2U);
  expect_fault(check_tracking(throughout)[0], "LWRA", 0, 299, "exchanged with RWRA");
}

TEST(Tracking, MissingFramesAreNoFaults) {
  Clip clip = walking();
  for (std::size_t frame = 40; frame < 90; ++frame) clip.at(frame, 3) = Vec3(kMissing);
  EXPECT_TRUE(check_tracking(clip).empty());
}

TEST(Tracking, LimitsAreChecked) {
  EXPECT_EQ(complaint([] { (void)check_tracking(walking(), {.frozen_s = 0.0}); }), "frozen must be over 0, not 0");
}

TEST(Tracking, RecordedLiftsAreSoundButForTheirKnownFault) {
  REACHCAST_NEED_MOCAP("omomo");
  REACHCAST_NEED_MOCAP("lieblich_lifting");
  for (const auto& entry : std::filesystem::directory_iterator(mocap_folder() / "omomo")) {
    if (entry.path().filename() == "clips.csv") continue;
    EXPECT_TRUE(check_tracking(to_canonical(read_motion(entry.path().string()))).empty()) << entry.path();
  }
  const auto faults =
      check_tracking(to_canonical(read_motion((mocap_folder() / "lieblich_lifting/S1_dip1.csv").string())));
  ASSERT_EQ(faults.size(), 1U);  // its table says that the left shank is unstable
  EXPECT_EQ(faults[0].joint, "left_ankle");
  EXPECT_NE(faults[0].reason.find("distance from left_knee"), std::string::npos);
}

}  // namespace
