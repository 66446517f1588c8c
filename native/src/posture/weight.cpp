// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/weight.hpp"

#include <array>

namespace reachcast {
namespace {

using enum Joint;

/// A share of the body's mass, at `along` of the way from one joint to another.
struct Part {
  Joint from, to;
  double along, share;
};

// Abdomen .139, thorax .216, head and neck .081 of the body's mass; upper arm .028 at .436, forearm .016 at .430, hand
// .006 each.
constexpr std::array<Part, 3> kAboveWaist{
    {{l5s1, c7t1, 0.25, 0.139}, {l5s1, c7t1, 0.70, 0.216}, {c7t1, tragion, 0.90, 0.081}}};
constexpr std::array<std::array<Part, 3>, 2> kArms{{{{{left_shoulder, left_elbow, 0.436, 0.028},
                                                      {left_elbow, left_wrist, 0.430, 0.016},
                                                      {left_wrist, left_grip, 0.90, 0.006}}},
                                                    {{{right_shoulder, right_elbow, 0.436, 0.028},
                                                      {right_elbow, right_wrist, 0.430, 0.016},
                                                      {right_wrist, right_grip, 0.90, 0.006}}}}};

Vec3 place(const Part& part, const Posture& p) {
  return glm::mix(p[index(part.from)], p[index(part.to)], part.along);
}

Vec3 lever(const std::array<Part, 3>& parts, const Posture& p, const Vec3& joint, double body_mass_kg) {
  Vec3 sum(0.0);
  for (const Part& part : parts) sum += kGravity * part.share * body_mass_kg * (place(part, p) - joint);
  return {sum.x, sum.y, 0.0};
}

}  // namespace

Vec3 back_moment(const Posture& p, double body_mass_kg, const Load& load) {
  const Vec3 joint = p[index(l5s1)], carried = kGravity * load.mass_kg * (load.centre - joint);
  Vec3 sum = lever(kAboveWaist, p, joint, body_mass_kg) + Vec3(carried.x, carried.y, 0.0);
  for (const std::size_t side : {0u, 1u}) sum += arm_moment(p, side, joint, body_mass_kg);
  return sum;
}

Vec3 arm_moment(const Posture& p, std::size_t side, const Vec3& joint, double body_mass_kg) {
  return lever(kArms[side], p, joint, body_mass_kg);
}

}  // namespace reachcast
