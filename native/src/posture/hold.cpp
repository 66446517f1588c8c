// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/hold.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace reachcast {
namespace {

constexpr double kMargin_m = 1e-4;     // limbs are brought this far inside their reach
constexpr double kTolerance_m = 1e-6;  // when the trunk's search is done
constexpr int kMostRounds = 400;
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

/// The nearest point to `root` from which a limb with this reach spans to `anchor`.
Vec3 brought_within(const Interval& reach, const Vec3& root, const Vec3& anchor) {
  const double across = glm::distance(root, anchor);
  const double margin = std::min(kMargin_m, 0.25 * (reach.hi - reach.lo));
  const double wanted = std::clamp(across, reach.lo + margin, reach.hi - margin);
  if (across < 1e-9) return anchor + Vec3(0, 0, wanted);
  return anchor + (root - anchor) * (wanted / across);
}

constexpr std::array kTrunk{Joint::left_hip,      Joint::right_hip,      Joint::l5s1,          Joint::c7t1,
                            Joint::suprasternale, Joint::left_clavicle,  Joint::right_clavicle, Joint::tragion,
                            Joint::nasion};

ChainSpec leg(Joint ankle, Joint knee, Joint hip, const FlexionLimit& limit) {
  return {"leg", {hip, knee, ankle}, {knee}, {{knee, limit}}};
}

const ChainSpec& limb_named(const Linkage& linkage, std::string_view name) {
  return *std::find_if(linkage.limbs.begin(), linkage.limbs.end(), [&](const ChainSpec& s) { return s.name == name; });
}

ChainSpec mirrored_spec(ChainSpec spec) {
  for (Joint& j : spec.joints) j = mirrored(j);
  for (Joint& j : spec.pivots) j = mirrored(j);
  for (auto& [j, limit] : spec.limits) j = mirrored(j);
  return spec;
}

}  // namespace

Holder::Holder(const Linkage& linkage, const Body& body, double body_mass_kg)
    : limbs_([&]() -> std::array<Limb, 4> {
        const FlexionLimit knee = limb_named(linkage, "right leg").limits.front().second;
        const ChainSpec right_leg = leg(Joint::right_ankle, Joint::right_knee, Joint::right_hip, knee);
        const ChainSpec left_arm = limb_named(linkage, "left arm");
        const auto limb = [&](const ChainSpec& spec) { return Limb{spec, chain_of(spec, body.posture(), true)}; };
        return {limb(mirrored_spec(right_leg)), limb(right_leg), limb(left_arm), limb(mirrored_spec(left_arm))};
      }()),
      body_mass_kg_(body_mass_kg) {}

HoldReport Holder::hold(Posture& posture, const Anchors& anchors, const Load& load) const {
  const Corners ends{anchors.ankle[0], anchors.ankle[1], anchors.grip[0], anchors.grip[1]};
  const Coordinates coordinates = limb_coordinates(posture);
  Corners before, now;
  for (std::size_t i = 0; i < 4; ++i) before[i] = posture[index(limbs_[i].spec.joints.front())];
  now = before;
  HoldReport report;
  const Posture decoded = posture;
  for (int round = 0; round < kBalanceRounds; ++round) {
    bring_within_reach(now, ends, report);
    const RigidMotion motion = nearest_rigid_motion(before, now);
    for (const Joint j : kTrunk) posture[index(j)] = motion(decoded[index(j)]);
    span_limbs(posture, ends, coordinates);
    const Vec3 excess = beyond_support(centre_of_mass(posture, body_mass_kg_, load), anchors);
    report.unbalanced_m = glm::length(excess);
    report.trunk_shift_m = glm::distance(decoded[index(Joint::l5s1)], posture[index(Joint::l5s1)]);
    const double trace = motion.rotation[0][0] + motion.rotation[1][1] + motion.rotation[2][2];
    report.trunk_turn_rad = std::acos(std::clamp(0.5 * (trace - 1.0), -1.0, 1.0));
    if (report.unbalanced_m < kTolerance_m || report.shortfall_m > 0.0) break;
    if (round + 1 < kBalanceRounds) {
      for (Vec3& root : now) root -= excess / kMassThatMoves;
    }
  }
  for (std::size_t side = 0; side < 2; ++side) {  // the foot goes with its ankle
    const Vec3 missed = posture[index(limbs_[side].spec.joints.back())] - ends[side];
    posture[index(side == 0 ? Joint::left_ball : Joint::right_ball)] = anchors.ball[side] + missed;
  }
  return report;
}

/// The limbs' own coordinates, before anything moves.
Holder::Coordinates Holder::limb_coordinates(const Posture& posture) const {
  Coordinates coordinates;
  for (std::size_t i = 0; i < 4; ++i) {
    Points points;
    for (const Joint j : limbs_[i].spec.joints) points.push_back(posture[index(j)]);
    coordinates[i].resize(limbs_[i].chain.coordinate_count());
    limbs_[i].chain.encode(points, coordinates[i]);
  }
  return coordinates;
}

/// Every root is pulled to where its limb just reaches; the trunk follows as a rigid body; again, until all reach.
void Holder::bring_within_reach(Corners& roots, const Corners& ends, HoldReport& report) const {
  for (int round = 0; round < kMostRounds; ++round) {
    Corners wanted;
    double worst = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      wanted[i] = brought_within(limbs_[i].chain.reach(), roots[i], ends[i]);
      const double gap = glm::distance(wanted[i], roots[i]);
      if (gap > worst) worst = gap, report.shortfall_from = limbs_[i].spec.joints.front();
    }
    report.shortfall_m = worst < kMargin_m ? 0.0 : worst;
    if (worst < kTolerance_m) return;
    const RigidMotion step = nearest_rigid_motion(roots, wanted);
    for (Vec3& p : roots) p = step(p);
  }
}

void Holder::span_limbs(Posture& posture, const Corners& ends, const Coordinates& coordinates) const {
  for (std::size_t i = 0; i < 4; ++i) {
    const Limb& limb = limbs_[i];
    const Vec3 root = posture[index(limb.spec.joints.front())];
    const double across = glm::distance(root, ends[i]);
    const double wanted = std::clamp(across, limb.chain.reach().lo, limb.chain.reach().hi);
    Points points(limb.spec.joints.size());
    limb.chain.decode(root, across == wanted ? ends[i] : root + (ends[i] - root) * (wanted / across), coordinates[i], points);
    for (std::size_t j = 0; j < points.size(); ++j) posture[index(limb.spec.joints[j])] = points[j];
  }
}

}  // namespace reachcast
