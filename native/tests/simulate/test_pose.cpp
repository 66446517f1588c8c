// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "simulate_cases.hpp"

namespace reachcast::simulate::tests {
namespace {

using enum Joint;

constexpr double kExact_m = 1e-9;  // far below a hair; what chains of double precision leave

/// Links that no posture may stretch: limbs, hands, feet, pelvis, chest, clavicles, head.
constexpr std::array<std::pair<Joint, Joint>, 23> kLinks{{{left_ankle, left_knee},
                                                          {left_knee, left_hip},
                                                          {right_ankle, right_knee},
                                                          {right_knee, right_hip},
                                                          {left_hip, right_hip},
                                                          {left_hip, l5s1},
                                                          {right_hip, l5s1},
                                                          {l5s1, c7t1},
                                                          {l5s1, suprasternale},
                                                          {c7t1, suprasternale},
                                                          {left_clavicle, c7t1},
                                                          {right_clavicle, l5s1},
                                                          {left_clavicle, left_shoulder},
                                                          {right_clavicle, right_shoulder},
                                                          {left_shoulder, left_elbow},
                                                          {right_shoulder, right_elbow},
                                                          {left_elbow, left_wrist},
                                                          {right_elbow, right_wrist},
                                                          {left_wrist, left_grip},
                                                          {right_wrist, right_grip},
                                                          {c7t1, tragion},
                                                          {tragion, nasion},
                                                          {right_ball, right_ankle}}};

double worst_length(const Body& body, const Posture& posture) {
  double worst = 0.0;
  for (const auto& [a, b] : kLinks)
    worst = std::max(worst, std::abs(glm::distance(posture[index(a)], posture[index(b)]) - body.distance(a, b)));
  return worst;
}

double worst_anchor(const Anchors& wanted, const Posture& posture) {
  const Anchors got = anchors_of(posture);
  double worst = 0.0;
  for (const std::size_t side : {0u, 1u}) {
    worst = std::max({worst, glm::distance(got.ball[side], wanted.ball[side]),
                      glm::distance(got.ankle[side], wanted.ankle[side]),
                      glm::distance(got.grip[side], wanted.grip[side])});
  }
  return worst;
}

TEST(Pose, AnyNumbersHoldHandsFeetAndLengthsExactly) {
  std::mt19937_64 random(7);
  for (const Person& person : people()) {
    const PoseModel model(person.body, *person.subject.mass_kg);
    for (const Vec3& place : {kOnFloor, kAtWaist, kAtEyes, kAtSide}) {
      const Holding holding = holding_at(model, place, 5.0);
      for (const double spread : {0.2, 0.6, 1.2}) {
        const Pose pose = model.pose(random_unknowns(random, spread), holding.anchors, holding.load);
        EXPECT_LT(worst_length(person.body, pose.posture), kExact_m) << person.subject.stature_m;
        if (pose.held.shortfall_m == 0.0) {
          EXPECT_LT(worst_anchor(holding.anchors, pose.posture), kExact_m);
        }
      }
    }
  }
}

TEST(Pose, StraightAheadTheChainAloneHoldsAndIsItsOwnMirrorImage) {
  std::mt19937_64 random(8);
  const Person& person = people()[14];
  const PoseModel model(person.body, *person.subject.mass_kg);
  for (const Vec3& place : {kOnFloor, kAtWaist, kAtEyes}) {
    const Holding holding = holding_at(model, place, 5.0);
    Unknowns x = random_unknowns(random, 0.4);
    for (const Unknown sided : {Unknown::pelvis_yaw, Unknown::chest_yaw, Unknown::sway, Unknown::neck_yaw})
      x[static_cast<Eigen::Index>(sided)] = 0.0;
    const Pose pose = model.pose(x, holding.anchors, holding.load);
    EXPECT_LT(pose.held.trunk_shift_m, 5e-3);  // widths of hips, feet, shoulders and hands differ a little
    const Posture other = mirrored(pose.posture);
    for (std::size_t j = 0; j < kJointCount; ++j)
      EXPECT_LT(glm::distance(other[j], pose.posture[j]), 1e-6) << joint_names()[j];
  }
}

TEST(Pose, KneesAndElbowsKeepTheirLimitsAndBendTheRightWay) {
  std::mt19937_64 random(9);
  for (const Person& person : {people()[0], people()[9], people()[19]}) {
    const PoseModel model(person.body, *person.subject.mass_kg);
    for (const Vec3& place : {kOnFloor, kAtWaist, kAtEyes, kAtSide}) {
      const Holding holding = holding_at(model, place, 5.0);
      for (int i = 0; i < 30; ++i) {
        const Pose pose = model.pose(random_unknowns(random, 0.7), holding.anchors, holding.load);
        if (pose.held.shortfall_m > 0.0) continue;
        const JointAngles angles = joint_angles(pose);
        for (const std::size_t side : {0u, 1u}) {
          EXPECT_GE(angles.knee[side], 0.07 - 1e-6);
          EXPECT_LE(angles.knee[side], 2.35 + 1e-6);
          EXPECT_GE(angles.elbow[side], 0.12 - 1e-6);
          EXPECT_LE(angles.elbow[side], 2.45 + 1e-6);
          const auto of = [&](Joint left) { return pose.posture[index(side == 0 ? left : reachcast::mirrored(left))]; };
          const Vec3 middle = 0.5 * (of(left_hip) + of(left_ankle));
          EXPECT_GT((of(left_knee) - middle).y, -1e-3) << "a knee bends backwards";
        }
      }
    }
  }
}

TEST(Pose, WhatNobodyCanReachIsSaid) {
  const PoseModel model(people()[0].body, 50.0);
  const Holding far_away = holding_at(model, Vec3(0.0, 1.5, 0.6), 5.0);
  EXPECT_GT(model.pose(Unknowns::Zero(), far_away.anchors, far_away.load).held.shortfall_m, 0.1);
}

}  // namespace
}  // namespace reachcast::simulate::tests
