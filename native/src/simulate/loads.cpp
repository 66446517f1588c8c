// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "reachcast/simulate/effort.hpp"

namespace reachcast::simulate {
namespace {

using enum Joint;

constexpr double kGravity = 9.81;

/// A share of the body's mass, at `along` of the way from one joint to another.
struct Part {
  Joint from, to;
  double along, share;
};

// Winter (2009), table 4.1: abdomen .139, thorax .216, head and neck .081 of the body's mass; upper arm .028 at .436,
// forearm .016 at .430, hand .006 each; foot .0145, shank .0465 at .433 from the knee.
constexpr std::array<Part, 3> kAboveWaist{
    {{l5s1, c7t1, 0.25, 0.139}, {l5s1, c7t1, 0.70, 0.216}, {c7t1, tragion, 0.90, 0.081}}};
constexpr std::array<std::array<Part, 3>, 2> kArms{{{{{left_shoulder, left_elbow, 0.436, 0.028},
                                                      {left_elbow, left_wrist, 0.430, 0.016},
                                                      {left_wrist, left_grip, 0.90, 0.006}}},
                                                    {{{right_shoulder, right_elbow, 0.436, 0.028},
                                                      {right_elbow, right_wrist, 0.430, 0.016},
                                                      {right_wrist, right_grip, 0.90, 0.006}}}}};
constexpr double kShankAndFoot = 0.061;

Vec3 place(const Part& part, const Posture& p) {
  return glm::mix(p[index(part.from)], p[index(part.to)], part.along);
}

/// Sum of weight times horizontal lever about `joint`, N m, as a level vector towards where the weight lies.
template <class Parts>
Vec3 lever(const Parts& parts, const Posture& p, const Vec3& joint, double body_mass_kg) {
  Vec3 sum(0.0);
  for (const Part& part : parts) sum += kGravity * part.share * body_mass_kg * (place(part, p) - joint);
  return {sum.x, sum.y, 0.0};
}

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
  const Vec3 carried = kGravity * holding.load.mass_kg * (holding.load.centre - p[index(l5s1)]);
  Vec3 back = lever(kAboveWaist, p, p[index(l5s1)], body_mass_kg) + Vec3(carried.x, carried.y, 0.0);
  for (const auto& arm : kArms) back += lever(arm, p, p[index(l5s1)], body_mass_kg);
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
    out.shoulder[side] = glm::length(lever(kArms[side], p, shoulder, body_mass_kg) + Vec3(pull.x, pull.y, 0.0));
  }
  return out;
}

}  // namespace reachcast::simulate
