// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/trunk_pose.hpp"

#include <algorithm>

namespace reachcast {
namespace {

Mat3 part_frame(const RigidSpec& part, const Posture& posture) {
  return triangle_frame(posture[index(part.a)], posture[index(part.b)], posture[index(part.apex)]);
}

Vec3 direction(const Vec3& v, const Vec3& otherwise) {
  const double size = glm::length(v);
  return size > 1e-9 ? v / size : glm::normalize(otherwise);
}

/// All but the turns.
void add_rest(const TrunkPose& pose, double weight, TrunkPose& sum) {
  sum.waist += weight * pose.waist;
  for (std::size_t i = 0; i < sum.pointers.size(); ++i) sum.pointers[i] += weight * pose.pointers[i];
  for (std::size_t i = 0; i < kLimbCount; ++i) {
    sum.planes[i].normal += weight * pose.planes[i].normal;
    sum.planes[i].axis += weight * pose.planes[i].axis;
  }
  for (std::size_t i = 0; i < 2; ++i) sum.wrist_from_grip[i] += weight * pose.wrist_from_grip[i];
  sum.bend_rad += weight * pose.bend_rad;
}

double sign_towards(const Quat& turn, const Quat& other) {
  return glm::dot(turn, other) < 0.0 ? -1.0 : 1.0;
}

}  // namespace

TrunkPose no_pose() {
  TrunkPose pose;
  pose.parts.fill(Quat(0, 0, 0, 0));
  return pose;
}

void add(const TrunkPose& pose, double weight, TrunkPose& sum) {
  for (std::size_t i = 0; i < sum.parts.size(); ++i) {
    sum.parts[i] = sum.parts[i] + sign_towards(pose.parts[i], sum.parts[i]) * weight * pose.parts[i];
  }
  add_rest(pose, weight, sum);
}

TrunkPose lack_of(const TrunkPose& pose, const TrunkPose& wanted) {
  TrunkPose lack = wanted;
  for (std::size_t i = 0; i < lack.parts.size(); ++i)
    lack.parts[i] = sign_towards(wanted.parts[i], pose.parts[i]) * wanted.parts[i] - pose.parts[i];
  add_rest(pose, -1.0, lack);
  return lack;
}

void make_good(const TrunkPose& lack, double share, TrunkPose& pose) {
  for (std::size_t i = 0; i < pose.parts.size(); ++i) pose.parts[i] = pose.parts[i] + share * lack.parts[i];
  add_rest(lack, share, pose);
}

TrunkPose trunk_pose_of(const Linkage& linkage, const Body& body, const Decoded& decoded) {
  TrunkPose pose;
  pose.waist = decoded.trunk[index(Joint::l5s1)];
  pose.bend_rad = decoded.bend_rad;
  const BentStand stand = bent_stand(body, decoded.bend_rad);
  std::array<Mat3, 2> turns;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const RigidSpec& part = linkage.parts[i];
    turns[i] = part_frame(part, decoded.trunk) * glm::transpose(part_frame(part, stand.posture));
    pose.parts[i] = glm::normalize(glm::quat_cast(turns[i]));
  }
  turns[kChest] = turns[kChest] * stand.upper;
  std::size_t next = 0;
  for (const PointerSpec& pointer : linkage.pointers) {
    if (pointer.part == PointerSpec::kObject) continue;
    const Vec3 link = decoded.trunk[index(pointer.to)] - decoded.trunk[index(pointer.from)];
    pose.pointers[next++] = glm::transpose(turns[pointer.part]) * glm::normalize(link);
  }
  pose.planes = decoded.planes;
  pose.wrist_from_grip = decoded.wrist_from_grip;
  return pose;
}

Decoded decoded_of(const Linkage& linkage, const Body& body, const TrunkPose& pose) {
  Decoded out;
  out.bend_rad = pose.bend_rad;
  const BentStand stand = bent_stand(body, pose.bend_rad);
  std::array<Mat3, 2> turns;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const RigidSpec& part = linkage.parts[i];
    turns[i] = glm::mat3_cast(glm::normalize(pose.parts[i]));
    const auto place = [&](Joint j) {
      out.trunk[index(j)] = pose.waist + turns[i] * (stand.posture[index(j)] - body.at(Joint::l5s1));
    };
    for (const Joint j : {part.a, part.b, part.apex}) place(j);
    for (const Joint j : part.riders) place(j);
  }
  turns[kChest] = turns[kChest] * stand.upper;
  std::size_t next = 0;
  for (const PointerSpec& pointer : linkage.pointers) {
    if (pointer.part == PointerSpec::kObject) continue;
    const Vec3 local = direction(pose.pointers[next++], body.at(pointer.to) - body.at(pointer.from));
    out.trunk[index(pointer.to)] =
        out.trunk[index(pointer.from)] + turns[pointer.part] * local * body.distance(pointer.from, pointer.to);
  }
  out.planes = pose.planes;
  for (std::size_t side = 0; side < 2; ++side) {
    const Joint wrist = side == 0 ? Joint::left_wrist : Joint::right_wrist;
    const Joint grip = side == 0 ? Joint::left_grip : Joint::right_grip;
    out.wrist_from_grip[side] =
        direction(pose.wrist_from_grip[side], body.at(wrist) - body.at(grip)) * body.distance(wrist, grip);
  }
  return out;
}

std::array<double, 4> cubic_weights(double t) {
  const double s = 1.0 - t;
  return {s * s * s / 6.0, 2.0 / 3.0 - t * t * (1.0 - 0.5 * t), 2.0 / 3.0 - s * s * (1.0 - 0.5 * s), t * t * t / 6.0};
}

TrunkTrack::TrunkTrack(const Linkage& linkage, const Body& body, std::span<const Decoded> moments, double spacing_s)
    : linkage_(linkage), body_(body), spacing_s_(spacing_s) {
  poses_.reserve(moments.size());
  for (const Decoded& moment : moments) poses_.push_back(trunk_pose_of(linkage, body, moment));
}

Decoded TrunkTrack::at(double time_s) const {
  const auto last = static_cast<long>(poses_.size()) - 1;
  const double place = std::clamp(time_s / spacing_s_, 0.0, static_cast<double>(last));
  const long before = std::min(static_cast<long>(place), last - 1);
  const std::array<double, 4> weights = cubic_weights(place - static_cast<double>(before));
  TrunkPose mean = no_pose();
  for (long k = 0; k < 4; ++k) {
    add(poses_[static_cast<std::size_t>(std::clamp(before - 1 + k, 0L, last))], weights[static_cast<std::size_t>(k)],
        mean);
  }
  return decoded_of(linkage_, body_, mean);
}

}  // namespace reachcast
