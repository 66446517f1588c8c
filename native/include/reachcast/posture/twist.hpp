// SPDX-License-Identifier: GPL-3.0-or-later
/// A person who reaches to the side turns: the arms fully, the chest and the pelvis by a share, the feet not at all.
/// Coordinates are taken of the posture as it would face its hold point and the turn is put back when decoding, so that
/// what was learned ahead of the body serves to its sides (the 2004 paper, p. 551, expects no good prediction there).
#pragma once

#include <cmath>

#include "reachcast/body/body.hpp"
#include "reachcast/body/hands.hpp"

namespace reachcast {

struct Anchors;

/// A turn about the vertical, for many vectors.
class Yaw {
 public:
  explicit Yaw(double rad) : cosine_(std::cos(rad)), sine_(std::sin(rad)) {}
  [[nodiscard]] Vec3 operator()(const Vec3& v) const {
    return {cosine_ * v.x - sine_ * v.y, sine_ * v.x + cosine_ * v.y, v.z};
  }

 private:
  double cosine_, sine_;
};

/// A vector turned about the vertical.
[[nodiscard]] inline Vec3 turned(const Vec3& v, double yaw_rad) {
  return Yaw(yaw_rad)(v);
}

/// Turn about the vertical, radians, from facing forward (y) to facing the hold point, seen from a little behind
/// the ankles so that it is defined and steady for everything that hands can hold in front of the body. One hand is
/// seen from far behind the place where it hangs: the trunk turns little with it until it reaches out.
[[nodiscard]] double facing_yaw(const Vec3& between_ankles, const Vec3& hold_point, Hands hands = Hands::both);
[[nodiscard]] double facing_yaw(const Anchors& anchors);

/// The same anchors with the grips turned about the vertical line midway between the ankles.
[[nodiscard]] Anchors with_grips_turned(const Anchors& anchors, double yaw_rad);

/// The posture with its hands turned by `yaw_rad` about that line, the chest by four fifths of it, the pelvis by two,
/// the feet not, and the limbs spanned again in their turned planes; a free arm turns about its shoulder. Twisting back
/// undoes it. Every link keeps its length; a limb that cannot span stops short and its hand or foot goes with it.
[[nodiscard]] Posture twisted(const Posture& posture, double yaw_rad, Hands hands = Hands::both);

/// Only its trunk: hips, l5s1, chest, shoulders and head. The feet give the line; other joints stay.
[[nodiscard]] Posture turned_trunk(const Posture& posture, double yaw_rad);

}  // namespace reachcast
