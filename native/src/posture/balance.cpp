// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/balance.hpp"

#include <algorithm>
#include <array>

namespace reachcast {
namespace {

/// A share of the body's mass, at `along` of the way from one joint to another; paired ones count for both sides.
struct Mass {
  Joint from, to;
  double along, share;
  bool paired;
};

// Winter (2009), table 4.1. Pelvis and abdomen (.281) hang between hips and l5s1-c7t1; the thorax (.216) above it.
constexpr std::array<Mass, 10> kMasses{{
    {Joint::right_ankle, Joint::right_ball, 0.50, 0.0145, true},
    {Joint::right_knee, Joint::right_ankle, 0.433, 0.0465, true},
    {Joint::right_hip, Joint::right_knee, 0.433, 0.100, true},
    {Joint::left_hip, Joint::right_hip, 0.50, 0.142, false},
    {Joint::l5s1, Joint::c7t1, 0.25, 0.139, false},
    {Joint::l5s1, Joint::c7t1, 0.70, 0.216, false},
    {Joint::c7t1, Joint::tragion, 0.90, 0.081, false},
    {Joint::right_shoulder, Joint::right_elbow, 0.436, 0.028, true},
    {Joint::right_elbow, Joint::right_wrist, 0.430, 0.016, true},
    {Joint::right_wrist, Joint::right_grip, 0.90, 0.006, true},
}};
constexpr double kBehindAnkle_m = 0.03;

/// Every joint's share of the whole, since a point between two joints is a mean of both. The shares add up to 1.
std::array<double, kJointCount> joint_shares() {
  std::array<double, kJointCount> shares{};
  double whole = 0.0;
  const auto add = [&](Joint from, Joint to, const Mass& m) {
    shares[index(from)] += m.share * (1.0 - m.along);
    shares[index(to)] += m.share * m.along;
    whole += m.share;
  };
  for (const Mass& m : kMasses) {
    add(m.from, m.to, m);
    if (m.paired) add(mirrored(m.from), mirrored(m.to), m);
  }
  for (double& share : shares) share /= whole;
  return shares;
}

}  // namespace

Vec3 centre_of_mass(const Posture& posture, double body_mass_kg, const Load& load) {
  static const std::array<double, kJointCount> shares = joint_shares();
  Vec3 centre(0.0);
  for (std::size_t j = 0; j < kJointCount; ++j) centre += shares[j] * posture[j];
  return (centre * body_mass_kg + load.centre * load.mass_kg) / (body_mass_kg + load.mass_kg);
}

Vec3 beyond_support(const Vec3& centre, const Anchors& feet) {
  const auto [left, right] = std::minmax(feet.ankle[0].x, feet.ankle[1].x);
  const double back = std::min(feet.ankle[0].y, feet.ankle[1].y) - kBehindAnkle_m;
  const double front = std::max(feet.ball[0].y, feet.ball[1].y);
  return {centre.x - std::clamp(centre.x, left, right), centre.y - std::clamp(centre.y, back, front), 0.0};
}

}  // namespace reachcast
