// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "reachcast/posture/weight.hpp"
#include "reachcast/simulate/effort.hpp"

namespace reachcast::simulate {
namespace {

using enum Joint;

// Winter (2009), table 4.1: foot .0145, shank .0465 of the body's mass.
constexpr double kShankAndFoot = 0.061;

Vec3 level(const Vec3& v) {
  const Vec3 flat(v.x, v.y, 0.0);
  const double size = glm::length(flat);
  return size > 1e-9 ? flat / size : Vec3(0, 1, 0);
}

/// Forward of a part of the trunk, level, also where the trunk lies level itself.
Vec3 forward_of(const Mat3& frame) {
  return level(glm::cross(Vec3(0, 0, 1), frame[0]));
}

}  // namespace

JointMoments joint_moments(const Pose& pose, double body_mass_kg, const Holding& holding) {
  const Posture& p = pose.posture;
  JointMoments out;
  const Vec3 back = back_moment(p, body_mass_kg, holding.load);
  const Vec3 ahead = forward_of(pose.frames.chest);
  out.back_forward = glm::dot(back, ahead);
  out.back_sideways = glm::dot(back, Vec3(ahead.y, -ahead.x, 0.0));

  const Vec3 centre = centre_of_mass(p, body_mass_kg, holding.load);
  const double half_weight =
      0.5 * kGravity * (body_mass_kg + holding.load.mass_kg - 2.0 * kShankAndFoot * body_mass_kg);
  for (const std::size_t side : {0u, 1u}) {
    const Vec3 knee = p[index(side == 0 ? left_knee : right_knee)],
               ankle = p[index(side == 0 ? left_ankle : right_ankle)];
    const Vec3 fore = level(knee - ankle);
    out.knee[side] = half_weight * (glm::dot(knee - ankle, fore) - glm::dot(centre - ankle, fore));
    const Vec3 shoulder = p[index(side == 0 ? left_shoulder : right_shoulder)];
    const Vec3 grip = p[index(side == 0 ? left_grip : right_grip)];
    const Vec3 pull = 0.5 * kGravity * holding.load.mass_kg * (grip - shoulder);
    out.shoulder[side] = glm::length(arm_moment(p, side, shoulder, body_mass_kg) + Vec3(pull.x, pull.y, 0.0));
  }
  return out;
}

}  // namespace reachcast::simulate
