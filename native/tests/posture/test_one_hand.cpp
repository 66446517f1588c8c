// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <random>

#include "motion/made_one_handed.hpp"
#include "reachcast/posture/hold.hpp"
#include "reachcast/posture/twist.hpp"

namespace reachcast {
namespace {

using enum Joint;
constexpr double kTolerance_m = 1e-9;
constexpr double kClamped_m = 0.03;  // legs and a hanging arm are nearly straight: their stretches are clamped
const Vec3 kHold(0.3, 0.40, 1.0);

double elbow_bend(const Posture& p, bool left) {
  const auto at = [&](Joint right) { return p[index(left ? mirrored(right) : right)]; };
  return std::acos(glm::dot(glm::normalize(at(right_elbow) - at(right_shoulder)),
                            glm::normalize(at(right_wrist) - at(right_elbow))));
}

TEST(OneHand, DecodeInvertsEncodeAlsoOfTheFreeArm) {
  const Posture posture = tests::right_handed_posture(Body::from_stature(1.75), kHold, 0.2);
  const Body same = Body::from_posture(posture, 1.75);
  for (const Hands hands : {Hands::right, Hands::left}) {
    const Posture wanted = hands == Hands::right ? posture : mirrored(posture);
    const Body body = hands == Hands::right ? same : Body::from_posture(wanted, 1.75);
    const Anchors anchors = anchors_of(wanted, hands);
    const Decoded decoded =
        BodyLinkage(two_handed_linkage(), body).decode(encode_posture(two_handed_linkage(), wanted, 0.0, hands), anchors);
    HoldReport report;
    const Posture back = Holder(two_handed_linkage(), body, 70.0)
                             .hold(decoded, {Vec3(0.0), Vec3(0.0), decoded.wrist_from_grip}, anchors, {}, report);
    for (std::size_t j = 0; j < kJointCount; ++j)
      EXPECT_LT(glm::distance(back[j], wanted[j]), kClamped_m) << joint_names()[j] << ", " << hands_name(hands);
    const Joint grip = hands == Hands::right ? right_grip : left_grip;
    EXPECT_LT(glm::distance(back[index(grip)], wanted[index(grip)]), kTolerance_m);
  }
}

TEST(OneHand, TwistingBackUndoesIt) {
  const Posture posture = tests::right_handed_posture(Body::from_stature(1.75), kHold, 0.2);
  for (const double yaw : {-0.8, -0.2, 0.3, 0.8}) {
    const Posture back = twisted(twisted(posture, yaw, Hands::right), -yaw, Hands::right);
    for (std::size_t j = 0; j < kJointCount; ++j)
      EXPECT_LT(glm::distance(back[j], posture[j]), kTolerance_m) << joint_names()[j] << " at " << yaw;
  }
}

TEST(OneHand, AHangingHandFacesForwardAndTheSidesAreMirrorImages) {
  EXPECT_LT(std::abs(facing_yaw(Vec3(0.0), Vec3(0.25, 0.1, 0.7), Hands::right)), 0.15);
  EXPECT_LT(facing_yaw(Vec3(0.0), Vec3(0.75, 0.1, 1.0), Hands::right), -0.7);
  for (const Vec3& hold : {Vec3(0.3, 0.4, 1.0), Vec3(-0.2, 0.5, 0.9), Vec3(0.7, 0.0, 1.3)}) {
    EXPECT_NEAR(facing_yaw(Vec3(0.0), hold, Hands::right), -facing_yaw(Vec3(0.0), hold * Vec3(-1, 1, 1), Hands::left),
                1e-15);
  }
}

/// Any coordinates, any hang, on any body: segments and the working hand are exact, and what the free hand does moves
/// no trunk.
TEST(OneHand, TheFreeArmKeepsItsSegmentsAndPullsNothing) {
  std::mt19937_64 random(5);
  std::normal_distribution<> normal;
  std::uniform_real_distribution<> unit(-1, 1);
  for (int trial = 0; trial < 1000; ++trial) {
    const Body body = Body::from_stature(1.7 + 0.25 * unit(random), trial % 2 ? Sex::female : Sex::male);
    const BodyLinkage linkage(two_handed_linkage(), body);
    const Holder holder(two_handed_linkage(), body, 70.0);
    Eigen::VectorXd x(posture_coordinate_count(two_handed_linkage()));
    for (double& v : x) v = 1.5 * normal(random);
    Anchors anchors = anchors_of(body.posture(), trial % 3 ? Hands::right : Hands::left);
    const std::size_t side = working_side(anchors.hands);
    anchors.grip[side] =
        Vec3((side ? 0.3 : -0.3) + 0.4 * unit(random), 0.35 + 0.25 * unit(random), 1.0 + 0.5 * unit(random));
    const auto posture_with = [&](const Vec3& hang, HoldReport& report) {
      anchors.hang = hang;
      const Decoded decoded = linkage.decode(x, anchors);
      return holder.hold(decoded, {Vec3(0.0), Vec3(0.0), decoded.wrist_from_grip}, anchors, {}, report);
    };
    HoldReport report, other_report;
    const Posture posture = posture_with(Vec3(unit(random), unit(random), -0.5 + 0.5 * unit(random)), report);
    const Posture other = posture_with(Vec3(0.0, 0.0, -2.0), other_report);
    for (const auto& [a, b] : {std::pair{left_shoulder, left_elbow},
                               {left_elbow, left_wrist},
                               {left_wrist, left_grip},
                               {right_shoulder, right_elbow},
                               {right_elbow, right_wrist},
                               {right_wrist, right_grip}})
      ASSERT_NEAR(glm::distance(posture[index(a)], posture[index(b)]), body.distance(a, b), kTolerance_m);
    ASSERT_LE(elbow_bend(posture, side == 1), 2.45 + 1e-6);
    ASSERT_GE(elbow_bend(other, side == 1), 0.12 - 1e-6);
    for (const Joint j : {l5s1, left_hip, right_hip, left_shoulder, right_shoulder, tragion})
      ASSERT_EQ(posture[index(j)], other[index(j)]);
    if (report.shortfall_m > 0.0) continue;
    ASSERT_LT(glm::distance(posture[index(side ? right_grip : left_grip)], anchors.grip[side]), kTolerance_m);
  }
}

TEST(OneHand, AnObjectOutOfReachIsMissedByTheWorkingShoulder) {
  const Body body = Body::from_stature(1.75);
  for (const Hands hands : {Hands::left, Hands::right}) {
    Anchors anchors = anchors_of(body.posture(), hands);
    anchors.grip[working_side(hands)] += Vec3(0, 0, 3.0);
    HoldReport report;
    const Eigen::VectorXd x = encode_posture(two_handed_linkage(), body.posture(), 0.0, hands);
    (void)Holder(two_handed_linkage(), body, 70.0)
        .hold(BodyLinkage(two_handed_linkage(), body).decode(x, anchors), anchors, {}, report);
    EXPECT_GT(report.shortfall_m, 0.2);
    EXPECT_EQ(report.shortfall_from, hands == Hands::left ? left_shoulder : right_shoulder);
  }
}

}  // namespace
}  // namespace reachcast
