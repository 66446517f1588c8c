// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/twist.hpp"

#include <array>
#include <cmath>

#include "reachcast/posture/limb.hpp"
#include "reachcast/posture/whole_body.hpp"

namespace reachcast {
namespace {

constexpr double kSeenFrom_m = 0.1;                               // behind the ankles
constexpr double kOneHandBehind_m = 0.3, kOneHandAside_m = 0.22;  // where one hand is seen from; it hangs so far aside
constexpr double kPelvisShare = 0.4;  // feet on the floor: some 35 degrees of hip rotation at a full side reach
constexpr double kChestShare = 0.8;   // and as much again between pelvis and chest

/// Joints that move as one with the end of each limb, in the order of Linkage::limbs.
const std::array<std::vector<Joint>, kLimbCount>& carried_by_ends() {
  using enum Joint;
  static const std::array<std::vector<Joint>, kLimbCount> joints{{{left_ball},
                                                                  {right_ball},
                                                                  {left_grip, left_hand_front, left_hand_back},
                                                                  {right_grip, right_hand_front, right_hand_back}}};
  return joints;
}

}  // namespace

double facing_yaw(const Vec3& between_ankles, const Vec3& hold_point, Hands hands) {
  Vec3 from = between_ankles - Vec3(0.0, hands == Hands::both ? kSeenFrom_m : kOneHandBehind_m, 0.0);
  if (hands != Hands::both) from.x += hands == Hands::left ? -kOneHandAside_m : kOneHandAside_m;
  return std::atan2(-(hold_point.x - from.x), hold_point.y - from.y);
}

double facing_yaw(const Anchors& anchors) {
  return facing_yaw(0.5 * (anchors.ankle[0] + anchors.ankle[1]), hold_point(anchors), anchors.hands);
}

Anchors with_grips_turned(const Anchors& anchors, double yaw_rad) {
  const Vec3 feet = 0.5 * (anchors.ankle[0] + anchors.ankle[1]);
  Anchors out = anchors;
  const Yaw turn(yaw_rad);
  for (Vec3& grip : out.grip) grip = feet + turn(grip - feet);
  return out;
}

Posture turned_trunk(const Posture& posture, double yaw_rad) {
  using enum Joint;
  const Vec3 feet = 0.5 * (posture[index(left_ankle)] + posture[index(right_ankle)]);
  const Yaw pelvis(kPelvisShare * yaw_rad), chest(kChestShare * yaw_rad);
  Posture out = posture;
  for (const Joint j : {left_hip, right_hip, l5s1}) out[index(j)] = feet + pelvis(posture[index(j)] - feet);
  for (const Joint j :
       {c7t1, suprasternale, left_clavicle, right_clavicle, left_shoulder, right_shoulder, tragion, nasion}) {
    out[index(j)] = out[index(l5s1)] + chest(posture[index(j)] - posture[index(l5s1)]);
  }
  return out;
}

Posture twisted(const Posture& posture, double yaw_rad, Hands hands) {
  using enum Joint;
  const Vec3 feet = 0.5 * (posture[index(left_ankle)] + posture[index(right_ankle)]);
  Posture out = turned_trunk(posture, yaw_rad);
  for (std::size_t i = 0; i < kLimbCount; ++i) {
    const LimbSpec& limb = two_handed_linkage().limbs[i];
    const bool is_arm = i >= 2;
    const LimbPlane plane = plane_of(limb, posture);
    const bool is_free = is_arm && !works(hands, i - 2);
    const Vec3 about = is_free ? posture[index(limb.root)] : feet, carried = is_free ? out[index(limb.root)] : feet;
    const Vec3 end = is_arm ? carried + turned(posture[index(limb.end)] - about, yaw_rad) : posture[index(limb.end)];
    span_limb(limb, chain_of(limb, posture, false),
              {turned(plane.normal, limb.turn * yaw_rad), turned(plane.axis, limb.turn * yaw_rad)}, end, out);
    for (const Joint j : carried_by_ends()[i]) {
      out[index(j)] =
          out[index(limb.end)] + turned(posture[index(j)] - posture[index(limb.end)], is_arm ? yaw_rad : 0.0);
    }
  }
  return out;
}

}  // namespace reachcast
