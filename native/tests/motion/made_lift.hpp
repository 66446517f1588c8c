// SPDX-License-Identifier: GPL-3.0-or-later
/// A lift made up from formulas, so that tests need no recordings: the trunk leans and sinks with the height of the
/// hands, arms and legs are spanned by two-link inverse kinematics written here, without the code under test.
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "reachcast/motion/reach.hpp"

namespace reachcast::tests {

/// Two links from `root` to `end`; the middle joint lies on the side of `pole`.
inline Vec3 two_link(const Vec3& root, const Vec3& end, double upper, double lower, const Vec3& pole) {
  const double across = glm::distance(root, end);
  if (across > upper + lower || across < std::abs(upper - lower)) {
    throw std::logic_error("made_lift: " + std::to_string(across) + " m cannot be spanned by " + std::to_string(upper) +
                           " + " + std::to_string(lower) + " m");
  }
  const Vec3 axis = (end - root) / across;
  const double along = (upper * upper - lower * lower + across * across) / (2.0 * across);
  const Vec3 side = glm::normalize(pole - glm::dot(pole, axis) * axis);
  return root + along * axis + std::sqrt(std::max(0.0, upper * upper - along * along)) * side;
}

inline Vec3 leaned(const Vec3& p, const Vec3& pivot, double angle) {
  const Vec3 d = p - pivot;
  const double c = std::cos(angle), s = std::sin(angle);
  return pivot + Vec3(d.x, c * d.y + s * d.z, -s * d.y + c * d.z);
}

/// Hands `grip_distance` apart about `hold`, feet as the body stands; hold at least 0.3 m ahead of the ankles.
inline Posture holding_posture(const Body& body, const Vec3& hold, double grip_distance) {
  using enum Joint;
  Posture p = body.posture();
  const double tall = body.stature_m();
  const double share = std::clamp((0.72 * tall - hold.z) / (0.72 * tall), 0.0, 1.0);
  const double bent = share * share * (3.0 - 2.0 * share);
  const auto move_trunk = [&](auto&& change, std::initializer_list<Joint> joints) {
    for (const Joint j : joints) p[index(j)] = change(p[index(j)]);
  };
  const Vec3 hips = 0.5 * (p[index(left_hip)] + p[index(right_hip)]);
  const Vec3 sunk(0.0, -0.12 * tall * bent, -0.015 * tall - 0.20 * tall * bent);
  const auto with_pelvis = [&](const Vec3& q) { return leaned(q, hips, 0.8 * bent) + sunk; };
  move_trunk(with_pelvis, {left_hip, right_hip, l5s1, c7t1, suprasternale, tragion, nasion, left_clavicle,
                           right_clavicle, left_shoulder, right_shoulder});
  const Vec3 base = p[index(l5s1)];
  move_trunk([&](const Vec3& q) { return leaned(q, base, 0.05 + 0.7 * bent); },
             {c7t1, suprasternale, tragion, nasion, left_clavicle, right_clavicle, left_shoulder, right_shoulder});
  for (const double side : {-1.0, 1.0}) {
    const auto at = [&](Joint right) -> Vec3& { return p[index(side < 0.0 ? mirrored(right) : right)]; };
    at(right_knee) = two_link(at(right_hip), at(right_ankle), body.distance(right_hip, right_knee),
                              body.distance(right_knee, right_ankle), Vec3(0.15 * side, 1.0, 0.0));
    at(right_grip) = hold + Vec3(0.5 * side * grip_distance, 0.0, 0.0);
    const Vec3 along = glm::normalize(Vec3(-0.1 * side, 1.0, -1.2 * bent));
    at(right_wrist) = at(right_grip) - along * body.distance(right_wrist, right_grip);
    at(right_elbow) = two_link(at(right_shoulder), at(right_wrist), body.distance(right_shoulder, right_elbow),
                               body.distance(right_elbow, right_wrist), Vec3(0.6 * side, -0.4, -1.0));
    at(right_hand_front) = at(right_grip) + 0.02 * along;
    at(right_hand_back) = at(right_grip) - 0.02 * along;
  }
  return p;
}

/// From 0 to 1 with no speed or acceleration at either end.
inline double smooth_step(double t) {
  return t * t * t * (10.0 + t * (6.0 * t - 15.0));
}

/// The hands go smoothly from `home` to `target`, up before across; `frames` postures over `seconds`.
inline Reach made_lift(double stature, const Vec3& home, const Vec3& target, std::size_t frames = 31,
                       double seconds = 1.25, double grip_distance = 0.40) {
  const Body body = Body::from_stature(stature);
  Reach reach;
  reach.subject.stature_m = stature;
  reach.origin =
      "made " + std::to_string(stature) + " m to " + std::to_string(target.x) + " " + std::to_string(target.z);
  reach.duration_s = seconds;
  for (std::size_t f = 0; f < frames; ++f) {
    const double t = static_cast<double>(f) / static_cast<double>(frames - 1);
    const double up = smooth_step(std::pow(t, 0.9)), across = smooth_step(std::pow(t, 1.2));
    const Vec3 hold(home.x + across * (target.x - home.x), home.y + across * (target.y - home.y),
                    home.z + up * (target.z - home.z));
    reach.postures.push_back(holding_posture(body, hold, grip_distance));
  }
  return reach;
}

}  // namespace reachcast::tests
