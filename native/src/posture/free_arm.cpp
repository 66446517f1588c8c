// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/free_arm.hpp"

#include "reachcast/posture/twist.hpp"

namespace reachcast {
namespace {

/// Upper arm, forearm and hand up to the grip together.
double arm_length(const Posture& posture, std::size_t side) {
  using enum Joint;
  const auto at = [&](Joint left) { return posture[index(side == 0 ? left : mirrored(left))]; };
  return glm::distance(at(left_shoulder), at(left_elbow)) + glm::distance(at(left_elbow), at(left_wrist)) +
         glm::distance(at(left_wrist), at(left_grip));
}

}  // namespace

Vec3 relative_hang(const Posture& posture, Hands hands) {
  const Anchors anchors = anchors_of(posture, hands);
  return turned(anchors.hang, -facing_yaw(anchors)) / arm_length(posture, free_side(hands));
}

Vec3 hang_on(const Body& body, const Anchors& anchors, const Vec3& relative) {
  return turned(relative, facing_yaw(anchors)) * arm_length(body.posture(), free_side(anchors.hands));
}

}  // namespace reachcast
