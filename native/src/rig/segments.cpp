// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/rig/segments.hpp"

namespace reachcast {
namespace {

constexpr std::array<std::string_view, kSegmentCount> kNames{
    "pelvis",      "spine",     "chest",   "neck",    "head",   "clavicle.L", "upper_arm.L",
    "forearm.L",   "hand.L",    "thigh.L", "shin.L",  "foot.L", "toe.L",      "clavicle.R",
    "upper_arm.R", "forearm.R", "hand.R",  "thigh.R", "shin.R", "foot.R",     "toe.R"};

constexpr std::array<Segment, kJointCount> make_carriers() {
  using enum Segment;
  // In the order of Joint: nine joints of each side, then the midline, then what is derived.
  return {left_foot,     left_foot,  left_shin,  left_thigh, left_upper_arm, left_forearm,  left_hand,
          left_hand,     left_hand,  right_foot, right_foot, right_shin,     right_thigh,   right_upper_arm,
          right_forearm, right_hand, right_hand, right_hand, spine,          neck,          chest,
          neck,          head,       left_hand,  right_hand, left_clavicle,  right_clavicle};
}
constexpr std::array<Segment, kJointCount> kCarriers = make_carriers();

}  // namespace

std::string_view segment_name(Segment segment) {
  return kNames.at(index(segment));
}

std::optional<Segment> find_segment(std::string_view name) {
  for (std::size_t i = 0; i < kSegmentCount; ++i) {
    if (kNames[i] == name) return static_cast<Segment>(i);
  }
  return std::nullopt;
}

Segment carrier(Joint joint) {
  return kCarriers.at(index(joint));
}

const std::array<ArmNames, 2>& arms() {
  using J = Joint;
  using S = Segment;
  static constexpr std::array<ArmNames, 2> kArms{
      {{J::left_clavicle, J::left_shoulder, J::left_elbow, J::left_wrist, J::left_grip, J::right_grip, S::left_clavicle,
        S::left_upper_arm, S::left_forearm, S::left_hand, 1.0},
       {J::right_clavicle, J::right_shoulder, J::right_elbow, J::right_wrist, J::right_grip, J::left_grip,
        S::right_clavicle, S::right_upper_arm, S::right_forearm, S::right_hand, -1.0}}};
  return kArms;
}

const std::array<LegNames, 2>& legs() {
  using J = Joint;
  using S = Segment;
  static constexpr std::array<LegNames, 2> kLegs{
      {{J::left_hip, J::left_knee, J::left_ankle, J::left_ball, S::left_thigh, S::left_shin, S::left_foot, S::left_toe},
       {J::right_hip, J::right_knee, J::right_ankle, J::right_ball, S::right_thigh, S::right_shin, S::right_foot,
        S::right_toe}}};
  return kLegs;
}

}  // namespace reachcast
