// SPDX-License-Identifier: GPL-3.0-or-later
/// A whole posture as stretch-pivot coordinates and back, onto any body (Faraway 2004, sections 2, 3.3 and 5).
#pragma once

#include <Eigen/Core>
#include <array>

#include "reachcast/body/body.hpp"
#include "reachcast/body/spine.hpp"
#include "reachcast/posture/limb.hpp"
#include "reachcast/posture/linkage.hpp"

namespace reachcast {

/// Where the endpoints of a posture are, body frame, metres.
struct Anchors {
  std::array<Vec3, 2> ball, ankle, grip;  ///< left, right
};
[[nodiscard]] Anchors anchors_of(const Posture& posture);
[[nodiscard]] Anchors mirrored(const Anchors& anchors);

/// Number of coordinates of a posture under `linkage`.
[[nodiscard]] Eigen::Index posture_coordinate_count(const Linkage& linkage);

/// Coordinates of a posture of anyone, untwisted (twist.hpp) to face its hold point: link lengths are those of the
/// posture itself. Logits are clamped to +-5, so that one recorded extreme does not rule a mean. `bend_rad`: of the
/// back (spine.hpp), which no coordinate holds.
[[nodiscard]] Eigen::VectorXd encode_posture(const Linkage& linkage, const Posture& recorded, double bend_rad = 0.0);

/// A posture before its limbs are spanned between trunk and anchors, which is the work of hold.hpp.
struct Decoded {
  Posture trunk{};  ///< pelvis, chest, head and shoulders stand; the other joints do not
  std::array<LimbPlane, kLimbCount> planes;
  std::array<Vec3, 2> wrist_from_grip{};  ///< left, right; as learned, before hold.hpp minds the wrists' limits
  double bend_rad = 0.0;                  ///< of the back (spine.hpp)
};

/// A linkage on one body: its chains are built once and used for every frame.
class BodyLinkage {
 public:
  BodyLinkage(const Linkage& linkage, const Body& body);

  /// The trunk as its coordinates have it between left ball and right grip, with every segment's length. Where the
  /// primary chain cannot span these two, the grip is taken at the nearest point that it can reach. `bend_rad`: of the
  /// back (spine.hpp), which shortens the link from l5s1 to c7t1. Never throws for finite input.
  [[nodiscard]] Decoded decode(const Eigen::Ref<const Eigen::VectorXd>& coordinates, const Anchors& wanted,
                               double bend_rad = 0.0) const;

 private:
  /// What the primary chain needs to know of the body, or of its mirror image.
  struct Side {
    Chain primary;
    std::vector<std::size_t> steps;             ///< of the chain, to where the parts are
    std::array<Mat3, kPartCount> to_own_frame;  ///< of each part as it stands
  };
  /// Where a primary chain and its parts put the trunk.
  struct Trunk {
    Vec3 waist{0.0};
    std::array<Quat, kPartCount> turns{};  ///< of the parts, against the stand
  };
  /// `straight`: the same stand with a straight back.
  [[nodiscard]] Side side_of(const Posture& stand, const Posture& straight) const;
  [[nodiscard]] Trunk trunk_of(const Side& side, const double* stored, const Anchors& anchors) const;
  /// Where both primary chains put the trunk, on average.
  [[nodiscard]] Trunk trunk_of(const std::array<Side, 2>& sides, const double* stored, const Anchors& anchors) const;
  /// Pelvis, chest, and what points away from them.
  void place_trunk(const Trunk& trunk, const BentStand& stand, const double* pointers, Posture& posture) const;

  Linkage linkage_;
  Body body_;
  std::array<Side, 2> sides_;  ///< the body and its mirror image
  std::vector<double> pointer_lengths_;
  std::size_t waist_;  ///< place of l5s1 in the primary chain
};

/// The chain with the lengths it has in `posture` (limits of the linkage apply when `limited`).
[[nodiscard]] Chain chain_of(const ChainSpec& spec, const Posture& posture, bool limited);

/// Puts grips, hand front and hand back on the line from wrist to grip.
void place_hands(const Body& body, const std::array<Vec3, 2>& wrist_from_grip, Posture& posture);

/// Right-handed frame of three points: x along b - a, z along (b - a) x (apex - a). Columns are the axes.
[[nodiscard]] Mat3 triangle_frame(const Vec3& a, const Vec3& b, const Vec3& apex);

}  // namespace reachcast
