// SPDX-License-Identifier: GPL-3.0-or-later
/// The joint centres that every stage after mocap/ speaks of: the 23 of Faraway 2004 (p. 547), the two grips, midway
/// between hand front and hand back, and the two clavicle roots. On a recorded person both roots are the
/// suprasternale; on a rig they are the heads of the clavicle bones.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace reachcast {

enum class Joint : std::size_t {
  left_ball,
  left_ankle,
  left_knee,
  left_hip,
  left_shoulder,
  left_elbow,
  left_wrist,
  left_hand_front,
  left_hand_back,
  right_ball,
  right_ankle,
  right_knee,
  right_hip,
  right_shoulder,
  right_elbow,
  right_wrist,
  right_hand_front,
  right_hand_back,
  l5s1,
  c7t1,
  suprasternale,
  tragion,
  nasion,
  left_grip,
  right_grip,
  left_clavicle,
  right_clavicle,
};
inline constexpr std::size_t kJointCount = 27;
inline constexpr std::size_t kRecordedJointCount = 23;  ///< the first 23 are those of the 2004 paper

[[nodiscard]] constexpr std::size_t index(Joint joint) {
  return static_cast<std::size_t>(joint);
}
[[nodiscard]] std::string_view joint_name(Joint joint);
[[nodiscard]] std::optional<Joint> find_joint(std::string_view name);

/// The joint on the other side of the body; midline joints are their own mirror.
[[nodiscard]] Joint mirrored(Joint joint);

[[nodiscard]] const std::array<std::string_view, kJointCount>& joint_names();

}  // namespace reachcast
