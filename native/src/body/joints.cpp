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

namespace {

std::array<Joint, kJointCount> mirror_table() {
  std::array<Joint, kJointCount> table{};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto joint = static_cast<Joint>(j);
    const std::string name(joint_name(joint));
    const bool is_left = name.starts_with("left_"), is_right = name.starts_with("right_");
    const std::string other = is_left ? "right_" + name.substr(5) : is_right ? "left_" + name.substr(6) : name;
    table[j] = find_joint(other).value_or(joint);
  }
  return table;
}

}  // namespace

Joint mirrored(Joint joint) {
  static const std::array<Joint, kJointCount> table = mirror_table();
  return table[index(joint)];
}

}  // namespace reachcast
