// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/whole_body.hpp"

namespace reachcast {
namespace {

Vec3 mirrored_point(const Vec3& p) {
  return {-p.x, p.y, p.z};
}

}  // namespace

Anchors anchors_of(const Posture& p, Hands hands) {
  using enum Joint;
  Anchors anchors{{p[index(left_ball)], p[index(right_ball)]},
                  {p[index(left_ankle)], p[index(right_ankle)]},
                  {p[index(left_grip)], p[index(right_grip)]},
                  hands,
                  Vec3(0.0)};
  if (hands == Hands::both) return anchors;
  const std::size_t free = free_side(hands);
  anchors.hang = anchors.grip[free] - p[index(free == 0 ? left_shoulder : right_shoulder)];
  return anchors;
}

Vec3 hold_point(const Anchors& anchors) {
  if (anchors.hands != Hands::both) return anchors.grip[working_side(anchors.hands)];
  return 0.5 * (anchors.grip[0] + anchors.grip[1]);
}

Anchors mirrored(const Anchors& anchors) {
  const auto flip = [](const std::array<Vec3, 2>& pair) {
    return std::array{mirrored_point(pair[1]), mirrored_point(pair[0])};
  };
  return {flip(anchors.ball), flip(anchors.ankle), flip(anchors.grip), mirrored(anchors.hands),
          mirrored_point(anchors.hang)};
}

}  // namespace reachcast
