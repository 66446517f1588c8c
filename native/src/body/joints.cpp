// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/body/joints.hpp"

#include <algorithm>
#include <string>

namespace reachcast {

const std::array<std::string_view, kJointCount>& joint_names() {
  static constexpr std::array<std::string_view, kJointCount> names{
      "left_ball",     "left_ankle",       "left_knee",       "left_hip",       "left_shoulder",
      "left_elbow",    "left_wrist",       "left_hand_front", "left_hand_back", "right_ball",
      "right_ankle",   "right_knee",       "right_hip",       "right_shoulder", "right_elbow",
      "right_wrist",   "right_hand_front", "right_hand_back", "l5s1",           "c7t1",
      "suprasternale", "tragion",          "nasion",          "left_grip",      "right_grip",
      "left_clavicle", "right_clavicle"};
  return names;
}

std::string_view joint_name(Joint joint) {
  return joint_names()[index(joint)];
}

std::optional<Joint> find_joint(std::string_view name) {
  const auto& names = joint_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<Joint>(found - names.begin());
}

Joint mirrored(Joint joint) {
  const std::string_view name = joint_name(joint);
  const auto with_side = [&](std::string_view from, std::string_view to) {
    return find_joint(std::string(to) + std::string(name.substr(from.size())));
  };
  if (name.starts_with("left_")) return with_side("left_", "right_").value_or(joint);
  if (name.starts_with("right_")) return with_side("right_", "left_").value_or(joint);
  return joint;
}

}  // namespace reachcast
