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

/// The limbs that hold.hpp spans last: left leg and right leg (hip to ankle), left arm and right arm (clavicle to grip).
inline constexpr std::size_t kLimbCount = 4;
[[nodiscard]] const std::array<ChainSpec, kLimbCount>& holding_limbs();

/// A posture, and the coordinates of its limbs as they were decoded: a limb that could not span its anchors is
/// straight in the posture and has lost its plane there, but not here.
struct Decoded {
  Posture posture{};
  std::array<std::vector<double>, kLimbCount> limbs;
};

/// A linkage on one body: its chains are built once and used for every frame.
class BodyLinkage {
 public:
  BodyLinkage(const Linkage& linkage, const Body& body);

  /// A posture of this body that faces its hold point. Every link has its length. Where a chain cannot span its anchors,
  /// its end is put at the nearest point that it can; holding on to all anchors at once is the work of
  /// posture/hold.hpp. Never throws for finite input.
  [[nodiscard]] Decoded decode(const Eigen::Ref<const Eigen::VectorXd>& coordinates, const Anchors& anchors) const;

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
