// SPDX-License-Identifier: GPL-3.0-or-later
/// The segments of a body that bones of a rig stand for.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "reachcast/body/joints.hpp"

namespace reachcast {

enum class Segment : std::size_t {
  pelvis,
  spine,
  chest,
  neck,
  head,
  left_clavicle,
  left_upper_arm,
  left_forearm,
  left_hand,
  left_thigh,
  left_shin,
  left_foot,
  left_toe,
  right_clavicle,
  right_upper_arm,
  right_forearm,
  right_hand,
  right_thigh,
  right_shin,
  right_foot,
  right_toe,
};
inline constexpr std::size_t kSegmentCount = 21;

[[nodiscard]] constexpr std::size_t index(Segment segment) {
  return static_cast<std::size_t>(segment);
}

/// As bone maps write it: "pelvis", "upper_arm.L".
[[nodiscard]] std::string_view segment_name(Segment segment);
[[nodiscard]] std::optional<Segment> find_segment(std::string_view name);

/// The segment whose bone carries the joint centre as a fixed point.
[[nodiscard]] Segment carrier(Joint joint);

/// What retargeting names by side.
struct ArmNames {
  Joint clavicle_root, shoulder, elbow, wrist, grip, other_grip;
  Segment clavicle, upper_arm, forearm, hand;
  double palm_sign;  ///< which way along the elbow's axis the palm faces
};
struct LegNames {
  Joint hip, knee, ankle, ball;
  Segment thigh, shin, foot, toe;
};
[[nodiscard]] const std::array<ArmNames, 2>& arms();  ///< left, right
[[nodiscard]] const std::array<LegNames, 2>& legs();  ///< left, right

}  // namespace reachcast
