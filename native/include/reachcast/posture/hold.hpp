// SPDX-License-Identifier: GPL-3.0-or-later
/// Both hands on the object and both feet flat: the first correction after decoding (the 2004 paper names the need on
/// p. 551 and leaves it open).
///
/// The trunk (pelvis, chest, clavicles, head) is moved as one piece by the smallest rigid motion that brings all four
/// limbs within their reach of wrists and ankles; then the limbs are decoded again from their own coordinates between
/// their new roots and the anchors. Where the limbs reach already, only the ankles go to their places and nothing
/// else moves.
#pragma once

#include <string>

#include "reachcast/posture/whole_body.hpp"

namespace reachcast {

/// What was changed, and what could not be.
struct HoldReport {
  double trunk_shift_m = 0.0;    ///< how far l5s1 moved
  double trunk_turn_rad = 0.0;   ///< how far the trunk turned
  double shortfall_m = 0.0;      ///< > 0: the anchors cannot be held; by this much the worst limb is too short (or long)
  Joint shortfall_from = Joint::right_shoulder;  ///< root of that limb
};

class Holder {
 public:
  Holder(const Linkage& linkage, const Body& body);

  /// Changes `posture` so that balls, ankles and grips are exactly at their anchors. Where report.shortfall_m > 0 the
  /// posture is the nearest one and the anchors are not held.
  [[nodiscard]] HoldReport hold(Posture& posture, const Anchors& anchors) const;

 private:
  struct Limb {
    ChainSpec spec;   ///< from its root on the trunk to its anchor
    Chain chain;
  };
  std::array<Limb, 4> limbs_;  ///< left leg, right leg, left arm, right arm
  Body body_;
};

}  // namespace reachcast
