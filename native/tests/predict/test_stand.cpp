// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/stand.hpp"

#include <gtest/gtest.h>

#include "predict/predict_cases.hpp"

namespace reachcast {
namespace {

using enum Joint;

TEST(Stand, KeepsEverySegmentAndTheFeetAndBendsTheRightWay) {
  for (const double stature : {1.3, 1.5, 1.72, 1.95, 2.1}) {
    const Body body = Body::from_stature(stature);
    const Posture stand = standing_at_ease(body);
    Motion still;
    still.postures = {stand};
    EXPECT_LT(tests::worst_link(body, still), 1e-9);
    for (const Joint j : {left_ball, left_ankle, right_ball, right_ankle}) EXPECT_EQ(stand[index(j)], body.at(j));
    for (const auto& [hip, knee, ankle] :
         {std::array{left_hip, left_knee, left_ankle}, std::array{right_hip, right_knee, right_ankle}}) {
      const Vec3 middle = 0.5 * (stand[index(hip)] + stand[index(ankle)]);
      EXPECT_GT(stand[index(knee)].y, middle.y + 0.01) << "knees bend forwards";
    }
    for (const auto& [shoulder, elbow, wrist] :
         {std::array{left_shoulder, left_elbow, left_wrist}, std::array{right_shoulder, right_elbow, right_wrist}}) {
      const Vec3 middle = 0.5 * (stand[index(shoulder)] + stand[index(wrist)]);
      EXPECT_LT(stand[index(elbow)].y, middle.y - 0.01) << "elbows backwards";
    }
    EXPECT_LT(stand[index(left_grip)].x, stand[index(left_hip)].x - 0.03) << "hands hang clear of the thighs";
    EXPECT_NEAR(stand[index(left_grip)].x, -stand[index(right_grip)].x, 1e-12);
  }
}

}  // namespace
}  // namespace reachcast
