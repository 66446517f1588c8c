// SPDX-License-Identifier: GPL-3.0-or-later
/// A whole posture from a few unconstrained numbers: stretch-pivot coordinates (Faraway 2004, section 2) of the chain
/// ankles - hips - l5s1 - shoulders - wrists, and angles for what the chain leaves open. Whatever the numbers are,
/// hands and feet are where they must be and every segment has its length, so that to find a posture is to minimise
/// freely.
#pragma once

#include <Eigen/Core>
#include <array>

#include "reachcast/posture/hold.hpp"
#include "reachcast/posture/whole_body.hpp"

namespace reachcast::simulate {

/// The unknowns. Stretches are logits of the fractions of stretch.hpp; angles in radians; the rest as said.
enum class Unknown : Eigen::Index {
  hip_sum,           ///< hips: how far legs and upper body together are stretched
  hip_difference,    ///< and which of the two is stretched more
  waist,             ///< l5s1: how far trunk and arms are stretched
  shoulder,          ///< shoulders: how far the arms are
  shoulder_raise,    ///< of both clavicles
  shoulder_forward,  ///< of both clavicles
  hand_pitch,        ///< how far the hands point below level
  hand_inward,       ///< how far they point towards each other
  knees_apart,       ///< outward turn of the knees about their leg
  elbows_apart,      ///< outward turn of the elbows about their arm
  pelvis_yaw,        ///< of the pelvis about the vertical, relative to the feet, to the left
  chest_yaw,         ///< of the chest, relative to the feet
  sway,              ///< of the hips to the right of the plane of the chain, decimetres
  neck_pitch,        ///< forward, relative to the chest
  neck_yaw,          ///< to the left, relative to the chest
};
inline constexpr Eigen::Index kUnknowns = 15;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;

[[nodiscard]] inline double at(const Unknowns& x, Unknown which) {
  return x[static_cast<Eigen::Index>(which)];
}

/// Turns of pelvis, chest and head from an upright stand; columns are right, forward, up.
struct Frames {
  Mat3 pelvis{1.0}, chest{1.0}, head{1.0};
};

struct Pose {
  Decoded decoded;  ///< before the limbs are spanned
  Posture posture{};
  Frames frames;
  HoldReport held;  ///< trunk_shift_m: what was still needed to hold on where the body is turned to the side
};

class PoseModel {
 public:
  /// body_mass_kg > 0.
  PoseModel(const Body& body, double body_mass_kg);

  /// anchors: both grips at least 5 cm ahead of or beside the ankles; feet flat. Where nobody of this body could hold
  /// them, pose.held.shortfall_m > 0. Never throws for finite input.
  [[nodiscard]] Pose pose(const Unknowns& x, const Anchors& anchors, const Load& load) const;

  /// A body that is given; limbs spanned, hands and feet put where they must be.
  [[nodiscard]] Posture held(const Decoded& decoded, const Anchors& anchors, const Load& load,
                             HoldReport& report) const;

  /// Feet as the body stands.
  [[nodiscard]] Anchors anchors(const std::array<Vec3, 2>& grips) const;

  [[nodiscard]] const Body& body() const { return body_; }
  [[nodiscard]] double body_mass_kg() const { return mass_kg_; }

 private:
  struct Spine {
    Vec3 hips, waist, shoulders;
  };
  [[nodiscard]] Spine spine(const Unknowns& x, const Vec3& ankles, const Vec3& wrists, const Vec3& shoulder) const;
  [[nodiscard]] Vec3 shoulder_in_chest(const Unknowns& x, bool left) const;
  [[nodiscard]] Mat3 place_head(const Unknowns& x, const Mat3& chest, Posture& posture) const;
  [[nodiscard]] std::array<LimbPlane, kLimbCount> limb_planes(const Unknowns& x, const Decoded& decoded,
                                                              const Frames& frames, const Anchors& anchors) const;

  Body body_;
  double mass_kg_;
  Holder holder_;
  Interval leg_, arm_;
  double pelvis_m_, hand_m_;
  Vec3 hips_to_waist_;
};

}  // namespace reachcast::simulate
