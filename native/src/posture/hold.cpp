// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/hold.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace reachcast {
namespace {

constexpr double kMargin_m = 1e-4;        // limbs are held this far inside their reach
constexpr double kRoomToSmooth_m = 8e-3;  // and settled this far inside it
constexpr double kRoomBetween_m = 4e-3;   // and completed this far: what happens between two moments
constexpr double kTolerance_m = 1e-6;     // when the trunk's search is done
constexpr int kReachRounds = 150;
constexpr double kTurnStep = 0.25;  // share of the wanted turn taken in each round: a shift is preferred
constexpr double kMostTurn_rad = 0.6;
constexpr int kBalanceRounds = 12;
constexpr double kFalling_m = 0.12;      // weight this far beyond the feet: nobody stands there
constexpr double kMassThatMoves = 0.75;  // share of the weight that goes with the trunk when hands and feet stay

// A wrist flexes and extends by some 70 to 80 degrees (American Academy of Orthopaedic Surgeons, 1965).
constexpr double kFreeWrist_rad = 0.7;
constexpr double kMostWrist_rad = 1.1;  // smoothing over time may add some
constexpr int kWristRounds = 4;

using Corners = std::array<Vec3, 4>;  // roots of the limbs, or their ends

struct RigidMotion {
  Mat3 rotation{1.0};
  Vec3 pivot{0.0}, moved_pivot{0.0};
  [[nodiscard]] Vec3 operator()(const Vec3& p) const { return moved_pivot + rotation * (p - pivot); }
};

Vec3 rotation_vector(const Mat3& rotation) {
  const Quat q = glm::normalize(glm::quat_cast(rotation));
  const Vec3 axis(q.x, q.y, q.z);
  const double sine = glm::length(axis);
  if (sine < 1e-15) return Vec3(0.0);
  return axis * ((q.w < 0.0 ? -2.0 : 2.0) * std::atan2(sine, std::abs(q.w)) / sine);
}

Mat3 rotation_by(const Vec3& vector) {
  const double angle = glm::length(vector);
  return angle < 1e-15 ? Mat3(1.0) : glm::mat3_cast(glm::angleAxis(angle, vector / angle));
}

/// The rigid motion that brings `from` nearest to `to` in the least-squares sense (Kabsch 1976).
RigidMotion nearest_rigid_motion(const Corners& from, const Corners& to) {
  Vec3 a(0.0), b(0.0);
  for (std::size_t i = 0; i < 4; ++i) a += 0.25 * from[i], b += 0.25 * to[i];
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < 4; ++i) covariance += to_eigen(to[i] - b) * to_eigen(from[i] - a).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1.0, 1.0, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0);
  const Eigen::Matrix3d r = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  return {Mat3(to_glm(r.col(0)), to_glm(r.col(1)), to_glm(r.col(2))), a, b};
}

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

constexpr std::array kTrunk{Joint::left_hip,       Joint::right_hip,     Joint::l5s1,           Joint::c7t1,
                            Joint::suprasternale,  Joint::left_clavicle, Joint::right_clavicle, Joint::left_shoulder,
                            Joint::right_shoulder, Joint::tragion,       Joint::nasion};

/// All roots by the mean of the pulls that there are.
void shift(Corners& roots, const Corners& wanted) {
  Vec3 sum(0.0);
  double pulls = 0.0;
  for (std::size_t i = 0; i < kLimbCount; ++i) {
    if (wanted[i] != roots[i]) sum += wanted[i] - roots[i], pulls += 1.0;
  }
  for (Vec3& root : roots) root += sum / std::max(pulls, 1.0);
}

/// `roots` as the rigid image of `before` nearest to them, turned by no more than the limit.
void limit_turn(const Corners& before, Corners& roots) {
  RigidMotion motion = nearest_rigid_motion(before, roots);
  const Vec3 turn = rotation_vector(motion.rotation);
  const double angle = glm::length(turn);
  if (angle > kMostTurn_rad) motion.rotation = rotation_by(turn * (kMostTurn_rad / angle));
  for (std::size_t i = 0; i < kLimbCount; ++i) roots[i] = motion(before[i]);
}

/// `hand` as it is up to a moderate bend from `forearm`, and less and less of the rest: a bend never exceeds the limit.
Vec3 bent_at_most(const Vec3& forearm, const Vec3& hand) {
  const double bend = std::acos(std::clamp(glm::dot(forearm, hand), -1.0, 1.0));
  if (bend <= kFreeWrist_rad) return hand;
  const double room = kMostWrist_rad - kFreeWrist_rad;
  const double allowed = kFreeWrist_rad + room * (1.0 - std::exp(-(bend - kFreeWrist_rad) / room));
  const Vec3 axis = glm::cross(forearm, hand);
  if (glm::length(axis) < 1e-9) return forearm;
  return glm::angleAxis(allowed, glm::normalize(axis)) * forearm;
}

