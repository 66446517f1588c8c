// SPDX-License-Identifier: GPL-3.0-or-later
/// Rigs and motions of them, made here so that the tests know the truth.
#pragma once

#include <map>
#include <random>
#include <string>

#include "reachcast/rig/rest_rig.hpp"
#include "reachcast/rig/turns.hpp"

namespace reachcast::tests {

inline constexpr double kRounding = 1e-12;  // products of about ten rotations of lengths near one

inline Vec3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<> normal;
  return glm::normalize(Vec3(normal(random), normal(random), normal(random)));
}

inline Mat3 random_turn(std::mt19937_64& random, double most_rad) {
  return turn_about(random_direction(random), std::uniform_real_distribution<>(-most_rad, most_rad)(random));
}

inline double difference(const Mat3& a, const Mat3& b) {
  double most = 0.0;
  for (int c = 0; c < 3; ++c) most = std::max(most, glm::length(a[c] - b[c]));
  return most;
}

/// The standing joints of published proportions, with clavicle roots of their own and hands along the forearms.
inline Posture rest_joints() {
  using enum Joint;
  Posture at = Body::from_stature(1.75).posture();
  at[index(left_clavicle)] = at[index(suprasternale)] - Vec3(0.02, 0, 0);
  at[index(right_clavicle)] = at[index(suprasternale)] + Vec3(0.02, 0, 0);
  return at;
}

struct RigParts {
  RestBones bones;
  std::map<std::string, int> segments;
  Posture joints;
  Mat3 axes;

  [[nodiscard]] RestRig rig() const { return {bones, segments, joints, axes}; }
};

/// One bone per segment below a root (bone 0), with bone axes at random. Bone 3 is not mapped: the trunk is root,
/// pelvis (1), spine (2), an unmapped bone, chest (4), neck (5), head (6); then the arms and the legs.
inline RigParts made_rig(std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  RigParts parts{{}, {}, rest_joints(), Mat3(1.0)};
  const auto add = [&](const std::string& segment, int parent, const Vec3& head) {
    const int bone = static_cast<int>(parts.bones.parents.size());
    parts.bones.parents.push_back(parent);
    parts.bones.heads.push_back(head);
    parts.bones.rotations.push_back(random_turn(random, kPi));
    if (!segment.empty()) parts.segments[segment] = bone;
    return bone;
  };
  using enum Joint;
  const auto at = [&](Joint joint) { return parts.joints[index(joint)]; };
  const int root = add("", -1, {0.1, -0.2, 0.0});
  const int pelvis = add("pelvis", root, 0.5 * (at(left_hip) + at(right_hip)));
  const int spine = add("spine", pelvis, at(l5s1));
  const int between = add("", spine, 0.5 * (at(l5s1) + at(c7t1)));
  const int chest = add("chest", between, 0.3 * at(l5s1) + 0.7 * at(c7t1));
  const int neck = add("neck", chest, at(c7t1));
  add("head", neck, at(tragion));
  for (std::size_t side = 0; side < 2; ++side) {
    const ArmNames& arm = arms()[side];
    const LegNames& leg = legs()[side];
    const std::string end = side == 0 ? ".L" : ".R";
    const int upper_arm = add("upper_arm" + end, add("clavicle" + end, chest, at(arm.clavicle_root)), at(arm.shoulder));
    add("hand" + end, add("forearm" + end, upper_arm, at(arm.elbow)), at(arm.wrist));
    const int shin = add("shin" + end, add("thigh" + end, pelvis, at(leg.hip)), at(leg.knee));
    add("toe" + end, add("foot" + end, shin, at(leg.ankle)), at(leg.ball));
  }
  return parts;
}

/// Postures in which every segment is turned at random against the one above it (elbows and knees about any axis), so
/// that every link keeps its length and pelvis and chest stay rigid. Smooth in time.
inline std::vector<Posture> made_motion(const RigParts& parts, std::uint64_t seed, std::size_t frames) {
  using enum Joint;
  std::mt19937_64 random(seed);
  std::vector<Vec3> axes(kJointCount);
  for (Vec3& axis : axes) axis = random_direction(random);
  const Posture& rest = parts.joints;
  std::vector<Posture> motion(frames, rest);
  for (std::size_t f = 0; f < frames; ++f) {
    Posture& out = motion[f];
    const double t = 2.0 * kPi * static_cast<double>(f) / static_cast<double>(frames);
    const auto swing = [&](Joint joint, double most) {
      return turn_about(axes[index(joint)], most * std::sin(t + 1.0));
    };
    const auto hang = [&](Joint joint, Joint from, const Mat3& turn) {
      out[index(joint)] = out[index(from)] + turn * (rest[index(joint)] - rest[index(from)]);
    };
    const Mat3 pelvis = swing(left_hip, 0.5), chest = swing(l5s1, 0.5) * pelvis, neck = swing(c7t1, 0.4) * chest;
    out[index(left_hip)] += Vec3(0.2 * std::sin(t), 0.1 * std::cos(t), 0.0);
    for (const Joint joint : {right_hip, l5s1}) hang(joint, left_hip, pelvis);
    for (const Joint joint : {c7t1, suprasternale, left_clavicle, right_clavicle}) hang(joint, l5s1, chest);
    hang(tragion, c7t1, neck);
    hang(nasion, tragion, swing(nasion, 0.4) * neck);
    for (const ArmNames& arm : arms()) {
      const Mat3 clavicle = swing(arm.clavicle_root, 0.2) * chest, upper = swing(arm.shoulder, 1.0) * clavicle;
      const Mat3 forearm = swing(arm.elbow, 0.7) * upper;
      hang(arm.shoulder, arm.clavicle_root, clavicle);
      hang(arm.elbow, arm.shoulder, upper);
      hang(arm.wrist, arm.elbow, forearm);
      hang(arm.grip, arm.wrist, swing(arm.wrist, 0.4) * forearm);
    }
    for (const LegNames& leg : legs()) {
      const Mat3 thigh = swing(leg.hip, 0.7) * pelvis, shin = swing(leg.knee, 0.6) * thigh;
      hang(leg.knee, leg.hip, thigh);
      hang(leg.ankle, leg.knee, shin);
      hang(leg.ball, leg.ankle, swing(leg.ankle, 0.3) * shin);
    }
  }
  return motion;
}

/// The joints that a posed rig passes through exactly.
inline bool is_exact(Joint joint) {
  const std::string_view name = joint_name(joint);
  return joint != Joint::nasion && name.find("hand_") == std::string_view::npos;
}

}  // namespace reachcast::tests
