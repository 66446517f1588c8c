// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "reachcast/rig/limbs.hpp"
#include "reachcast/rig/turns.hpp"

namespace reachcast {
namespace {

constexpr double kLevelFoot = 0.4;     // cosine of the foot's slope from which the sole is level (66 degrees)
constexpr double kHangingFoot = 0.25;  // cosine below which the foot turns with the shin (76 degrees)

/// One sign per level frame, 0 for the others: 1 in the first run of level frames, then as each run as a whole agrees
/// with `carried`.
std::vector<double> level_signs(std::span<const Vec3> level, std::span<const Vec3> carried) {
  std::vector<double> signs(level.size(), 0.0);
  bool is_first = true;
  for (std::size_t begin = 0; begin < level.size();) {
    std::size_t end = begin;
    double agreement = 0.0;
    for (; end < level.size() && glm::length(level[end]) >= kLevelFoot; ++end) {
      agreement += glm::dot(level[end], carried[end]);
    }
    std::fill(signs.begin() + static_cast<std::ptrdiff_t>(begin), signs.begin() + static_cast<std::ptrdiff_t>(end),
              is_first || agreement >= 0.0 ? 1.0 : -1.0);
    is_first = is_first && end == begin;
    begin = std::max(end, begin + 1);
  }
  return signs;
}

/// The sign of the nearest frame that has one; of two as near, the later. 0 when there is none.
double nearest_sign(std::span<const double> signs, std::size_t f) {
  for (std::size_t away = 0; away < signs.size(); ++away) {
    if (f + away < signs.size() && signs[f + away] != 0.0) return signs[f + away];
    if (away <= f && signs[f - away] != 0.0) return signs[f - away];
  }
  return 0.0;
}

/// Unit sideways axes: `level` while the sole can be level, `carried` by the shin while it cannot.
Points foot_sides(std::span<const Vec3> level, std::span<const Vec3> carried, std::span<const Vec3> feet) {
  const std::vector<double> signs = level_signs(level, carried);
  Points sides(feet.size());
  for (std::size_t f = 0; f < feet.size(); ++f) {
    const double share = smooth_step((glm::length(level[f]) - kHangingFoot) / (kLevelFoot - kHangingFoot));
    const double sign = share > 0.0 ? nearest_sign(signs, f) : 0.0;
    sides[f] = sign == 0.0 ? carried[f] : turned_towards(carried[f], sign * unit_or_same(level[f]), feet[f], share);
  }
  return sides;
}

}  // namespace

void turn_foot(const FootRest& rest, const LegNames& leg, Postures postures, Turns shin, std::span<Mat3> foot,
               std::span<Mat3> toe) {
  const std::size_t frames = postures.size();
  Points feet(frames), level(frames), carried(frames);
  for (std::size_t f = 0; f < frames; ++f) {
    feet[f] = unit_or_same(postures[f][index(leg.ball)] - postures[f][index(leg.ankle)]);
    level[f] = glm::cross(feet[f], rest.up);
    carried[f] = smallest_turn(shin[f] * rest.foot, feet[f]) * (shin[f] * rest.side);
  }
  const Points sides = foot_sides(level, carried, feet);
  const Mat3 foot_rest = glm::transpose(frame_towards(rest.foot, rest.side));
  const Mat3 toe_rest = glm::transpose(frame_towards(rest.up, rest.side));
  for (std::size_t f = 0; f < frames; ++f) {
    foot[f] = frame_towards(feet[f], sides[f]) * foot_rest;
    toe[f] = frame_towards(rest.up, unit_or_same(across(sides[f], rest.up))) * toe_rest;
  }
}

}  // namespace reachcast
