// SPDX-License-Identifier: GPL-3.0-or-later
/// Working hands on the object, both feet flat, the weight over them: the correction after decoding (the 2004 paper
/// names the needs on p. 551 and leaves them open).
///
/// The trunk (pelvis, chest, shoulders, head) is moved as one piece, by a shift and a small turn, to where all
/// limbs reach their ankles and wrists and the weight is over the feet; where the two disagree the limbs win. A free
/// arm hangs from wherever its shoulder comes to be and has no say in it. Then
/// the limbs are spanned in their planes between trunk and anchors; a hand that would fold back on its forearm gives
/// way. To settle the trunk and to hold on are two steps, so that a motion can smooth the first over time.
#pragma once

#include <vector>

#include "reachcast/posture/balance.hpp"
#include "reachcast/posture/rigid_motion.hpp"
#include "reachcast/posture/whole_body.hpp"

namespace reachcast {

/// How a decoded posture is corrected: its trunk turned about its l5s1 and then shifted, its hands turned at the grips.
struct Stance {
  Vec3 shift{0.0};                        ///< metres
  Vec3 turn_rad{0.0};                     ///< axis times angle
  std::array<Vec3, 2> wrist_from_grip{};  ///< left, right; only their directions count
};

/// What was changed, and what could not be.
struct HoldReport {
  double trunk_shift_m = 0.0;   ///< how far l5s1 moved
  double trunk_turn_rad = 0.0;  ///< how far the trunk turned
  double unbalanced_m = 0.0;    ///< how far the weight still lies beyond the feet
  double shortfall_m = 0.0;     ///< > 0: the anchors cannot be held; by so much the worse arm is too short or
                                ///< too long with the feet on the floor, or would be without falling over
  Joint shortfall_from = Joint::right_shoulder;  ///< root of that limb
};

class MovedTrunk;

class Holder {
 public:
  /// body_mass_kg > 0.
  Holder(const Linkage& linkage, const Body& body, double body_mass_kg);

  /// The stance that limbs, wrists and weight want, with 8 mm to spare in the limbs.
  [[nodiscard]] Stance settle(const Decoded& decoded, const Anchors& anchors, const Load& load) const;

  /// The stance with the last move of the trunk that `hold` would still make, and that with 4 mm to spare in the limbs:
  /// what smoothing over time has taken away from a settled one.
  [[nodiscard]] Stance completed(const Decoded& decoded, const Stance& stance, const Anchors& anchors) const;

  /// The posture so corrected, with balls, ankles and working grips exactly at their anchors; what the stance leaves
  /// out of reach is made up by a last move of the trunk. Where report.shortfall_m > 0 the limbs stop short of their
  /// anchors. Links keep their lengths in either case.
  [[nodiscard]] Posture hold(const Decoded& decoded, const Stance& stance, const Anchors& anchors, const Load& load,
                             HoldReport& report) const;

  /// Both at once, for a single posture.
  [[nodiscard]] Posture hold(const Decoded& decoded, const Anchors& anchors, const Load& load,
                             HoldReport& report) const {
    return hold(decoded, settle(decoded, anchors, load), anchors, load, report);
  }

 private:
  using Wrists = std::array<Vec3, 2>;            ///< from grip to wrist, left and right
  using Pulling = std::array<bool, kLimbCount>;  ///< which limbs pull their roots

  [[nodiscard]] Wrists limited_wrists(const Decoded& decoded, const Corners& roots, const Anchors& anchors) const;
  [[nodiscard]] Posture spanned(const Decoded& decoded, const MovedTrunk& trunk, const Wrists& wrists,
                                const Anchors& anchors) const;
  [[nodiscard]] Corners limb_ends(const Wrists& wrists, const Corners& roots, const Anchors& anchors) const;
  void bring_within_reach(MovedTrunk& trunk, const Wrists& wrists, const Anchors& anchors, double margin_m) const;
  void measure_shortfall(Corners roots, const Corners& ends, const Pulling& pulling, HoldReport& report) const;
  double pulled_roots(const Corners& roots, const Corners& ends, const Pulling& pulling, double margin_m,
                      Corners& wanted) const;

  std::array<LimbSpec, kLimbCount> limbs_;
  std::vector<Chain> chains_;  ///< of the limbs, on this body
  Body body_;
  double body_mass_kg_;
};

}  // namespace reachcast
