// SPDX-License-Identifier: GPL-3.0-or-later
// What a rig's rest pose says of its hinges and palms: any rest must serve the same motion.
#include <gtest/gtest.h>

#include "reachcast/rig/retarget.hpp"
#include "rig/rig_cases.hpp"

namespace reachcast {
namespace {

using tests::kRounding;

/// Straightens an arm along a unit direction.
void point_arm(Posture& posture, const ArmNames& arm, const Vec3& along) {
  const auto extend = [&](Joint from, Joint to, double length) {
    posture[index(to)] = posture[index(from)] + length * along;
  };
  extend(arm.shoulder, arm.elbow, 0.3);
  extend(arm.elbow, arm.wrist, 0.26);
  extend(arm.wrist, arm.grip, 0.08);
}

Mat3 turn_of(const RestRig& rest, const RigPose& pose, Segment segment) {
  return pose.turns_of(rest.slot(rest.bone(segment)))[0];
}

/// Arms that point to the sides (T pose) have palms down, arms that point ahead have palms inwards.
TEST(RestHinges, PalmsFaceEachOtherWhateverTheRestPose) {
  const Vec3 ahead(0, 1, 0), down(0, 0, -1);
  for (const bool is_t_pose : {true, false}) {
    tests::RigParts parts = tests::made_rig();
    std::array<Vec3, 2> palms;
    for (std::size_t side = 0; side < 2; ++side) {
      const Vec3 outwards(side == 0 ? -1 : 1, 0, 0);
      point_arm(parts.joints, arms()[side], is_t_pose ? outwards : ahead);
      palms[side] = is_t_pose ? down : -outwards;
    }
    const RestRig rest = parts.rig();
    for (const auto& [left, right] : {std::pair{ahead, ahead}, {down, down}, {ahead, down}, {down, ahead}}) {
      Posture posture = parts.joints;
      point_arm(posture, arms()[0], left);
      point_arm(posture, arms()[1], right);
      const RigPose pose = retarget(rest, std::span(&posture, 1));
      for (std::size_t side = 0; side < 2; ++side) {
        const ArmNames& arm = arms()[side];
        const Vec3 towards = posture[index(arm.other_grip)] - posture[index(arm.grip)];
        const Vec3 wanted = glm::normalize(across(towards, side == 0 ? left : right));
        EXPECT_LT(glm::distance(turn_of(rest, pose, arm.hand) * palms[side], wanted), kRounding)
            << segment_name(arm.hand) << (is_t_pose ? ", T pose" : ", arms ahead");
      }
    }
  }
}

/// Knees that rest straight, bent (also outwards, about an axis of their own) or the wrong way all flex forwards.
TEST(RestHinges, KneesFlexForwardsWhateverTheRestPose) {
  for (const auto& [rest_bend, yaw] : {std::pair{0.0, 0.0}, {0.4, 0.0}, {0.4, 0.5}, {-0.2, 0.0}}) {
    const Vec3 axis(std::cos(yaw), std::sin(yaw), 0.0);
    tests::RigParts parts = tests::made_rig();
    Posture posture = parts.joints;
    for (const LegNames& leg : legs()) {
      const auto bend = [&leg = leg, &axis = axis](
                            Posture& at, double angle) {  // forwards positive: the thigh ahead, the shin behind
        const Vec3 hip = at[index(leg.hip)], foot = at[index(leg.ball)] - at[index(leg.ankle)];
        at[index(leg.knee)] = hip + 0.4 * (turn_about(axis, 0.5 * angle) * Vec3(0, 0, -1));
        at[index(leg.ankle)] = at[index(leg.knee)] + 0.4 * (turn_about(axis, -0.5 * angle) * Vec3(0, 0, -1));
        at[index(leg.ball)] = at[index(leg.ankle)] + foot;
      };
      bend(parts.joints, rest_bend);
      bend(posture, 1.2);
    }
    const RestRig rest = parts.rig();
    const RigPose pose = retarget(rest, std::span(&posture, 1));
    for (const LegNames& leg : legs()) {
      const double half = 0.5 * (1.2 - rest_bend);
      EXPECT_LT(tests::difference(turn_of(rest, pose, leg.thigh), turn_about(axis, half)), kRounding) << rest_bend;
      EXPECT_LT(tests::difference(turn_of(rest, pose, leg.shin), turn_about(axis, -half)), kRounding) << rest_bend;
    }
  }
}

}  // namespace
}  // namespace reachcast
