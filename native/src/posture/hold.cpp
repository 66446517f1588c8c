// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/hold.hpp"

#include <algorithm>
#include <cmath>

#include "moved_trunk.hpp"

namespace reachcast {
namespace {

constexpr double kMargin_m = 1e-4;        // limbs are held this far inside their reach
constexpr double kRoomToSmooth_m = 8e-3;  // and settled this far inside it
constexpr double kRoomBetween_m = 4e-3;   // and completed this far: what happens between two moments
constexpr double kTolerance_m = 1e-6;     // when the trunk's search is done
constexpr int kReachRounds = 150;
constexpr double kMostTurn_rad = 0.6;
constexpr int kBalanceRounds = 12;
constexpr double kFalling_m = 0.12;      // weight this far beyond the feet: nobody stands there
constexpr double kMassThatMoves = 0.75;  // share of the weight that goes with the trunk when hands and feet stay

// A wrist flexes and extends by some 70 to 80 degrees (American Academy of Orthopaedic Surgeons, 1965).
constexpr double kFreeWrist_rad = 0.7;
constexpr double kMostWrist_rad = 1.1;  // smoothing over time may add some
constexpr int kWristRounds = 4;
constexpr double kFreeStretch = 0.985;  // share of its reach up to which a free arm is as learned

/// Where a limb with this reach spans from `root` to `anchor`: the nearest such place when the limb is too short. When
/// it is too long a shoulder goes straight away from its wrist; a hip goes up, since a squat ends in standing up.
Vec3 brought_within(const Interval& reach, const Vec3& root, const Vec3& anchor, double margin_m, bool is_leg) {
  const double margin = std::min(margin_m, 0.25 * (reach.hi - reach.lo));
  const double lo = reach.lo + margin, hi = reach.hi - margin;
  const Vec3 away = root - anchor;
  const double across = glm::length(away);
  if (across > hi) return anchor + away * (hi / across);
  if (across >= lo) return root;
  if (!is_leg) return across > 1e-9 ? anchor + away * (lo / across) : anchor + Vec3(0, 0, lo);
  const double level = std::hypot(away.x, away.y);
  return anchor + Vec3(away.x, away.y, std::sqrt(lo * lo - level * level));
}

/// The mean of the pulls that there are.
Vec3 mean_pull(const Corners& roots, const Corners& wanted) {
  Vec3 sum(0.0);
  double pulls = 0.0;
  for (std::size_t i = 0; i < kLimbCount; ++i) {
    if (wanted[i] != roots[i]) sum += wanted[i] - roots[i], pulls += 1.0;
  }
  return sum / std::max(pulls, 1.0);
}

/// `hand` as it is up to a moderate bend from `forearm`, and less and less of the rest: a bend never exceeds the limit.
Vec3 bent_at_most(const Vec3& forearm, const Vec3& hand) {
  static const double free_cosine = std::cos(kFreeWrist_rad);
  const double cosine = glm::dot(forearm, hand);
  if (cosine >= free_cosine) return hand;
  const double bend = std::acos(std::max(cosine, -1.0)), room = kMostWrist_rad - kFreeWrist_rad;
  const double allowed = kFreeWrist_rad + room * (1.0 - std::exp(-(bend - kFreeWrist_rad) / room));
  const Vec3 across = hand - cosine * forearm;
  const double size = glm::length(across);
  if (size < 1e-9) return forearm;
  return std::cos(allowed) * forearm + std::sin(allowed) / size * across;
}

/// `across` up to nearly the whole reach, and less and less of the rest: a free arm never comes to its end with a jerk.
Vec3 stretched_at_most(const Interval& reach, const Vec3& across) {
  const double free = kFreeStretch * reach.hi, room = reach.hi - free, size = glm::length(across);
  if (size <= free) return across;
  return across * ((free + room * (1.0 - std::exp((free - size) / room))) / size);
}

/// Which limbs hold on to something: all but a free arm.
std::array<bool, kLimbCount> holding(Hands hands) {
  return {true, true, works(hands, 0), works(hands, 1)};
}

std::array<Vec3, 2> wrists_of(const Decoded& decoded, const Stance& stance) {
  std::array<Vec3, 2> wrists;
  for (const std::size_t side : {0u, 1u}) {
    wrists[side] = glm::normalize(stance.wrist_from_grip[side]) * glm::length(decoded.wrist_from_grip[side]);
  }
  return wrists;
}

}  // namespace

Holder::Holder(const Linkage& linkage, const Body& body, double body_mass_kg)
    : limbs_(linkage.limbs), body_(body), body_mass_kg_(body_mass_kg) {
  for (const LimbSpec& limb : limbs_) chains_.push_back(chain_of(limb, body.posture(), true));
}

Stance Holder::settle(const Decoded& decoded, const Anchors& anchors, const Load& load) const {
  MovedTrunk trunk(decoded, limbs_);
  for (int round = 0; round < kBalanceRounds; ++round) {
    const Wrists wrists = limited_wrists(decoded, trunk.roots(), anchors);
    bring_within_reach(trunk, wrists, anchors, kRoomToSmooth_m);
    if (round + 1 == kBalanceRounds) break;
    const Posture posture = spanned(decoded, trunk, wrists, anchors);
    const Vec3 excess = beyond_support(centre_of_mass(posture, body_mass_kg_, load), anchors);
    if (glm::length(excess) < kTolerance_m) break;
    trunk.shift_by(-excess / kMassThatMoves);
  }
  return {trunk.shift(), rotation_vector(trunk.turn()), limited_wrists(decoded, trunk.roots(), anchors)};
}

Stance Holder::completed(const Decoded& decoded, const Stance& stance, const Anchors& anchors) const {
  MovedTrunk trunk(decoded, limbs_, stance);
  bring_within_reach(trunk, wrists_of(decoded, stance), anchors, kRoomBetween_m);
  return {trunk.shift(), rotation_vector(trunk.turn()), stance.wrist_from_grip};
}

Posture Holder::hold(const Decoded& decoded, const Stance& stance, const Anchors& anchors, const Load& load,
                     HoldReport& report) const {
  MovedTrunk trunk(decoded, limbs_, stance);
  const Wrists wrists = wrists_of(decoded, stance);
  bring_within_reach(trunk, wrists, anchors, kMargin_m);
  const Corners ends = limb_ends(wrists, trunk.roots(), anchors);
  const Pulling pulling = holding(anchors.hands);
  measure_shortfall(trunk.roots(), ends, pulling, report);
  const Posture posture = spanned(decoded, trunk, wrists, anchors);
  report.unbalanced_m = glm::length(beyond_support(centre_of_mass(posture, body_mass_kg_, load), anchors));
  if (report.shortfall_m == 0.0 && report.unbalanced_m > kFalling_m) {
    // The limbs can hold on, the person cannot: so much nearer would the trunk have to be.
    const auto stretch = [&](std::size_t arm) {
      return pulling[arm] ? glm::distance(trunk.roots()[arm], ends[arm]) / chains_[arm].reach().hi : 0.0;
    };
    report.shortfall_m = (report.unbalanced_m - kFalling_m) / kMassThatMoves;
    report.shortfall_from = limbs_[stretch(2) > stretch(3) ? 2 : 3].root;
  }
  report.trunk_shift_m = glm::length(trunk.shift());
  report.trunk_turn_rad = glm::length(rotation_vector(trunk.turn()));
  return posture;
}

/// A hand bends from its forearm by no more than the limit. The forearm in turn depends on where the hand puts the
/// wrist, so this is done a few times over, or until nothing changes any more.
Holder::Wrists Holder::limited_wrists(const Decoded& decoded, const Corners& roots, const Anchors& anchors) const {
  Wrists wrists;
  for (const std::size_t side : {0u, 1u}) {
    const std::size_t arm = 2 + side;
    const double length = glm::length(decoded.wrist_from_grip[side]);
    const Vec3 learned = -decoded.wrist_from_grip[side] / length;
    const Vec3 grip = works(anchors.hands, side) ? anchors.grip[side] : roots[arm] + anchors.hang;
    const double away = glm::distance(grip, roots[arm]);
    Vec3 hand = bent_at_most(away > 1e-9 ? (grip - roots[arm]) / away : learned, learned);
    for (int round = 0; round < kWristRounds; ++round) {
      const SpannedLimb limb = spanned_limb(chains_[arm], decoded.planes[arm], roots[arm], grip - length * hand);
      const Vec3 before = hand;
      hand = bent_at_most(glm::normalize(limb.end - limb.hinge), learned);
      if (hand == before) break;
    }
    wrists[side] = -length * hand;
  }
  return wrists;
}

/// The decoded posture with its trunk moved, its limbs, hands and feet where they belong.
Posture Holder::spanned(const Decoded& decoded, const MovedTrunk& trunk, const Wrists& wrists,
                        const Anchors& anchors) const {
  const Corners ends = limb_ends(wrists, trunk.roots(), anchors);
  Posture posture;
  trunk.place(decoded, posture);
  for (std::size_t i = 0; i < kLimbCount; ++i) span_limb(limbs_[i], chains_[i], decoded.planes[i], ends[i], posture);
  place_hands(body_, wrists, posture);
  for (const std::size_t side : {0u, 1u}) {  // the foot goes with its ankle
    const Joint ball = side == 0 ? Joint::left_ball : Joint::right_ball;
    posture[index(ball)] = anchors.ball[side] + posture[index(limbs_[side].end)] - ends[side];
  }
  return posture;
}

/// Ankles and wrists, in the order of Linkage::limbs. A free wrist goes with its shoulder.
Corners Holder::limb_ends(const Wrists& wrists, const Corners& roots, const Anchors& anchors) const {
  Corners ends{anchors.ankle[0], anchors.ankle[1], anchors.grip[0] + wrists[0], anchors.grip[1] + wrists[1]};
  if (anchors.hands == Hands::both) return ends;
  const std::size_t side = free_side(anchors.hands), arm = 2 + side;
  ends[arm] = roots[arm] + stretched_at_most(chains_[arm].reach(), anchors.hang + wrists[side]);
  return ends;
}

/// Every root is pulled to where its limb just reaches and the trunk follows as a rigid body, again and again until all
/// reach. The same steps are taken for every input, so that neighbouring inputs have neighbouring results.
void Holder::bring_within_reach(MovedTrunk& trunk, const Wrists& wrists, const Anchors& anchors,
                                double margin_m) const {
  const Corners ends = limb_ends(wrists, trunk.roots(), anchors);
  const Pulling pulling = holding(anchors.hands);
  for (int round = 0; round < kReachRounds; ++round) {
    Corners wanted;
    if (pulled_roots(trunk.roots(), ends, pulling, margin_m, wanted) < kTolerance_m) return;
    trunk.shift_by(mean_pull(trunk.roots(), wanted));
    (void)pulled_roots(trunk.roots(), ends, pulling, margin_m, wanted);
    // Only a quarter of the turn: a shift is preferred.
    trunk.turn_about_roots_by(quarter_of(nearest_turn(trunk.roots(), wanted)), kMostTurn_rad);
  }
}

/// The feet hold; what is missing is missing at the hands.
void Holder::measure_shortfall(Corners roots, const Corners& ends, const Pulling& pulling, HoldReport& report) const {
  report.shortfall_m = 0.0;
  Corners wanted;
  if (pulled_roots(roots, ends, pulling, kMargin_m, wanted) < kMargin_m) return;
  for (int round = 0; round < kReachRounds; ++round) {
    if (pulled_roots(roots, ends, {true, true, false, false}, kMargin_m, wanted) < kTolerance_m) break;
    const Vec3 pull = mean_pull(roots, wanted);
    for (Vec3& root : roots) root += pull;
  }
  pulled_roots(roots, ends, pulling, kMargin_m, wanted);
  for (std::size_t i = 0; i < kLimbCount; ++i) {
    const double gap = glm::distance(wanted[i], roots[i]);
    if (gap > report.shortfall_m) report.shortfall_m = gap, report.shortfall_from = limbs_[i].root;
  }
}

/// Where the limbs that pull want their roots; the others stay. Returns the longest pull.
double Holder::pulled_roots(const Corners& roots, const Corners& ends, const Pulling& pulling, double margin_m,
                            Corners& wanted) const {
  wanted = roots;
  double longest = 0.0;
  for (std::size_t i = 0; i < kLimbCount; ++i) {
    if (!pulling[i]) continue;
    wanted[i] = brought_within(chains_[i].reach(), roots[i], ends[i], margin_m, i < 2);
    if (wanted[i] != roots[i]) longest = std::max(longest, glm::distance(wanted[i], roots[i]));
  }
  return longest;
}

}  // namespace reachcast
