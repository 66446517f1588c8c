// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/stance_track.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace reachcast {
namespace {

std::vector<Stance> stances(std::size_t count, const std::function<double(std::size_t)>& height) {
  std::vector<Stance> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    out[i].shift.z = height(i);
    out[i].wrist_from_grip = {Vec3(0, -0.1, 0), Vec3(0, -0.1, 0)};
  }
  return out;
}

TEST(StanceTrack, KeepsWhatDoesNotChange) {
  const StanceTrack track(stances(40, [](std::size_t) { return 0.3; }), 0.04);
  for (double t = -0.1; t < 2.0; t += 0.013) {
    EXPECT_NEAR(track.at(t).shift.z, 0.3, 1e-12);
    EXPECT_NEAR(track.at(t).wrist_from_grip[1].y, -0.1, 1e-12);
  }
}

TEST(StanceTrack, AJumpBecomesASlopeWhateverTheFrames) {
  const StanceTrack track(stances(60, [](std::size_t i) { return i < 30 ? 0.0 : 0.2; }), 0.04);
  double last_speed = 0.0;
  for (const double step : {1e-2, 1e-3, 1e-4}) {
    double fastest = 0.0;
    for (double t = 0.0; t < 2.3; t += step)
      fastest = std::max(fastest, (track.at(t + step).shift.z - track.at(t).shift.z) / step);
    // A Gaussian of 0.1 s turns a step of 0.2 m into at most 0.2 / (0.1 sqrt(2 pi)) m/s.
    EXPECT_NEAR(fastest, 0.2 / (0.1 * std::sqrt(2.0 * kPi)), 0.06);
    if (last_speed > 0.0) {
      EXPECT_NEAR(fastest, last_speed, 0.05);
    }
    last_speed = fastest;
  }
}

}  // namespace
}  // namespace reachcast
