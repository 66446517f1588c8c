// SPDX-License-Identifier: GPL-3.0-or-later
/// Both hands on the object, both feet flat, the weight over them: the correction after decoding (the 2004 paper names
/// the needs on p. 551 and leaves them open).
///
/// The trunk (pelvis, chest, head) is moved as one piece: over the feet where the weight is beyond them, then by a small
/// rigid motion that brings all four limbs within their reach of ankles and grips; where the two disagree the limbs win.
/// Then the limbs are decoded again from their own coordinates between their new roots and the anchors. Where nothing is
/// amiss, nothing moves but the ankles.
#pragma once

#include <vector>

#include "reachcast/posture/balance.hpp"
#include "reachcast/posture/whole_body.hpp"

namespace reachcast {

/// What was changed, and what could not be.
struct HoldReport {
  double trunk_shift_m = 0.0;   ///< how far l5s1 moved
  double trunk_turn_rad = 0.0;  ///< how far the trunk turned
  double unbalanced_m = 0.0;    ///< how far the weight still lies beyond the feet
  double shortfall_m = 0.0;     ///< > 0: the anchors cannot be held; by this much the worst limb is too short or too long
  Joint shortfall_from = Joint::right_shoulder;  ///< root of that limb
};

class Holder {
 public:
  /// body_mass_kg > 0.
  Holder(const Linkage& linkage, const Body& body, double body_mass_kg);

  /// Changes `posture` so that balls, ankles and grips are exactly at their anchors. Where report.shortfall_m > 0 the
  /// limbs stop short of them. Links keep their lengths in either case.
  [[nodiscard]] HoldReport hold(Posture& posture, const Anchors& anchors, const Load& load) const;

 private:
  struct Limb {
    ChainSpec spec;  ///< from its root on the trunk to its anchor
    Chain chain;
  };
  using Corners = std::array<Vec3, 4>;
  using Coordinates = std::array<std::vector<double>, 4>;

  [[nodiscard]] Coordinates limb_coordinates(const Posture& posture) const;
  void bring_within_reach(Corners& roots, const Corners& ends, HoldReport& report) const;
  void span_limbs(Posture& posture, const Corners& ends, const Coordinates& coordinates) const;

  std::array<Limb, 4> limbs_;  ///< left leg, right leg, left arm, right arm
  double body_mass_kg_;
};

}  // namespace reachcast
