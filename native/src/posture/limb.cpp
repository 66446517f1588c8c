// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/limb.hpp"

#include <algorithm>
#include <array>

namespace reachcast {

LimbPlane plane_of(const LimbSpec& limb, const Posture& posture) {
  const Vec3 root = posture[index(limb.root)], hinge = posture[index(limb.hinge)], end = posture[index(limb.end)];
  const double across = glm::distance(root, end), links = glm::distance(root, hinge) * glm::distance(hinge, end);
  return {links > 0.0 ? glm::cross(hinge - root, end - hinge) / links : Vec3(0.0),
          across > 0.0 ? (end - root) / across : Vec3(0.0)};
}

Chain chain_of(const LimbSpec& limb, const Posture& posture, bool limited) {
  const Vec3 hinge = posture[index(limb.hinge)];
  std::map<std::size_t, FlexionLimit> limits;
  if (limited) limits.emplace(1, limb.limit);
  return {
      {glm::distance(posture[index(limb.root)], hinge), glm::distance(hinge, posture[index(limb.end)])}, {1}, limits};
}

void span_limb(const LimbSpec& limb, const Chain& chain, const LimbPlane& plane, const Vec3& end, Posture& posture) {
  const Vec3 root = posture[index(limb.root)];
  const double across = glm::distance(root, end), wanted = std::clamp(across, chain.reach().lo, chain.reach().hi);
  const Vec3 axis = across > 1e-9 ? (end - root) / across : Vec3(0, 0, -1);
  const Vec3 normal =
      glm::length(plane.axis) > 1e-9 ? smallest_rotation(plane.axis, axis) * plane.normal : plane.normal;
  const std::array coordinates{normal.x, normal.y, normal.z};
  std::array<Vec3, 3> points;
  chain.decode(root, across == wanted ? end : root + axis * wanted, coordinates, points);
  posture[index(limb.hinge)] = points[1];
  posture[index(limb.end)] = points[2];
}

}  // namespace reachcast
