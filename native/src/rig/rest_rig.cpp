// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/rig/rest_rig.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace reachcast {
namespace {

constexpr double kUnsquare = 1e-6;    // how far axes may be from unit length and right angles
constexpr double kShortest_m = 1e-9;  // a link of this length has no direction; rigs may be tiny
constexpr double kFlattest = 1e-9;    // sine of the widest angle of a triangle that still shows a turn

template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  throw std::invalid_argument(text.str());
}

void check_rotation(const Mat3& m, const std::string& name) {
  double off = std::abs(glm::dot(glm::cross(m[0], m[1]), m[2]) - 1.0);
  for (int i = 0; i < 3; ++i) {
    if (!is_finite(m[i])) refuse(name, " is not finite");
    for (int j = i; j < 3; ++j) off = std::max(off, std::abs(glm::dot(m[i], m[j]) - (i == j ? 1.0 : 0.0)));
  }
  if (off > kUnsquare) {
    refuse(name, " is no rotation: it is off unit length, right angles or right-handedness by ", off, "; the limit is ",
           kUnsquare);
  }
}

void check_bones(const RestBones& bones) {
  const std::size_t count = bones.parents.size();
  if (bones.heads.size() != count || bones.rotations.size() != count) {
    refuse("a rig of ", count, " parents has ", bones.heads.size(), " heads and ", bones.rotations.size(),
           " rotations; there must be one of each per bone");
  }
  for (std::size_t b = 0; b < count; ++b) {
    const int parent = bones.parents[b];
    if (parent < -1 || parent >= static_cast<int>(b)) {
      refuse("parents[", b, "] is ", parent, "; it must be from -1 to ", static_cast<int>(b) - 1,
             ", for parents stand before their children");
    }
    if (!is_finite(bones.heads[b])) refuse("heads[", b, "] is not finite");
    check_rotation(bones.rotations[b], "rotations[" + std::to_string(b) + "]");
  }
}

void check_link(const Posture& joints, Joint from, Joint to) {
  const double length = glm::distance(joints[index(from)], joints[index(to)]);
  if (length >= kShortest_m) return;
  refuse("joints: ", joint_name(from), " and ", joint_name(to), " are ", length, " m apart; the least is ",
         kShortest_m);
}

void check_triangle(const Posture& joints, Joint a, Joint b, Joint c) {
  const Vec3 ab = joints[index(b)] - joints[index(a)], ac = joints[index(c)] - joints[index(a)];
  const double sine = glm::length(glm::cross(ab, ac)) / std::max(glm::length(ab) * glm::length(ac), 1e-300);
  if (sine >= kFlattest) return;
  refuse("joints: ", joint_name(a), ", ", joint_name(b), " and ", joint_name(c), " lie on one line (sine ", sine,
         "; the least is ", kFlattest, ")");
}

void check_joints(const Posture& joints) {
  using enum Joint;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!is_finite(joints[j])) refuse("joints: ", joint_name(static_cast<Joint>(j)), " is not finite");
  }
  for (const ArmNames& arm : arms()) {
    check_link(joints, arm.clavicle_root, arm.shoulder);
    check_link(joints, arm.shoulder, arm.elbow);
    check_link(joints, arm.elbow, arm.wrist);
    check_link(joints, arm.wrist, arm.grip);
  }
  for (const LegNames& leg : legs()) {
    check_link(joints, leg.hip, leg.knee);
    check_link(joints, leg.knee, leg.ankle);
    check_link(joints, leg.ankle, leg.ball);
  }
  check_link(joints, left_hip, right_hip);
  check_link(joints, l5s1, c7t1);
  check_link(joints, c7t1, tragion);
  check_link(joints, tragion, nasion);
  check_triangle(joints, left_hip, right_hip, l5s1);
  check_triangle(joints, l5s1, c7t1, right_clavicle);
}

}  // namespace

RestRig::RestRig(RestBones bones, const std::map<std::string, int>& segments, const Posture& joints, const Mat3& axes)
    : bones_(std::move(bones)), joints_(joints), axes_(axes) {
  check_bones(bones_);
  check_joints(joints_);
  check_rotation(axes_, "axes");
  map_segments(segments);
  find_keyed();
  find_back();
}

void RestRig::map_segments(const std::map<std::string, int>& segments) {
  const int count = static_cast<int>(bones_.parents.size());
  bone_of_.fill(kNone);
  segment_of_.assign(bones_.parents.size(), kNone);
  for (const auto& [name, bone] : segments) {
    const std::optional<Segment> segment = find_segment(name);
    if (!segment) refuse("segments: '", name, "' is no segment");
    if (bone < 0 || bone >= count) refuse("segments: ", name, " is bone ", bone, "; it must be from 0 to ", count - 1);
    int& owner = segment_of_[static_cast<std::size_t>(bone)];
    const bool is_trunk = *segment == Segment::spine || *segment == Segment::chest;
    const bool owned_by_trunk =
        owner == static_cast<int>(index(Segment::spine)) || owner == static_cast<int>(index(Segment::chest));
    if (owner != kNone && !(is_trunk && owned_by_trunk)) {
      refuse("segments: bone ", bone, " serves for both ", segment_name(static_cast<Segment>(owner)), " and ", name);
    }
    owner = static_cast<int>(index(*segment));
    bone_of_[index(*segment)] = bone;
  }
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    const auto segment = static_cast<Segment>(s);
    if (bone_of_[s] == kNone && segment != Segment::left_toe && segment != Segment::right_toe) {
      refuse("segments: ", segment_name(segment), " has no bone");
    }
  }
}

void RestRig::find_keyed() {
  std::vector<bool> is_keyed(bones_.parents.size(), false);
  for (const int mapped : bone_of_) {
    for (int b = mapped; b >= 0; b = bones_.parents[static_cast<std::size_t>(b)]) {
      is_keyed[static_cast<std::size_t>(b)] = true;
    }
  }
  slots_.assign(bones_.parents.size(), kNone);
  for (std::size_t b = 0; b < is_keyed.size(); ++b) {
    if (!is_keyed[b]) continue;
    slots_[b] = static_cast<int>(keyed_.size());
    keyed_.push_back(static_cast<int>(b));
  }
}

void RestRig::find_back() {
  const auto line_to = [&](Segment segment) {  // from the spine's bone down to this one; empty where it hangs elsewhere
    std::vector<int> line;
    int b = bone(segment);
    for (; b >= 0 && b != bone(Segment::spine); b = bones_.parents[static_cast<std::size_t>(b)]) line.push_back(b);
    if (b < 0) return std::vector<int>();
    line.push_back(b);
    std::reverse(line.begin(), line.end());
    return line;
  };
  back_ = line_to(Segment::chest);
  for (const Segment hanging : {Segment::neck, Segment::left_clavicle, Segment::right_clavicle}) {
    const std::vector<int> line = line_to(hanging);
    const auto [mine, other] = std::mismatch(back_.begin(), back_.end(), line.begin(), line.end());
    back_.erase(mine, back_.end());
  }
  if (back_.empty()) back_ = {bone(Segment::spine)};
  for (std::size_t i = 0; i < back_.size(); ++i) {
    const Vec3 next = i + 1 < back_.size() ? bones_.heads[static_cast<std::size_t>(back_[i + 1])] : at(Joint::c7t1);
    back_pieces_.push_back(next - bones_.heads[static_cast<std::size_t>(back_[i])]);
  }
  back_pieces_.front() += bones_.heads[static_cast<std::size_t>(back_[0])] - at(Joint::l5s1);
}

}  // namespace reachcast
