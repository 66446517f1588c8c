// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/rig/turns.hpp"

#include <gtest/gtest.h>

#include "rig/rig_cases.hpp"

namespace reachcast {
namespace {

using tests::difference;
using tests::kRounding;

constexpr double kNearlyOpposed = 1e-8;  // 1e-7 from opposite, their cross product has lost seven digits

void expect_rotation(const Mat3& turn) {
  EXPECT_LT(difference(glm::transpose(turn) * turn, Mat3(1.0)), 1e-9);
  EXPECT_NEAR(glm::determinant(turn), 1.0, 1e-9);
}

TEST(Turns, SmallestTurnIsARotationEvenBackwards) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 200; ++i) {
    const Vec3 start = tests::random_direction(random), other = tests::random_direction(random);
    const Vec3 nearly = glm::normalize(-start + 1e-7 * other);
    for (const Vec3& end : {other, start, -start, nearly}) {
      const Mat3 turn = smallest_turn(start, end);
      expect_rotation(turn);
      EXPECT_LT(glm::distance(turn * start, end), kNearlyOpposed);
    }
  }
}

TEST(Turns, SmallestTurnKeepsWhatIsAcrossBoth) {
  const Vec3 start(1, 0, 0), end = glm::normalize(Vec3(1, 2, 0));
  EXPECT_LT(glm::distance(smallest_turn(start, end) * Vec3(0, 0, 1), Vec3(0, 0, 1)), kRounding);
}

TEST(Turns, TurnAboutAgreesWithQuaternions) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 100; ++i) {
    const Vec3 axis = tests::random_direction(random);
    EXPECT_LT(difference(turn_about(axis, 0.1 * i), glm::mat3_cast(glm::angleAxis(0.1 * i, axis))), kRounding);
  }
}

TEST(Turns, FramesAreRightHandedEvenWithoutASecondDirection) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 50; ++i) {
    const Vec3 primary = 3.0 * tests::random_direction(random), other = tests::random_direction(random);
    for (const Vec3& secondary : {other, primary, -2.0 * primary, Vec3(0.0)}) {
      const Mat3 frame = frame_towards(primary, secondary);
      expect_rotation(frame);
      EXPECT_LT(glm::distance(3.0 * frame[0], primary), kRounding);
    }
    EXPECT_GE(glm::dot(frame_towards(primary, other)[1], other), 0.0);
  }
}

TEST(Turns, SignedAngleUndoesTurning) {
  const Vec3 axis = glm::normalize(Vec3(1, -2, 0.5)), start = any_across(axis);
  for (const double angle : {-3.1, -1.0, 0.0, 0.4, 2.0, 3.1}) {
    EXPECT_NEAR(signed_angle(start, turn_about(axis, angle) * start, axis), angle, kRounding);
    EXPECT_LT(glm::distance(turned_towards(start, turn_about(axis, angle) * start, axis, 0.25),
                            turn_about(axis, 0.25 * angle) * start),
              kRounding);
  }
}

}  // namespace
}  // namespace reachcast
