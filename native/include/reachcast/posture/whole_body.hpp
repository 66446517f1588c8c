// SPDX-License-Identifier: GPL-3.0-or-later
/// A whole posture as stretch-pivot coordinates and back, onto any body (Faraway 2004, sections 2, 3.3 and 5).
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <vector>

#include "reachcast/body/body.hpp"
#include "reachcast/posture/linkage.hpp"

namespace reachcast {

/// Where the endpoints of a posture are, body frame, metres.
struct Anchors {
  std::array<Vec3, 2> ball, ankle, grip;  ///< left, right
};

/// Number of coordinates of a posture under `linkage`.
[[nodiscard]] Eigen::Index posture_coordinate_count(const Linkage& linkage);

/// Coordinates of a posture of anyone, untwisted (twist.hpp) to face its hold point: link lengths are those of the
/// posture itself. Logits are clamped to +-5, so that one recorded extreme does not rule a mean.
[[nodiscard]] Eigen::VectorXd encode_posture(const Linkage& linkage, const Posture& posture);

/// The chain with the lengths it has in `posture` (limits of the linkage apply when `limited`).
[[nodiscard]] Chain chain_of(const ChainSpec& spec, const Posture& posture, bool limited);

/// A linkage on one body: its chains are built once and used for every frame.
class BodyLinkage {
 public:
  BodyLinkage(const Linkage& linkage, const Body& body);

  /// A posture of this body with left ball and right grip at their anchors. Every link has its length. Where a chain
  /// cannot span its anchors, its end is put at the nearest point that it can; holding on to all anchors at once
  /// is the work of posture/hold.hpp. Never throws for finite input.
  [[nodiscard]] Posture decode(const Eigen::Ref<const Eigen::VectorXd>& coordinates, const Anchors& anchors) const;

  [[nodiscard]] const Body& body() const { return body_; }
  [[nodiscard]] const Linkage& linkage() const { return linkage_; }

 private:
  const Linkage& linkage_;
  Body body_;
  Chain primary_;
  std::vector<Chain> limbs_;
};

[[nodiscard]] Anchors anchors_of(const Posture& posture);

/// Right-handed frame of three points: x along b - a, z along (b - a) x (apex - a). Columns are the axes.
[[nodiscard]] Mat3 triangle_frame(const Vec3& a, const Vec3& b, const Vec3& apex);

}  // namespace reachcast
