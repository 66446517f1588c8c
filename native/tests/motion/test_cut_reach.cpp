// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "reachcast/motion/cut_reach.hpp"

namespace {

using namespace reachcast;
using enum Joint;

constexpr double kTolerance_m = 1e-12;
const Subject kSubject{.stature_m = 1.8, .sex = {}, .age_years = {}, .mass_kg = {}};

template <typename Call>
std::string complaint(Call call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

/// 41 frames at 20 Hz; both grips rise by 1 m between frames 10 and 30, smoothly; everything else stands still.
/// In the body frame; `placed` moves and turns it.
Clip lifting_person() {
  Clip clip;
  clip.source = "made.csv";
  clip.rate_hz = 20.0;
  clip.names.assign(joint_names().begin(), joint_names().end());
  clip.derived.assign(kJointCount, false);
  for (int frame = 0; frame <= 40; ++frame) {
    const double phase = std::clamp((frame - 10) / 20.0, 0.0, 1.0);
    const double rise = 0.5 - 0.5 * std::cos(kPi * phase);
    for (std::size_t joint = 0; joint < kJointCount; ++joint) {
      const std::string name(joint_names()[joint]);
      const double side = name.starts_with("left") ? -1.0 : name.starts_with("right") ? 1.0 : 0.0;
      Vec3 point(0.2 * side, 0.01 * static_cast<double>(joint), 0.9);
      if (name.ends_with("ankle")) point = {0.1 * side, 0.0, 0.08};
      if (name.ends_with("hip")) point = {0.1 * side, 0.0, 0.9};
      if (name.ends_with("ball")) point = {0.1 * side, 0.15, 0.04};
      if (name.ends_with("grip")) point = {0.2 * side, 0.4, 0.3 + rise};
      clip.positions.push_back(point);
    }
  }
  return clip;
}

Clip placed(Clip clip, double angle, const Vec3& shift) {
  for (Vec3& p : clip.positions) {
    p = Vec3(std::cos(angle) * p.x - std::sin(angle) * p.y, std::sin(angle) * p.x + std::cos(angle) * p.y, p.z) + shift;
  }
  return clip;
}

TEST(CutReach, TheBodyFrameUndoesWhereAndHowOneStands) {
  const Clip clip = lifting_person();
  for (const double angle : {0.0, 1.0, 2.5, -3.0}) {
    const Clip elsewhere = placed(clip, angle, {4.0, -5.0, 0.7});
    const Reach reach =
        cut_reach(elsewhere, 10, 30, kSubject, Phase::transfer, "here", {.floor_z = 0.7, .longest_gap_s = 0.1});
    ASSERT_EQ(reach.frames(), 21U);
    EXPECT_DOUBLE_EQ(reach.duration_s, 1.0);
    EXPECT_EQ(reach.origin, "here");
    for (std::size_t frame = 0; frame < reach.frames(); ++frame) {
      for (std::size_t joint = 0; joint < kJointCount; ++joint) {
        EXPECT_LT(glm::distance(reach.postures[frame][joint], clip.at(10 + frame, joint)), kTolerance_m);
      }
    }
  }
}

TEST(CutReach, HoldPointIsMidwayBetweenTheGrips) {
  const Reach reach =
      cut_reach(lifting_person(), 10, 30, kSubject, Phase::transfer, "", {.floor_z = 0.0, .longest_gap_s = 0.1});
  EXPECT_LT(glm::distance(reach.hold_point(0), Vec3(0, 0.4, 0.3)), kTolerance_m);
  EXPECT_LT(glm::distance(reach.hold_point(20), Vec3(0, 0.4, 1.3)), kTolerance_m);
  EXPECT_EQ(reach.origin, "made.csv:10-30");
}

TEST(CutReach, TheFloorIsBelowTheLowestFoot) {
  const Clip clip = lifting_person();
  EXPECT_NEAR(estimate_floor(clip, {0, 40}, 1.8), 0.04 - 0.02 * 1.8, kTolerance_m);
}

TEST(CutReach, ShortGapsAreBridgedByStraightLines) {
  Clip clip = lifting_person();
  const Vec3 before = clip.at(14, index(left_grip));
  const Vec3 after = clip.at(17, index(left_grip));
  clip.at(15, index(left_grip)).y = kMissing;
  clip.at(16, index(left_grip)) = Vec3(kMissing);
  const Reach reach = cut_reach(clip, 10, 30, kSubject, Phase::reach, "", {.floor_z = 0.0, .longest_gap_s = 0.1});
  EXPECT_LT(glm::distance(reach.postures[5][index(left_grip)], glm::mix(before, after, 1.0 / 3.0)), kTolerance_m);
  EXPECT_LT(glm::distance(reach.postures[6][index(left_grip)], glm::mix(before, after, 2.0 / 3.0)), kTolerance_m);
}

TEST(CutReach, LongGapsAreRefusedWithTheirLength) {
  Clip clip = lifting_person();
  for (std::size_t frame = 15; frame < 19; ++frame) clip.at(frame, index(left_grip)) = Vec3(kMissing);
  EXPECT_EQ(complaint([&] { (void)cut_reach(clip, 10, 30, kSubject, Phase::reach); }),
            "made.csv: left_grip is missing in frames 15 to 18, for 0.2 s; at most 0.1 s can be bridged");
  EXPECT_EQ(complaint([&] { (void)cut_reach(clip, 19, 30, kSubject, Phase::reach); }), "");
  clip.at(40, index(nasion)) = Vec3(kMissing);
  EXPECT_EQ(complaint([&] { (void)cut_reach(clip, 30, 40, kSubject, Phase::reach); }),
            "made.csv: nasion is missing from frame 39 to 40, at an end of the recording");
}

TEST(CutReach, CallersMistakesAreNamed) {
  const Clip clip = lifting_person();
  EXPECT_EQ(complaint([&] { (void)cut_reach(clip, 10, 12, kSubject, Phase::reach); }),
            "made.csv: frames 10 to 12 are fewer than the 4 needed");
  EXPECT_EQ(complaint([&] { (void)cut_reach(clip, 10, 41, kSubject, Phase::reach); }),
            "made.csv: frames 10 to 41 do not lie within 0 to 40");
  EXPECT_EQ(complaint([&] { (void)cut_reach(clip, 30, 10, kSubject, Phase::reach); }),
            "made.csv: frames 30 to 10 do not lie within 0 to 40");
  Subject giant = kSubject;
  giant.stature_m = 18.0;
  EXPECT_EQ(complaint([&] { (void)cut_reach(clip, 10, 30, giant, Phase::reach); }),
            "stature must be 0.5 to 2.6 m, not 18");
  Clip other = clip;
  std::swap(other.names[0], other.names[1]);
  EXPECT_EQ(complaint([&] { (void)cut_reach(other, 10, 30, kSubject, Phase::reach); }),
            "made.csv: the clip is not in the canonical joints; convert it first");
  Clip twisted = clip;
  std::swap(twisted.at(10, index(left_hip)), twisted.at(10, index(right_hip)));
  EXPECT_EQ(complaint([&] { (void)cut_reach(twisted, 10, 30, kSubject, Phase::reach); }).substr(0, 40),
            "made.csv: frame 0: hips and ankles are m");
}

TEST(TrimByHandSpeed, KeepsTheFramesAtAPartOfThePeakSpeed) {
  const Clip clip = lifting_person();
  // The speed of the rise is a half sine over frames 10 to 30: a tenth of its peak lies 0.64 frames from its ends.
  const FrameRange tenth = trim_by_hand_speed(clip, 0, 40);
  EXPECT_EQ(tenth.first, 11U);
  EXPECT_EQ(tenth.last, 29U);
  const FrameRange half = trim_by_hand_speed(clip, 0, 40, 0.5);
  EXPECT_EQ(half.first, 14U);
  EXPECT_EQ(half.last, 26U);
  const FrameRange all = trim_by_hand_speed(clip, 5, 38, 0.0);
  EXPECT_EQ(all.first, 5U);
  EXPECT_EQ(all.last, 38U);
  EXPECT_EQ(complaint([&] { (void)trim_by_hand_speed(clip, 0, 8); }),
            "made.csv: the hands do not move in frames 0 to 8");
}

TEST(Reach, MirroringTwiceGivesTheSame) {
  Reach reach = cut_reach(lifting_person(), 10, 30, kSubject, Phase::retrieve);
  reach.derived[index(left_ball)] = true;
  const Reach image = mirrored(reach);
  EXPECT_TRUE(image.derived[index(right_ball)]);
  EXPECT_FALSE(image.derived[index(left_ball)]);
  EXPECT_EQ(image.postures[3][index(left_elbow)], reach.postures[3][index(right_elbow)] * Vec3(-1, 1, 1));
  EXPECT_EQ(image.postures[3][index(c7t1)], reach.postures[3][index(c7t1)] * Vec3(-1, 1, 1));
  EXPECT_EQ(mirrored(image).postures, reach.postures);
}

TEST(Phase, NamesAndPhasesBelongTogether) {
  for (const Phase phase : {Phase::transfer, Phase::return_, Phase::reach, Phase::retrieve}) {
    EXPECT_EQ(find_phase(phase_name(phase)), phase);
  }
  EXPECT_EQ(phase_name(Phase::return_), "return");
  EXPECT_FALSE(find_phase("return_"));
  EXPECT_FALSE(find_phase(""));
}

}  // namespace