/// Ankles and wrists, in the order of Linkage::limbs.
Corners limb_ends(const std::array<Vec3, 2>& wrist_from_grip, const Anchors& anchors) {
  return {anchors.ankle[0], anchors.ankle[1], anchors.grip[0] + wrist_from_grip[0],
          anchors.grip[1] + wrist_from_grip[1]};
}

/// How l5s1 goes, and how the trunk turns about it, as the roots of its limbs go from `before` to `now`.
std::pair<Vec3, Vec3> move_of(const Decoded& decoded, const Corners& before, const Corners& now) {
  const RigidMotion motion = nearest_rigid_motion(before, now);
  const Vec3 waist = decoded.trunk[index(Joint::l5s1)];
  return {motion(waist) - waist, rotation_vector(motion.rotation)};
}

/// The roots of the limbs as the stance moves them.
Corners moved(const Decoded& decoded, const Corners& roots, const Stance& stance) {
  const Vec3 waist = decoded.trunk[index(Joint::l5s1)];
  const RigidMotion motion{rotation_by(stance.turn_rad), waist, waist + stance.shift};
  Corners out;
  for (std::size_t i = 0; i < kLimbCount; ++i) out[i] = motion(roots[i]);
  return out;
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

Holder::Corners Holder::roots_of(const Decoded& decoded) const {
  Corners roots;
  for (std::size_t i = 0; i < kLimbCount; ++i) roots[i] = decoded.trunk[index(limbs_[i].root)];
  return roots;
}

Stance Holder::settle(const Decoded& decoded, const Anchors& anchors, const Load& load) const {
  const Corners before = roots_of(decoded);
  Corners now = before;
  for (int round = 0; round < kBalanceRounds; ++round) {
    const Wrists wrists = limited_wrists(decoded, now, anchors);
    bring_within_reach(before, now, limb_ends(wrists, anchors), kRoomToSmooth_m);
    if (round + 1 == kBalanceRounds) break;
    const Posture posture = spanned(decoded, before, now, wrists, anchors);
    const Vec3 excess = beyond_support(centre_of_mass(posture, body_mass_kg_, load), anchors);
    if (glm::length(excess) < kTolerance_m) break;
    for (Vec3& root : now) root -= excess / kMassThatMoves;
  }
  const auto [shift, turn] = move_of(decoded, before, now);
  return {shift, turn, limited_wrists(decoded, now, anchors)};
}

Stance Holder::completed(const Decoded& decoded, const Stance& stance, const Anchors& anchors) const {
  const Corners before = roots_of(decoded);
  Corners now = moved(decoded, before, stance);
  bring_within_reach(before, now, limb_ends(wrists_of(decoded, stance), anchors), kRoomBetween_m);
  const auto [shift, turn] = move_of(decoded, before, now);
  return {shift, turn, stance.wrist_from_grip};
}

Posture Holder::hold(const Decoded& decoded, const Stance& stance, const Anchors& anchors, const Load& load,
                     HoldReport& report) const {
  const Corners before = roots_of(decoded);
  Corners now = moved(decoded, before, stance);
  const Wrists wrists = wrists_of(decoded, stance);
  const Corners ends = limb_ends(wrists, anchors);
  bring_within_reach(before, now, ends, kMargin_m);
  measure_shortfall(now, ends, report);
  const Posture posture = spanned(decoded, before, now, wrists, anchors);
  report.unbalanced_m = glm::length(beyond_support(centre_of_mass(posture, body_mass_kg_, load), anchors));
  if (report.shortfall_m == 0.0 && report.unbalanced_m > kFalling_m) {
    // The limbs can hold on, the person cannot: so much nearer would the trunk have to be.
    const auto stretch = [&](std::size_t arm) { return glm::distance(now[arm], ends[arm]) / chains_[arm].reach().hi; };
    report.shortfall_m = (report.unbalanced_m - kFalling_m) / kMassThatMoves;
    report.shortfall_from = limbs_[stretch(2) > stretch(3) ? 2 : 3].root;
  }
  report.trunk_shift_m = glm::distance(decoded.trunk[index(Joint::l5s1)], posture[index(Joint::l5s1)]);
  report.trunk_turn_rad = glm::length(rotation_vector(nearest_rigid_motion(before, now).rotation));
  return posture;
}

/// A hand bends from its forearm by no more than the limit. The forearm in turn depends on where the hand puts the
/// wrist, so this is done a few times over.
Holder::Wrists Holder::limited_wrists(const Decoded& decoded, const Corners& roots, const Anchors& anchors) const {
  Wrists wrists = decoded.wrist_from_grip;
  for (const std::size_t side : {0u, 1u}) {
    const std::size_t arm = 2 + side;
    const LimbSpec& limb = limbs_[arm];
    const double length = glm::length(wrists[side]);
    const Vec3 learned = -wrists[side] / length, grip = anchors.grip[side];
    Posture posture{};
    posture[index(limb.root)] = roots[arm];
    Vec3 forearm = glm::distance(grip, roots[arm]) > 1e-9 ? glm::normalize(grip - roots[arm]) : learned;
    for (int round = 0; round < kWristRounds; ++round) {
      wrists[side] = -length * bent_at_most(forearm, learned);
      span_limb(limb, chains_[arm], decoded.planes[arm], grip + wrists[side], posture);
      forearm = glm::normalize(posture[index(limb.end)] - posture[index(limb.hinge)]);
    }
    wrists[side] = -length * bent_at_most(forearm, learned);
  }
  return wrists;
}

/// The decoded posture with its trunk moved as the roots have moved, its limbs, hands and feet where they belong.
Posture Holder::spanned(const Decoded& decoded, const Corners& before, const Corners& roots, const Wrists& wrists,
                        const Anchors& anchors) const {
  const Corners ends = limb_ends(wrists, anchors);
  const RigidMotion motion = nearest_rigid_motion(before, roots);
  Posture posture = decoded.trunk;
  for (const Joint j : kTrunk) posture[index(j)] = motion(decoded.trunk[index(j)]);
  for (std::size_t i = 0; i < kLimbCount; ++i) span_limb(limbs_[i], chains_[i], decoded.planes[i], ends[i], posture);
  place_hands(body_, wrists, posture);
  for (const std::size_t side : {0u, 1u}) {  // the foot goes with its ankle
    const Joint ball = side == 0 ? Joint::left_ball : Joint::right_ball;
    posture[index(ball)] = anchors.ball[side] + posture[index(limbs_[side].end)] - ends[side];
  }
  return posture;
}

/// Every root is pulled to where its limb just reaches and the trunk follows as a rigid body, again and again until all
/// reach. The same steps are taken for every input, so that neighbouring inputs have neighbouring results.
void Holder::bring_within_reach(const Corners& before, Corners& roots, const Corners& ends, double margin_m) const {
  for (int round = 0; round < kReachRounds; ++round) {
    Corners wanted;
    if (pulled_roots(roots, ends, kLimbCount, margin_m, wanted) < kTolerance_m) return;
    shift(roots, wanted);
    (void)pulled_roots(roots, ends, kLimbCount, margin_m, wanted);
    RigidMotion step = nearest_rigid_motion(roots, wanted);
    step.rotation = rotation_by(kTurnStep * rotation_vector(step.rotation));
    step.moved_pivot = step.pivot;
    for (Vec3& root : roots) root = step(root);
    limit_turn(before, roots);
  }
}

/// The feet hold; what is missing is missing at the hands.
void Holder::measure_shortfall(Corners roots, const Corners& ends, HoldReport& report) const {
  report.shortfall_m = 0.0;
  Corners wanted;
  if (pulled_roots(roots, ends, kLimbCount, kMargin_m, wanted) < kMargin_m) return;
  for (int round = 0; round < kReachRounds; ++round) {
    if (pulled_roots(roots, ends, 2, kMargin_m, wanted) < kTolerance_m) break;
    shift(roots, wanted);
  }
  pulled_roots(roots, ends, kLimbCount, kMargin_m, wanted);
  for (std::size_t i = 0; i < kLimbCount; ++i) {
    const double gap = glm::distance(wanted[i], roots[i]);
    if (gap > report.shortfall_m) report.shortfall_m = gap, report.shortfall_from = limbs_[i].root;
  }
}

/// Where the first `count` limbs want their roots; the others stay. Returns the longest pull.
double Holder::pulled_roots(const Corners& roots, const Corners& ends, std::size_t count, double margin_m,
                            Corners& wanted) const {
  wanted = roots;
  double longest = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    wanted[i] = brought_within(chains_[i].reach(), roots[i], ends[i], margin_m, i < 2);
    longest = std::max(longest, glm::distance(wanted[i], roots[i]));
  }
  return longest;
}

}  // namespace reachcast
