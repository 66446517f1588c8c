// SPDX-License-Identifier: GPL-3.0-or-later
/// The names that tools give to joints. Data only: another tool is another table.
#include <span>

#include "reachcast/mocap/joint_map.hpp"

namespace reachcast {
namespace {

/// '@' stands for the side, in the joint ("left", "right") and in the points; '+' joins points to be averaged.
struct Row {
  std::string_view joint;
  std::string_view points;
};

struct Table {
  std::string_view name, left, right;
  std::span<const Row> rows;
};

// Joint centres of a posed SMPL-X body. Its pelvis point lies 0.06 statures above the hips, where L5/S1 is. C7/T1 is
// halfway between its neck (0.36 statures above the hips) and its collar bones (0.30). Its toe is the ball of the foot.
constexpr Row kOmomo[] = {
    {"@_ball", "@_Toe"},    {"@_ankle", "@_Ankle"},        {"@_knee", "@_Knee"},
    {"@_hip", "@_Hip"},     {"@_shoulder", "@_Shoulder"},  {"@_elbow", "@_Elbow"},
    {"@_wrist", "@_Wrist"}, {"@_hand_front", "@_Middle1"}, {"@_clavicle", "@_Thorax"},
    {"l5s1", "Pelvis"},     {"tragion", "Head"},           {"c7t1", "Neck+Neck+L_Thorax+R_Thorax"}};

constexpr Row kLieblich[] = {{"@_ankle", "@ank"},   {"@_knee", "@knee"}, {"@_hip", "@hip"},
                             {"@_shoulder", "@sh"}, {"@_elbow", "@eb"},  {"@_wrist", "@w"}};

// Mixamo and most MotionBuilder exports.
constexpr Row kMotionBuilder[] = {{"@_ball", "@ToeBase"},  {"@_ball", "@Foot_end"}, {"@_ankle", "@Foot"},
                                  {"@_knee", "@Leg"},      {"@_hip", "@UpLeg"},     {"@_shoulder", "@Arm"},
                                  {"@_elbow", "@ForeArm"}, {"@_wrist", "@Hand"},    {"@_hand_front", "@HandMiddle1"},
                                  {"c7t1", "Neck"},        {"tragion", "Head"}};

// The CMU database as converted by cgspeed: its Neck lies below the shoulders, its LowerBack 0.06 statures above the
// hips.
constexpr Row kCmu[] = {{"@_ball", "@ToeBase"}, {"@_ankle", "@Foot"},    {"@_knee", "@Leg"},   {"@_hip", "@UpLeg"},
                        {"@_shoulder", "@Arm"}, {"@_elbow", "@ForeArm"}, {"@_wrist", "@Hand"}, {"l5s1", "LowerBack"},
                        {"c7t1", "Neck1"},      {"tragion", "Head"}};

// Joints named by what they join: MotionBuilder's older exports and CMU's "-Motionbuilder-friendly" conversion.
constexpr Row kAnatomical[] = {
    {"@_ball", "@Toe"},    {"@_ball", "@Toes"}, {"@_ball", "@Ankle_end"},    {"@_ankle", "@Ankle"},
    {"@_knee", "@Knee"},   {"@_hip", "@Hip"},   {"@_shoulder", "@Shoulder"}, {"@_elbow", "@Elbow"},
    {"@_wrist", "@Wrist"}, {"c7t1", "Neck"},    {"tragion", "Head"}};

constexpr Row kBiovision[] = {{"@_ball", "@Foot_end"}, {"@_ankle", "@Foot"},     {"@_knee", "@LowLeg"},
                              {"@_hip", "@UpLeg"},     {"@_shoulder", "@UpArm"}, {"@_elbow", "@LowArm"},
                              {"@_wrist", "@Hand"},    {"c7t1", "Neck"},         {"tragion", "Head"}};

constexpr Row kIClone[] = {{"@_ball", "CC_Base_@_ToeBase"},      {"@_ankle", "CC_Base_@_Foot"},
                           {"@_knee", "CC_Base_@_Calf"},         {"@_hip", "CC_Base_@_Thigh"},
                           {"@_shoulder", "CC_Base_@_Upperarm"}, {"@_elbow", "CC_Base_@_Forearm"},
                           {"@_wrist", "CC_Base_@_Hand"},        {"@_hand_front", "CC_Base_@_Mid1"},
                           {"c7t1", "CC_Base_NeckTwist01"},      {"tragion", "CC_Base_Head"}};

constexpr Row kPoser[] = {{"@_ball", "@Toe"},      {"@_ball", "@Foot_end"}, {"@_ankle", "@Foot"},
                          {"@_knee", "@Shin"},     {"@_hip", "@Thigh"},     {"@_shoulder", "@Shldr"},
                          {"@_elbow", "@ForeArm"}, {"@_wrist", "@Hand"},    {"@_hand_front", "@Mid1"},
                          {"c7t1", "neck"},        {"tragion", "head"}};

constexpr Table kTables[] = {{"omomo", "L", "R", kOmomo},
                             {"lieblich", "L", "R", kLieblich},
                             {"motionbuilder", "Left", "Right", kMotionBuilder},
                             {"cmu", "Left", "Right", kCmu},
                             {"anatomical", "Left", "Right", kAnatomical},
                             {"biovision", "Left", "Right", kBiovision},
                             {"iclone", "L", "R", kIClone},
                             {"poser", "l", "r", kPoser}};

std::string with_side(std::string_view pattern, std::string_view side) {
  std::string text(pattern);
  if (const std::size_t at = text.find('@'); at != std::string::npos) text.replace(at, 1, side);
  return text;
}

void add_row(JointMap& map, const Row& row, std::string_view joint_side, std::string_view point_side) {
  std::vector<std::string> points;
  std::string_view rest = row.points;
  while (!rest.empty()) {
    const std::size_t plus = std::min(rest.find('+'), rest.size());
    points.push_back(with_side(rest.substr(0, plus), point_side));
    rest.remove_prefix(std::min(plus + 1, rest.size()));
  }
  map.sources.emplace_back(find_joint(with_side(row.joint, joint_side)).value(), std::move(points));
}

JointMap expand(const Table& table) {
  JointMap map{std::string(table.name), {}};
  for (const Row& row : table.rows) {
    add_row(map, row, "left", table.left);
    if (row.joint.starts_with('@')) add_row(map, row, "right", table.right);
  }
  return map;
}

std::vector<JointMap> make_presets() {
  JointMap canonical{"reachcast", {}};
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto joint = static_cast<Joint>(i);
    canonical.sources.emplace_back(joint, std::vector<std::string>{std::string(joint_name(joint))});
  }
  std::vector<JointMap> presets{std::move(canonical)};
  for (const Table& table : kTables) presets.push_back(expand(table));
  return presets;
}

}  // namespace

const std::vector<JointMap>& joint_map_presets() {
  static const std::vector<JointMap> presets = make_presets();
  return presets;
}

}  // namespace reachcast
