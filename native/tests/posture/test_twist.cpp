// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/twist.hpp"

#include <gtest/gtest.h>

#include "motion/made_lift.hpp"
#include "reachcast/posture/whole_body.hpp"

namespace reachcast {
namespace {

TEST(Twist, TwistingBackUndoesIt) {
  const Body body = Body::from_stature(1.75, Sex::male);
  const Posture posture = tests::holding_posture(body, Vec3(0.02, 0.42, 0.95), 0.4);
  for (const double yaw : {-0.6, -0.2, 0.0, 0.3, 0.6}) {
    const Posture back = twisted(twisted(posture, yaw), -yaw);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      EXPECT_LT(glm::distance(back[j], posture[j]), 1e-9) << joint_names()[j] << " at " << yaw;
    }
  }
}

TEST(Twist, FacingFollowsTheHandsAndLeavesTheFeet) {
  const Body body = Body::from_stature(1.75);
  const Posture posture = tests::holding_posture(body, Vec3(0.0, 0.45, 1.0), 0.4);
  EXPECT_NEAR(facing_yaw(anchors_of(posture)), 0.0, 1e-9);
  const Posture left = twisted(posture, 0.5);
  EXPECT_GT(facing_yaw(anchors_of(left)), 0.3);
  EXPECT_EQ(left[index(Joint::left_ankle)], posture[index(Joint::left_ankle)]);
}

TEST(SmallestRotation, TurnsOneDirectionIntoTheOtherAlsoWhenTheyAreOpposite) {
  for (const Vec3& to : {Vec3(0, 0, 1), Vec3(1, 2, -0.5), Vec3(-1, 0, 0), Vec3(0, 0, -1)}) {
    for (const Vec3& from : {Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(0.3, -0.2, 0.9)}) {
      EXPECT_LT(glm::distance(smallest_rotation(from, to) * glm::normalize(from), glm::normalize(to)), 1e-9);
      const Vec3 any(0.2, -0.7, 0.4);
      EXPECT_LT(glm::distance(carried_along(glm::normalize(from), glm::normalize(to), any),
                              smallest_rotation(from, to) * any),
                1e-9);
    }
  }
}

}  // namespace
}  // namespace reachcast
