// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/limb.hpp"

#include <algorithm>

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

SpannedLimb spanned_limb(const Chain& chain, const LimbPlane& plane, const Vec3& root, const Vec3& end) {
  const double across = glm::distance(root, end), wanted = std::clamp(across, chain.reach().lo, chain.reach().hi);
  const Vec3 axis = across > 1e-9 ? (end - root) / across : Vec3(0, 0, -1);
  const double known = glm::length(plane.axis);
  const Vec3 normal = known > 1e-9 ? carried_along(plane.axis / known, axis, plane.normal) : plane.normal;
  const Vec3 reached = across == wanted ? end : root + axis * wanted;
  const double upper = chain.lengths()[0], lower = chain.lengths()[1];
  if (wanted <= 1e-9) return {pivot_point(root, reached, upper, lower, normal), reached};
  return {pivot_point(root, axis, wanted, upper, lower, normal), reached};
}

void span_limb(const LimbSpec& limb, const Chain& chain, const LimbPlane& plane, const Vec3& end, Posture& posture) {
  const SpannedLimb spanned = spanned_limb(chain, plane, posture[index(limb.root)], end);
  posture[index(limb.hinge)] = spanned.hinge;
  posture[index(limb.end)] = spanned.end;
}

}  // namespace reachcast
