// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/simulate/pose.hpp"

#include <algorithm>
#include <cmath>

#include "reachcast/posture/stretch.hpp"
#include "reachcast/posture/twist.hpp"

namespace reachcast::simulate {
namespace {

using enum Joint;

Vec3 middle(const Vec3& a, const Vec3& b) {
  return 0.5 * (a + b);
}

/// Reach of two links with a limited hinge between them.
Interval reach_of(double upper, double lower, const FlexionLimit& limit) {
  const auto across = [&](double flexion) {
    return std::sqrt(upper * upper + lower * lower + 2.0 * upper * lower * std::cos(flexion));
  };
  return {across(limit.max_rad), across(limit.min_rad)};
}

Interval joined(const Interval& a, const Interval& b) {
  return {std::max({0.0, a.lo - b.hi, b.lo - a.hi}), a.hi + b.hi};
}

/// The turn that takes `from` to the direction of `to` and whose right axis is as near to `right` as that leaves it.
Mat3 turn_between(const Vec3& from, const Vec3& to, const Vec3& right) {
  const auto frame = [](const Vec3& along, const Vec3& near) {
    const Vec3 x = glm::normalize(near - glm::dot(near, along) * along);
    return Mat3(x, along, glm::cross(x, along));
  };
  return frame(glm::normalize(to), right) * glm::transpose(frame(glm::normalize(from), Vec3(1, 0, 0)));
}

/// How far the chain may stretch between two points, kept a hair within what it can.
double within(const Interval& reach, double across) {
  return std::clamp(across, reach.lo + 1e-6, reach.hi - 1e-6);
}

Vec3 level_right(double yaw) {
  return {std::cos(yaw), std::sin(yaw), 0.0};
}

}  // namespace

PoseModel::PoseModel(const Body& body, double body_mass_kg)
    : body_(body),
      mass_kg_(body_mass_kg),
      holder_(two_handed_linkage(), body, body_mass_kg),
      leg_(reach_of(body.distance(right_hip, right_knee), body.distance(right_knee, right_ankle),
                    two_handed_linkage().limbs[1].limit)),
      arm_(reach_of(body.distance(right_shoulder, right_elbow), body.distance(right_elbow, right_wrist),
                    two_handed_linkage().limbs[3].limit)),
      hand_m_(body.distance(right_wrist, right_grip)),
      hips_to_waist_(body.at(l5s1) - middle(body.at(left_hip), body.at(right_hip))) {
  pelvis_m_ = glm::length(hips_to_waist_);
}

Anchors PoseModel::anchors(const std::array<Vec3, 2>& grips) const {
  Anchors out = anchors_of(body_.posture());
  out.grip = grips;
  return out;
}

/// The clavicle is raised about the forward axis, then swung forward about the upward one.
Vec3 PoseModel::shoulder_in_chest(const Unknowns& x, bool left) const {
  const Vec3 root = body_.at(right_clavicle), link = body_.at(right_shoulder) - root;
  const double raise = at(x, Unknown::shoulder_raise), forward = at(x, Unknown::shoulder_forward);
  const double out = std::cos(raise) * link.x - std::sin(raise) * link.z;
  const double up = std::sin(raise) * link.x + std::cos(raise) * link.z;
  const Vec3 turned_link(std::cos(forward) * out - std::sin(forward) * link.y,
                         std::sin(forward) * out + std::cos(forward) * link.y, up);
  const Vec3 right = root + turned_link - body_.at(l5s1);
  return left ? Vec3(-right.x, right.y, right.z) : right;
}

/// The chain in the vertical plane through ankles and wrists. All pivots are behind or above the line between their
/// neighbours, as they are on anybody who holds something in front of the body.
PoseModel::Spine PoseModel::spine(const Unknowns& x, const Vec3& ankles, const Vec3& wrists,
                                  const Vec3& shoulder) const {
  const Vec3 away = wrists - ankles;
  const Vec3 right = glm::normalize(Vec3(away.y, -away.x, 0.0)), normal = -right;
  const double trunk = std::hypot(shoulder.y, shoulder.z);
  const Interval trunk_and_arm = joined({trunk, trunk}, arm_);
  const Interval upper = joined({pelvis_m_, pelvis_m_}, trunk_and_arm);
  const auto fraction = [&](Unknown which) { return from_logit(at(x, which)); };

  const Interval whole = joined(leg_, upper);
  const auto [leg, above] = StretchDomain(leg_, upper, within(whole, glm::length(away)))
                                .lengths(fraction(Unknown::hip_sum), fraction(Unknown::hip_difference));
  Spine out;
  out.hips = pivot_point(ankles, wrists, leg, above, normal);
  const double rest =
      StretchDomain({pelvis_m_, pelvis_m_}, trunk_and_arm, within(upper, glm::distance(out.hips, wrists)))
          .distal_length(fraction(Unknown::waist));
  out.waist = pivot_point(out.hips, wrists, pelvis_m_, rest, normal);
  const Vec3 sway = 0.1 * at(x, Unknown::sway) * right;
  out.hips += sway;
  out.waist += sway;
  const double arm = StretchDomain({trunk, trunk}, arm_, within(trunk_and_arm, glm::distance(out.waist, wrists)))
                         .distal_length(fraction(Unknown::shoulder));
  out.shoulders = pivot_point(out.waist, wrists, trunk, arm, normal);
  return out;
}

/// Half of the neck's bend is in the neck, all of it in the head. Returns the head's turn.
Mat3 PoseModel::place_head(const Unknowns& x, const Mat3& chest, Posture& posture) const {
  const auto turn = [&](double share) {
    const double pitch = -share * at(x, Unknown::neck_pitch);
    const Mat3 nod(Vec3(1, 0, 0), Vec3(0, std::cos(pitch), std::sin(pitch)),
                   Vec3(0, -std::sin(pitch), std::cos(pitch)));
    const double yaw = share * at(x, Unknown::neck_yaw);
    return chest * Mat3(level_right(yaw), Vec3(-std::sin(yaw), std::cos(yaw), 0.0), Vec3(0, 0, 1)) * nod;
  };
  posture[index(tragion)] = posture[index(c7t1)] + turn(0.5) * (body_.at(tragion) - body_.at(c7t1));
  posture[index(nasion)] = posture[index(tragion)] + turn(1.0) * (body_.at(nasion) - body_.at(tragion));
  return turn(1.0);
}

/// Knees go forward and apart; elbows go behind an arm that hangs and below one that reaches out, and apart.
std::array<LimbPlane, kLimbCount> PoseModel::limb_planes(const Unknowns& x, const Decoded& decoded,
                                                         const Frames& frames, const Anchors& anchors) const {
  std::array<LimbPlane, kLimbCount> planes;
  for (std::size_t i = 0; i < kLimbCount; ++i) {
    const bool is_arm = i >= 2;
    const std::size_t side = i % 2;
    const double outward = side == 0 ? -1.0 : 1.0;
    const Vec3 root = decoded.trunk[index(two_handed_linkage().limbs[i].root)];
    const Vec3 end = is_arm ? anchors.grip[side] + decoded.wrist_from_grip[side] : anchors.ankle[side];
    const Vec3 axis = glm::normalize(end - root);
    const double yaw = 0.3 * at(x, Unknown::pelvis_yaw);
    const Vec3 right = is_arm ? frames.chest[0] : level_right(yaw);
    const Vec3 inner = glm::normalize(is_arm ? glm::cross(axis, right) : glm::cross(right, axis));
    const Vec3 side_way = glm::normalize(right - glm::dot(right, axis) * axis);
    const double apart = at(x, is_arm ? Unknown::elbows_apart : Unknown::knees_apart);
    const Vec3 toward = std::cos(apart) * inner + outward * std::sin(apart) * side_way;
    planes[i] = {glm::cross(toward, axis), axis};
  }
  return planes;
}

Pose PoseModel::pose(const Unknowns& x, const Anchors& anchors, const Load& load) const {
  const Vec3 ankles = middle(anchors.ankle[0], anchors.ankle[1]);
  Pose out;
  Decoded& decoded = out.decoded;
  const double pitch = at(x, Unknown::hand_pitch), inward = at(x, Unknown::hand_inward);
  const double yaw = facing_yaw(anchors);
  for (const std::size_t side : {0u, 1u}) {
    const Vec3 hand((side == 0 ? 1.0 : -1.0) * std::sin(inward), std::cos(inward) * std::cos(pitch),
                    -std::cos(inward) * std::sin(pitch));
    decoded.wrist_from_grip[side] = -hand_m_ * turned(hand, yaw);
  }
  const Vec3 wrists =
      middle(anchors.grip[0] + decoded.wrist_from_grip[0], anchors.grip[1] + decoded.wrist_from_grip[1]);
  const Vec3 shoulder = shoulder_in_chest(x, false);
  const Spine chain = spine(x, ankles, wrists, shoulder);

  out.frames.pelvis = turn_between(hips_to_waist_, chain.waist - chain.hips, level_right(at(x, Unknown::pelvis_yaw)));
  out.frames.chest = turn_between(Vec3(0.0, shoulder.y, shoulder.z), chain.shoulders - chain.waist,
                                  level_right(at(x, Unknown::chest_yaw)));
  Posture& trunk = decoded.trunk;
  const auto place = [&](Joint j, const Mat3& turn) {
    trunk[index(j)] = chain.waist + turn * (body_.at(j) - body_.at(l5s1));
  };
  for (const Joint j : {left_hip, right_hip, l5s1}) place(j, out.frames.pelvis);
  for (const Joint j : {c7t1, suprasternale, left_clavicle, right_clavicle}) place(j, out.frames.chest);
  trunk[index(left_shoulder)] = chain.waist + out.frames.chest * shoulder_in_chest(x, true);
  trunk[index(right_shoulder)] = chain.waist + out.frames.chest * shoulder;
  out.frames.head = place_head(x, out.frames.chest, trunk);
  decoded.planes = limb_planes(x, decoded, out.frames, anchors);
  out.posture = held(decoded, anchors, load, out.held);
  return out;
}

Posture PoseModel::held(const Decoded& decoded, const Anchors& anchors, const Load& load, HoldReport& report) const {
  return holder_.hold(decoded, {Vec3(0.0), Vec3(0.0), decoded.wrist_from_grip}, anchors, load, report);
}

}  // namespace reachcast::simulate
