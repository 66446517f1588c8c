// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/hold.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace reachcast {
namespace {

constexpr double kMargin_m = 1e-4;     // limbs are brought this far inside their reach
constexpr double kTolerance_m = 1e-6;  // when the trunk's search is done
constexpr int kShiftRounds = 60;
constexpr int kTurnRounds = 300;
constexpr double kMostTurn_rad = 0.6;
constexpr int kBalanceRounds = 12;
constexpr double kMassThatMoves = 0.75;  // share of the weight that goes with the trunk when the hands and feet stay

using Corners = std::array<Vec3, 4>;  // roots of the limbs, or their ends

struct RigidMotion {
  Mat3 rotation{1.0};
  Vec3 pivot{0.0}, moved_pivot{0.0};
  [[nodiscard]] Vec3 operator()(const Vec3& p) const { return moved_pivot + rotation * (p - pivot); }
};

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
Vec3 brought_within(const Interval& reach, const Vec3& root, const Vec3& anchor, bool is_leg) {
  const double margin = std::min(kMargin_m, 0.25 * (reach.hi - reach.lo));
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

double angle_of(const Mat3& r) {
  return std::acos(std::clamp(0.5 * (r[0][0] + r[1][1] + r[2][2] - 1.0), -1.0, 1.0));
}

}  // namespace

Holder::Holder(const Linkage& linkage, const Body& body, double body_mass_kg)
    : limbs_(linkage.limbs), body_(body), body_mass_kg_(body_mass_kg) {
  for (const LimbSpec& limb : limbs_) chains_.push_back(chain_of(limb, body.posture(), true));
}

Posture Holder::hold(const Decoded& decoded, const Anchors& anchors, const Load& load, HoldReport& report) const {
  const Corners ends{anchors.ankle[0], anchors.ankle[1], anchors.grip[0] + decoded.wrist_from_grip[0],
                     anchors.grip[1] + decoded.wrist_from_grip[1]};
  Posture posture = decoded.trunk;
  Corners before;
  for (std::size_t i = 0; i < kLimbCount; ++i) before[i] = posture[index(limbs_[i].root)];
  Corners now = before;
  for (int round = 0; round < kBalanceRounds; ++round) {
    bring_within_reach(before, now, ends, report);
    const RigidMotion motion = nearest_rigid_motion(before, now);
    for (const Joint j : kTrunk) posture[index(j)] = motion(decoded.trunk[index(j)]);
    for (std::size_t i = 0; i < kLimbCount; ++i) span_limb(limbs_[i], chains_[i], decoded.planes[i], ends[i], posture);
    place_hands(body_, decoded.wrist_from_grip, posture);
    for (const std::size_t side : {0u, 1u}) {  // the foot goes with its ankle
      posture[index(side == 0 ? Joint::left_ball : Joint::right_ball)] =
          anchors.ball[side] + posture[index(limbs_[side].end)] - ends[side];
    }
    const Vec3 excess = beyond_support(centre_of_mass(posture, body_mass_kg_, load), anchors);
    report.unbalanced_m = glm::length(excess);
    report.trunk_shift_m = glm::distance(decoded.trunk[index(Joint::l5s1)], posture[index(Joint::l5s1)]);
    report.trunk_turn_rad = angle_of(motion.rotation);
    if (report.unbalanced_m < kTolerance_m || report.shortfall_m > 0.0) break;
    if (round + 1 < kBalanceRounds) {
      for (Vec3& root : now) root -= excess / kMassThatMoves;
    }
  }
  return posture;
}

/// Every root is pulled to where its limb just reaches and the trunk follows, again and again until all reach: at first
/// without turning, then as a rigid body.
void Holder::bring_within_reach(const Corners& before, Corners& roots, const Corners& ends, HoldReport& report) const {
  report.shortfall_m = 0.0;
  for (int round = 0; round < kShiftRounds + kTurnRounds; ++round) {
    Corners wanted;
    if (pulled_roots(roots, ends, kLimbCount, wanted) < kTolerance_m) return;
    if (round < kShiftRounds) {
      shift(roots, wanted);
      continue;
    }
    const RigidMotion step = nearest_rigid_motion(roots, wanted);
    Corners moved = roots;
    for (Vec3& root : moved) root = step(root);
    if (angle_of(nearest_rigid_motion(before, moved).rotation) > kMostTurn_rad) break;
    roots = moved;
  }
  measure_shortfall(roots, ends, report);
}

/// The feet hold; what is missing is missing at the hands.
void Holder::measure_shortfall(Corners& roots, const Corners& ends, HoldReport& report) const {
  Corners wanted;
  if (pulled_roots(roots, ends, kLimbCount, wanted) < kMargin_m) return;
  for (int round = 0; round < kShiftRounds && pulled_roots(roots, ends, 2, wanted) > kTolerance_m; ++round)
    shift(roots, wanted);
  (void)pulled_roots(roots, ends, kLimbCount, wanted);
  for (std::size_t i = 0; i < kLimbCount; ++i) {
    const double gap = glm::distance(wanted[i], roots[i]);
    if (gap > report.shortfall_m) report.shortfall_m = gap, report.shortfall_from = limbs_[i].root;
  }
}

/// Where the first `count` limbs want their roots; the others stay. Returns the longest pull.
double Holder::pulled_roots(const Corners& roots, const Corners& ends, std::size_t count, Corners& wanted) const {
  wanted = roots;
  double longest = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    wanted[i] = brought_within(chains_[i].reach(), roots[i], ends[i], i < 2);
    longest = std::max(longest, glm::distance(wanted[i], roots[i]));
  }
  return longest;
}

}  // namespace reachcast
