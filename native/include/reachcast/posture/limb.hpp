// SPDX-License-Identifier: GPL-3.0-or-later
/// Two links between given ends: the middle joint lies on a circle, and the plane says where on it (Faraway 2004, fig.
/// 2).
#pragma once

#include "reachcast/body/body.hpp"
#include "reachcast/posture/linkage.hpp"

namespace reachcast {

/// The plane of a bent limb, and the direction from root to end for which it holds.
struct LimbPlane {
  Vec3 normal{0.0};  ///< as long as the sine of the bend: a straight limb has no plane
  Vec3 axis{0.0};    ///< unit length where known
};

[[nodiscard]] LimbPlane plane_of(const LimbSpec& limb, const Posture& posture);

/// A limb with the lengths that it has in `posture`; the limit applies when `limited`.
[[nodiscard]] Chain chain_of(const LimbSpec& limb, const Posture& posture, bool limited);

/// Hinge and end of a limb.
struct SpannedLimb {
  Vec3 hinge{0.0}, end{0.0};
};

/// Where hinge and end of a limb from `root` are, `chain` being its two links: the end at `end`, or where the limb
/// stops short of it on the line from its root; the hinge in the plane, carried by the smallest rotation from its own
/// axis to the limb's. The carrying keeps an elbow where it is relative to its arm when the arm points elsewhere than
/// it did when the plane was learned.
[[nodiscard]] SpannedLimb spanned_limb(const Chain& chain, const LimbPlane& plane, const Vec3& root, const Vec3& end);
/// Puts them there.
void span_limb(const LimbSpec& limb, const Chain& chain, const LimbPlane& plane, const Vec3& end, Posture& posture);

}  // namespace reachcast
