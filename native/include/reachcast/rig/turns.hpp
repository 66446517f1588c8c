// SPDX-License-Identifier: GPL-3.0-or-later
/// Turns: rotation matrices that act on columns. Every function is total; what happens where a direction vanishes is
/// said, for a limb may become straight and a foot may point straight down.
#pragma once

#include <cmath>

#include "reachcast/conventions.hpp"

namespace reachcast {

/// Unit length; a vector shorter than 1e-12 stays as it is.
[[nodiscard]] inline Vec3 unit_or_same(const Vec3& v) {
  const double length = glm::length(v);
  return length < 1e-12 ? v : v / length;
}

/// The part of `v` across the unit `axis`.
[[nodiscard]] inline Vec3 across(const Vec3& v, const Vec3& axis) {
  return v - axis * glm::dot(v, axis);
}

/// Some unit vector across the unit `axis`, the same for the same axis.
[[nodiscard]] inline Vec3 any_across(const Vec3& axis) {
  const Vec3 size = glm::abs(axis);
  Vec3 least(0.0);
  least[size.x <= size.y && size.x <= size.z ? 0 : (size.y <= size.z ? 1 : 2)] = 1.0;
  return unit_or_same(glm::cross(axis, least));
}

/// Right-handed columns: along `primary` exactly, towards `secondary` (any_across where it has no part across), and
/// their cross product.
[[nodiscard]] inline Mat3 frame_towards(const Vec3& primary, const Vec3& secondary) {
  const Vec3 first = unit_or_same(primary), part = across(secondary, first);
  const Vec3 second = glm::dot(part, part) < 1e-18 ? any_across(first) : unit_or_same(part);
  return {first, second, glm::cross(first, second)};
}

/// 1 + sine [v]x + versine [v]x^2, where [v]x w = v x w: a turn about v when |v| = 1.
[[nodiscard]] inline Mat3 rodrigues(const Vec3& v, double sine, double versine) {
  const Vec3 s = sine * v, q = versine * v;
  const double rest = 1.0 - glm::dot(q, v);
  return {{rest + q.x * v.x, q.x * v.y + s.z, q.x * v.z - s.y},
          {q.y * v.x - s.z, rest + q.y * v.y, q.y * v.z + s.x},
          {q.z * v.x + s.y, q.z * v.y - s.x, rest + q.z * v.z}};
}

/// The turn by `angle_rad` about the unit `axis`.
[[nodiscard]] inline Mat3 turn_about(const Vec3& axis, double angle_rad) {
  return rodrigues(axis, std::sin(angle_rad), 1.0 - std::cos(angle_rad));
}

/// The smallest turn that brings the unit `start` onto the unit `end`; half a turn about any_across when they oppose.
[[nodiscard]] inline Mat3 smallest_turn(const Vec3& start, const Vec3& end) {
  const double cosine = glm::dot(start, end);
  const Vec3 normal = glm::cross(start, end);
  if (cosine > -0.99) return rodrigues(normal, 1.0, 1.0 / (1.0 + cosine));
  const double sine = glm::length(normal);  // 1 + cosine has lost its digits here
  return sine < 1e-8 ? turn_about(any_across(start), kPi) : turn_about(normal / sine, std::atan2(sine, cosine));
}

/// Angle in (-pi, pi] from `start` to `end`, both across the unit `axis`, counted about it.
[[nodiscard]] inline double signed_angle(const Vec3& start, const Vec3& end, const Vec3& axis) {
  return std::atan2(glm::dot(axis, glm::cross(start, end)), glm::dot(start, end));
}

/// `start` turned about the unit `axis` by `share` of the angle to `end`; both are across it and so is the result.
[[nodiscard]] inline Vec3 turned_towards(const Vec3& start, const Vec3& end, const Vec3& axis, double share) {
  if (share <= 0.0) return unit_or_same(across(start, axis));
  if (share >= 1.0) return unit_or_same(across(end, axis));
  return unit_or_same(across(turn_about(axis, share * signed_angle(start, end, axis)) * start, axis));
}

/// 0 up to t = 0, 1 from t = 1 on, smooth between.
[[nodiscard]] inline double smooth_step(double t) {
  const double x = std::fmin(std::fmax(t, 0.0), 1.0);
  return x * x * (3.0 - 2.0 * x);
}

/// `angle_rad` plus the whole turns that bring it within half a turn of `target_rad`.
[[nodiscard]] inline double near_angle(double angle_rad, double target_rad) {
  return angle_rad + 2.0 * kPi * std::nearbyint((target_rad - angle_rad) / (2.0 * kPi));
}

}  // namespace reachcast
