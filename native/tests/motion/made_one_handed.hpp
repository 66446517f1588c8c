// SPDX-License-Identifier: GPL-3.0-or-later
/// A reach of one hand made up from formulas, as made_lift.hpp has those of both: the trunk leans half as far, the free
/// arm hangs from its shoulder and swings a little.
#pragma once

#include "motion/made_lift.hpp"
#include "reachcast/body/hands.hpp"

namespace reachcast::tests {

/// `right` hand at `hold`, the left arm hanging, swung forward by `swing_rad`.
inline Posture right_handed_posture(const Body& body, const Vec3& hold, double swing_rad) {
  using enum Joint;
  const double half_lean = 0.5 * (hold.z + 0.72 * body.stature_m());
  Posture p = holding_posture(body, Vec3(0.0, 0.42, half_lean), 0.36);
  const auto place_arm = [&](bool left, const Vec3& wrist, const Vec3& along, const Vec3& pole) {
    const auto at = [&](Joint right) -> Vec3& { return p[index(left ? mirrored(right) : right)]; };
    at(right_wrist) = wrist;
    at(right_elbow) = two_link(at(right_shoulder), wrist, body.distance(right_shoulder, right_elbow),
                               body.distance(right_elbow, right_wrist), pole);
    at(right_grip) = wrist + along * body.distance(right_wrist, right_grip);
    at(right_hand_front) = at(right_grip) + 0.02 * along;
    at(right_hand_back) = at(right_grip) - 0.02 * along;
  };
  const Vec3 ahead = glm::normalize(Vec3(-0.1, 1.0, -0.2));
  place_arm(false, hold - ahead * body.distance(right_wrist, right_grip), ahead, Vec3(0.6, -0.4, -1.0));
  const Vec3 down = glm::normalize(Vec3(-0.1, std::sin(swing_rad), -std::cos(swing_rad)));
  const double arm = body.distance(left_shoulder, left_elbow) + body.distance(left_elbow, left_wrist);
  place_arm(true, p[index(left_shoulder)] + 0.97 * arm * down, down, Vec3(0.0, -1.0, 0.0));
  return p;
}

/// The right hand goes smoothly from `home` to `target`, or the left one as its mirror image; 31 postures over a second.
inline Reach made_one_handed(double stature, const Vec3& home, const Vec3& target, Hands hands) {
  const Body body = Body::from_stature(stature);
  Reach reach;
  reach.subject.stature_m = stature;
  reach.hands = hands;
  reach.origin = "made, " + std::string(hands_name(hands)) + " hand, " + std::to_string(stature) + " m to " +
                 std::to_string(target.x) + " " + std::to_string(target.z);
  reach.duration_s = 1.0;
  for (int f = 0; f <= 30; ++f) {
    const double share = smooth_step(f / 30.0);
    const Posture posture = right_handed_posture(body, home + share * (target - home), 0.1 - 0.25 * share);
    reach.postures.push_back(hands == Hands::left ? mirrored(posture) : posture);
  }
  return reach;
}

}  // namespace reachcast::tests
