// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/straight_chest.hpp"

namespace reachcast {
namespace {

constexpr double kOnOneLine = 0.05;  // sine of the angle at c7t1

Vec3 across(const Vec3& v, const Vec3& axis) {
  return v - glm::dot(v, axis) * axis;
}

/// To the right.
Vec3 sideways(const Posture& posture, const Vec3& along) {
  using enum Joint;
  const Vec3 sternum = 0.5 * (posture[index(left_clavicle)] + posture[index(right_clavicle)]) - posture[index(c7t1)];
  const Vec3 shoulders = across(posture[index(right_shoulder)] - posture[index(left_shoulder)], along);
  const Vec3 plane = glm::cross(sternum, along);
  const bool is_plane = glm::length(plane) > kOnOneLine * glm::length(sternum) && glm::dot(plane, shoulders) > 0.0;
  return glm::normalize(is_plane ? plane : shoulders);
}

}  // namespace

Posture straight_chest(const Posture& posture, double bend_rad) {
  using enum Joint;
  Posture out = posture;
  if (bend_rad == 0.0) return out;
  const Vec3 waist = posture[index(l5s1)], neck = posture[index(c7t1)], chord = neck - waist;
  const Mat3 back = glm::transpose(bent_arc(chord, sideways(posture, glm::normalize(chord)), bend_rad).upper);
  out[index(c7t1)] = waist + chord / ratio_of_bend(bend_rad);
  for (const Joint j : {suprasternale, left_clavicle, right_clavicle})
    out[index(j)] = out[index(c7t1)] + back * (posture[index(j)] - neck);
  return out;
}

}  // namespace reachcast
