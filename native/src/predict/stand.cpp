// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/stand.hpp"

#include <algorithm>
#include <cmath>

namespace reachcast {
namespace {

constexpr double kHangOutwards = 0.12, kHangForwards = 0.10;  // per metre downwards
constexpr double kStretch = 0.985;                            // of the length of a limb: 20 degrees of bend

constexpr std::array kTrunk{Joint::left_hip,       Joint::right_hip,     Joint::l5s1,           Joint::c7t1,
                            Joint::suprasternale,  Joint::left_clavicle, Joint::right_clavicle, Joint::left_shoulder,
                            Joint::right_shoulder, Joint::tragion,       Joint::nasion};

/// The middle joint of two links, on the side of `towards`.
Vec3 hinge_between(const Vec3& root, const Vec3& end, double upper, double lower, const Vec3& towards) {
  const double across = glm::distance(root, end);
  const Vec3 axis = (end - root) / across;
  const double along = (upper * upper - lower * lower + across * across) / (2.0 * across);
  const Vec3 side = glm::normalize(towards - glm::dot(towards, axis) * axis);
  return root + along * axis + std::sqrt(std::max(0.0, upper * upper - along * along)) * side;
}

/// How far the trunk sinks for the knees to be bent a little.
double sinking(const Body& body) {
  using enum Joint;
  double most = 0.0;
  for (const auto& [hip, knee, ankle] :
       {std::array{left_hip, left_knee, left_ankle}, std::array{right_hip, right_knee, right_ankle}}) {
    const double length = kStretch * (body.distance(hip, knee) + body.distance(knee, ankle));
    const Vec3 leg = body.at(hip) - body.at(ankle);
    const double level = std::hypot(leg.x, leg.y);
    if (level < length) most = std::max(most, leg.z - std::sqrt(length * length - level * level));
  }
  return most;
}

void hang_arm(const Body& body, bool left, Posture& posture) {
  using enum Joint;
  const auto of = [&](Joint right) { return left ? mirrored(right) : right; };
  const auto at = [&](Joint right) -> Vec3& { return posture[index(of(right))]; };
  const double upper = body.distance(of(right_shoulder), of(right_elbow));
  const double lower = body.distance(of(right_elbow), of(right_wrist));
  const Vec3 down = glm::normalize(Vec3(left ? -kHangOutwards : kHangOutwards, kHangForwards, -1.0));
  at(right_wrist) = at(right_shoulder) + kStretch * (upper + lower) * down;
  at(right_elbow) = hinge_between(at(right_shoulder), at(right_wrist), upper, lower, Vec3(0, -1, 0));
  for (const Joint j : {right_grip, right_hand_front, right_hand_back})
    at(j) = at(right_wrist) + body.distance(of(right_wrist), of(j)) * down;
}

}  // namespace

Posture standing_at_ease(const Body& body) {
  using enum Joint;
  Posture posture = body.posture();
  const Vec3 sunk(0.0, 0.0, -sinking(body));
  for (const Joint j : kTrunk) posture[index(j)] += sunk;
  for (const bool left : {true, false}) {
    const Joint hip = left ? left_hip : right_hip, knee = left ? left_knee : right_knee;
    const Joint ankle = left ? left_ankle : right_ankle;
    posture[index(knee)] = hinge_between(posture[index(hip)], posture[index(ankle)], body.distance(hip, knee),
                                         body.distance(knee, ankle), Vec3(0, 1, 0));
    hang_arm(body, left, posture);
  }
  return posture;
}

}  // namespace reachcast
