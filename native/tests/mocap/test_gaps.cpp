// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "mocap_cases.hpp"
#include "reachcast/mocap/gaps.hpp"
#include "reachcast/mocap/joint_map.hpp"
#include "reachcast/mocap/motion_file.hpp"

namespace {

using namespace reachcast;
using namespace reachcast::test;

/// Two points that move as a hand does, 100 Hz; the second one never lacks.
Clip swinging(std::size_t frames = 200) {
  Clip clip;
  clip.source = "swinging";
  clip.rate_hz = 100.0;
  clip.names = {"hand", "other"};
  clip.derived = {false, false};
  for (std::size_t i = 0; i < frames; ++i) {
    const double t = 0.01 * static_cast<double>(i);
    const Vec3 hand(0.4 * std::sin(4.0 * t), 0.5 * std::cos(3.0 * t), 1.0 + 0.3 * std::sin(5.0 * t + 1.0));
    clip.positions.push_back(hand);
    clip.positions.push_back(hand + Vec3(1.0));
  }
  return clip;
}

Clip with_gap(Clip clip, std::size_t first, std::size_t last) {
  for (std::size_t frame = first; frame <= last; ++frame) clip.at(frame, 0) = Vec3(kMissing);
  return clip;
}

TEST(FillGaps, ShortGapsComeCloseToWhatWasThere) {
  constexpr double tolerance_m = 0.004;  // a straight line is off by 14 mm here
  const Clip truth = swinging();
  for (const std::size_t first : {20, 77, 130}) {
    const Clip filled = fill_gaps(with_gap(truth, first, first + 18));
    double worst = 0.0, straight = 0.0;
    for (std::size_t frame = first; frame <= first + 18; ++frame) {
      worst = std::max(worst, glm::distance(filled.at(frame, 0), truth.at(frame, 0)));
      const double share = static_cast<double>(frame + 1 - first) / 20.0;
      const Vec3 line = glm::mix(truth.at(first - 1, 0), truth.at(first + 19, 0), share);
      straight = std::max(straight, glm::distance(line, truth.at(frame, 0)));
    }
    EXPECT_LT(worst, tolerance_m);
    EXPECT_LT(worst, 0.5 * straight);
  }
}

TEST(FillGaps, ParabolasComeBackExactly) {
  Clip clip = swinging();
  for (std::size_t frame = 0; frame < clip.frames(); ++frame) {
    const double t = 0.01 * static_cast<double>(frame);
    clip.at(frame, 0) = Vec3(1.0 + 2.0 * t - 0.5 * t * t, -t, 3.0 * t * t);
  }
  const Clip filled = fill_gaps(with_gap(clip, 50, 65));
  for (std::size_t frame = 50; frame <= 65; ++frame) {
    EXPECT_LT(glm::distance(filled.at(frame, 0), clip.at(frame, 0)), 1e-9);
  }
}

TEST(FillGaps, FilledFramesAreMarkedAndNothingElseChanges) {
  const Clip clip = with_gap(swinging(), 30, 40);
  const Clip filled = fill_gaps(clip);
  for (std::size_t frame = 0; frame < clip.frames(); ++frame) {
    const bool was_missing = frame >= 30 && frame <= 40;
    EXPECT_EQ(filled.filled[2 * frame] != 0, was_missing);
    EXPECT_EQ(filled.filled[2 * frame + 1], 0);
    EXPECT_EQ(filled.at(frame, 1), clip.at(frame, 1));
    if (was_missing) continue;
    EXPECT_EQ(filled.at(frame, 0), clip.at(frame, 0));
  }
}

TEST(FillGaps, LongGapsAndOpenEndsStayMissing) {
  const auto still_missing = [](std::size_t first, std::size_t last, double limit_s) {
    return !is_finite(fill_gaps(with_gap(swinging(), first, last), limit_s).at(first, 0));
  };
  EXPECT_FALSE(still_missing(50, 69, 0.2));
  EXPECT_TRUE(still_missing(50, 70, 0.2)) << "21 frames at 100 Hz";
  EXPECT_FALSE(still_missing(50, 70, 0.21));
  EXPECT_TRUE(still_missing(50, 50, 0.0));
  EXPECT_TRUE(still_missing(0, 3, 0.2));
  EXPECT_TRUE(still_missing(197, 199, 0.2));
}

TEST(FillGaps, OneRecordedFrameBetweenTwoGapsIsEnough) {
  const Clip clip = with_gap(with_gap(swinging(), 50, 55), 57, 60);
  const Clip filled = fill_gaps(clip);
  for (std::size_t frame = 50; frame <= 60; ++frame) EXPECT_TRUE(is_finite(filled.at(frame, 0)));
  EXPECT_EQ(filled.filled[2 * 56], 0);
}

TEST(FillGaps, LimitsOutOfRangeAreNamed) {
  EXPECT_EQ(complaint([] { (void)fill_gaps(swinging(), -0.1); }), "limit_s must be 0 to 2 s, not -0.1");
  EXPECT_EQ(complaint([] { (void)fill_gaps(swinging(), kMissing); }), "limit_s must be 0 to 2 s, not nan");
}

TEST(FillGaps, RecordedMotionIsRestored) {
  REACHCAST_NEED_MOCAP("c3d_trc/cmu_02_01.c3d");
  constexpr double tolerance_m = 0.04;  // 0.15 s about the lift of a toe
  const Clip truth = read_motion((mocap_folder() / "c3d_trc/cmu_02_01.c3d").string());
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t joint = 0; joint < truth.joints(); ++joint) {
    for (std::size_t first = 30; first + 60 < truth.frames(); first += 40) {
      Clip clip = truth;
      for (std::size_t frame = first; frame < first + 18; ++frame) clip.at(frame, joint) = Vec3(kMissing);
      const Clip filled = fill_gaps(clip);
      for (std::size_t frame = first; frame < first + 18; ++frame) {
        const double error = glm::distance(filled.at(frame, joint), truth.at(frame, joint));
        if (!is_finite(truth.at(frame, joint))) continue;
        EXPECT_LT(error, tolerance_m) << truth.names[joint] << ' ' << frame;
        sum += error;
        ++count;
      }
    }
  }
  RecordProperty("mean_error_mm", std::to_string(1000.0 * sum / static_cast<double>(count)));
  EXPECT_LT(sum / static_cast<double>(count), 0.003);
}

}  // namespace
