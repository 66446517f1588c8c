// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/twist.hpp"

#include <algorithm>
#include <cmath>

#include "reachcast/posture/whole_body.hpp"

namespace reachcast {
namespace {

constexpr double kSeenFrom_m = 0.2;    // behind the ankles
constexpr double kPelvisShare = 0.4;   // feet on the floor: some 35 degrees of hip rotation at a full side reach
constexpr double kChestShare = 0.8;    // and as much again between pelvis and chest
constexpr double kKneeShare = 0.2;

Vec3 turned(const Vec3& v, double yaw) {
  const double c = std::cos(yaw), s = std::sin(yaw);
  return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

/// The limb between the ends it has in `after`.
void respan(std::size_t limb, const Posture& before, double yaw, Posture& after) {
  const ChainSpec& spec = holding_limbs()[limb];
  const Chain chain = chain_of(spec, before, false);
  const std::vector<double> coordinates = turned_limb_coordinates(limb, before, yaw);
  const Vec3 start = after[index(spec.joints.front())], end = after[index(spec.joints.back())];
  const double across = glm::distance(start, end), wanted = std::clamp(across, chain.reach().lo, chain.reach().hi);
  Points points(spec.joints.size());
  chain.decode(start, across > 1e-9 ? start + (end - start) * (wanted / across) : start + Vec3(0, 0, -wanted), coordinates, points);
  for (std::size_t i = 0; i < points.size(); ++i) after[index(spec.joints[i])] = points[i];
}

}  // namespace

double facing_yaw(const Anchors& anchors) {
  const Vec3 feet = 0.5 * (anchors.ankle[0] + anchors.ankle[1]), hold = 0.5 * (anchors.grip[0] + anchors.grip[1]);
  return std::atan2(-(hold.x - feet.x), hold.y - feet.y + kSeenFrom_m);
}

Anchors with_grips_turned(const Anchors& anchors, double yaw_rad) {
  const Vec3 feet = 0.5 * (anchors.ankle[0] + anchors.ankle[1]);
  Anchors out = anchors;
  for (Vec3& grip : out.grip) grip = feet + turned(grip - feet, yaw_rad);
  return out;
}

Posture twisted(const Posture& posture, double yaw_rad) {
  using enum Joint;
  const Vec3 feet = 0.5 * (posture[index(left_ankle)] + posture[index(right_ankle)]);
  const Vec3 waist = posture[index(l5s1)];
  Posture out = posture;
  for (const Joint j : {left_hip, right_hip, l5s1}) out[index(j)] = feet + turned(posture[index(j)] - feet, kPelvisShare * yaw_rad);
  for (const Joint j : {c7t1, suprasternale, left_clavicle, right_clavicle, tragion, nasion}) {
    out[index(j)] = out[index(l5s1)] + turned(posture[index(j)] - waist, kChestShare * yaw_rad);
  }
  for (const Joint j : {left_grip, right_grip}) out[index(j)] = feet + turned(posture[index(j)] - feet, yaw_rad);
  for (std::size_t limb = 0; limb < kLimbCount; ++limb) respan(limb, posture, yaw_rad, out);
  for (const Joint j : {left_ball, right_ball}) {  // the foot goes with an ankle that a leg could not hold
    const Joint ankle = j == left_ball ? left_ankle : right_ankle;
    out[index(j)] = posture[index(j)] + out[index(ankle)] - posture[index(ankle)];
  }
  for (const bool left : {true, false}) {
    const auto side = [&](Joint right) { return left ? mirrored(right) : right; };
    const Vec3 wrist = out[index(side(right_wrist))], along = glm::normalize(out[index(side(right_grip))] - wrist);
    for (const Joint j : {side(right_hand_front), side(right_hand_back)}) {
      out[index(j)] = wrist + along * glm::distance(posture[index(j)], posture[index(side(right_wrist))]);
    }
  }
  return out;
}

std::vector<double> turned_limb_coordinates(std::size_t limb, const Posture& posture, double yaw_rad) {
  const ChainSpec& spec = holding_limbs()[limb];
  const Chain chain = chain_of(spec, posture, false);
  Points points;
  for (const Joint joint : spec.joints) points.push_back(posture[index(joint)]);
  std::vector<double> coordinates(chain.coordinate_count());
  chain.encode(points, coordinates);
  const double share = limb < 2 ? kKneeShare : 1.0;
  for (std::size_t joint = 1; joint < chain.links(); ++joint) {
    double* normal = &coordinates[chain.normal_offset(joint)];
    const Vec3 v = turned({normal[0], normal[1], normal[2]}, share * yaw_rad);
    for (int i = 0; i < 3; ++i) normal[i] = v[i];
  }
  return coordinates;
}

}  // namespace reachcast
