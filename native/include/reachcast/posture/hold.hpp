// SPDX-License-Identifier: GPL-3.0-or-later
/// Both hands on the object, both feet flat, the weight over them: the correction after decoding (the 2004 paper names
/// the needs on p. 551 and leaves them open).
///
/// The trunk (pelvis, chest, head) is moved as one piece: over the feet where the weight is beyond them, then to where
/// all four limbs reach their ankles and grips, by a shift or, where no shift will do, by a shift and a turn of at
/// most 0.6 rad; where weight and limbs disagree the limbs win. Then the limbs are spanned in their planes between
/// trunk and anchors.
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
  double shortfall_m = 0.0;     ///< > 0: the anchors cannot be held; by so much the worse arm is too short or
                                ///< too long with the feet on the floor
  Joint shortfall_from = Joint::right_shoulder;  ///< root of that limb
};

class Holder {
 public:
  /// body_mass_kg > 0.
  Holder(const Linkage& linkage, const Body& body, double body_mass_kg);

  /// The decoded posture with balls, ankles and grips exactly at their anchors. Where report.shortfall_m > 0 the limbs
  /// stop short of them. Links keep their lengths in either case.
  [[nodiscard]] Posture hold(const Decoded& decoded, const Anchors& anchors, const Load& load,
                             HoldReport& report) const;

 private:
  using Corners = std::array<Vec3, kLimbCount>;  ///< roots of the limbs, or their ends

  void bring_within_reach(const Corners& before, Corners& roots, const Corners& ends, HoldReport& report) const;
  void measure_shortfall(Corners& roots, const Corners& ends, HoldReport& report) const;
  [[nodiscard]] double pulled_roots(const Corners& roots, const Corners& ends, std::size_t count,
                                    Corners& wanted) const;

  std::array<LimbSpec, kLimbCount> limbs_;
  std::vector<Chain> chains_;  ///< of the limbs, on this body
  Body body_;
  double body_mass_kg_;
};

}  // namespace reachcast
