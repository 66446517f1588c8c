// SPDX-License-Identifier: GPL-3.0-or-later
/// The names that tools give to joints. Data only: another tool is another table.
#include <span>

#include "reachcast/mocap/joint_map.hpp"

namespace reachcast {
namespace {

/// '@' stands for the side, in the joint ("left", "right") and in the points; '+' joins points to be averaged, '>'
/// leads from one to another. An offset is that of the right side: x changes its sign on the left.
struct Row {
  std::string_view joint;
  std::string_view points;
  Vec3 offset{0.0};
  std::string_view scale{}, across{}, ahead{}, along{};
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

// Plug-in Gait markers (Vicon), and those of the CMU database, which names the pelvis LFWT, RFWT, LBWT, RBWT.
// - Hips: 0.36, 0.22 and 0.30 of the distance of the front pelvis markers aside, behind and below their middle (Bell,
//   Pedersen & Brand 1990).
// - Knee and ankle markers lie on the outside: half a joint's width and a marker's radius, as parts of the shank
//   (0.057 and 0.042 of 0.42 m). Elbow markers likewise, as parts of the upper arm (0.042 of 0.30 m).
// - The shoulder lies 0.05 m below its marker where shoulders are 0.36 m apart. The head band runs 0.05 m above the
// ears.
constexpr Vec3 kHipOffset{0.36, -0.22, -0.30};
constexpr Vec3 kKneeOffset{-0.136, 0.0, 0.0};
constexpr Vec3 kAnkleOffset{-0.10, 0.0, 0.0};
constexpr Vec3 kElbowOffset{-0.14, 0.0, 0.0};
constexpr Vec3 kShoulderOffset{0.0, 0.0, -0.14};
constexpr Row kPlugInGait[] = {
    {"@_ball", "@TOE"},
    {"@_ball", "@MT1"},
    {"@_ankle", "@ANK", kAnkleOffset, "@ANK>@KNE", "LASI>RASI", {}, "@ANK>@KNE"},
    {"@_ankle", "@ANK", kAnkleOffset, "@ANK>@KNE", "LFWT>RFWT", {}, "@ANK>@KNE"},
    {"@_knee", "@KNE", kKneeOffset, "@ANK>@KNE", "LASI>RASI", {}, "@ANK>@KNE"},
    {"@_knee", "@KNE", kKneeOffset, "@ANK>@KNE", "LFWT>RFWT", {}, "@ANK>@KNE"},
    {"@_hip", "LASI+RASI", kHipOffset, "LASI>RASI", "LASI>RASI", "LPSI+RPSI>LASI+RASI", {}},
    {"@_hip", "LASI+RASI", kHipOffset, "LASI>RASI", "LASI>RASI", "SACR>LASI+RASI", {}},
    {"@_hip", "LFWT+RFWT", kHipOffset, "LFWT>RFWT", "LFWT>RFWT", "LBWT+RBWT>LFWT+RFWT", {}},
    {"@_shoulder", "@SHO", kShoulderOffset, "LSHO>RSHO", "LSHO>RSHO", {}, "T10+STRN>C7+CLAV"},
    {"@_elbow", "@ELB", kElbowOffset, "@ELB>@SHO", "LSHO>RSHO", {}, "@ELB>@SHO"},
    {"@_wrist", "@WRA+@WRB"},
    {"@_wrist", "@WRI"},
    {"@_hand_front", "@FIN"},
    {"c7t1", "C7+CLAV"},
    {"suprasternale", "CLAV"},
    {"tragion", "LFHD+RFHD+LBHD+RBHD", {0.0, 0.0, -0.05}, {}, "LFHD>RFHD", "LBHD+RBHD>LFHD+RFHD", {}}};

// Markers named by side and place with a dot, as Motion Analysis templates have them ("R.ASIS").
constexpr Row kDotted[] = {
    {"@_ball", "@.Toe"},
    {"@_ankle", "@.Ankle", kAnkleOffset, "@.Ankle>@.Knee", "L.ASIS>R.ASIS", {}, "@.Ankle>@.Knee"},
    {"@_knee", "@.Knee", kKneeOffset, "@.Ankle>@.Knee", "L.ASIS>R.ASIS", {}, "@.Ankle>@.Knee"},
    {"@_hip", "L.ASIS+R.ASIS", kHipOffset, "L.ASIS>R.ASIS", "L.ASIS>R.ASIS", "L.PSIS+R.PSIS>L.ASIS+R.ASIS", {}},
    {"@_hip", "L.ASIS+R.ASIS", kHipOffset, "L.ASIS>R.ASIS", "L.ASIS>R.ASIS", "V.Sacral>L.ASIS+R.ASIS", {}},
    {"@_shoulder",
     "@.Shoulder",
     kShoulderOffset,
     "L.Shoulder>R.Shoulder",
     "L.Shoulder>R.Shoulder",
     {},
     "L.ASIS+R.ASIS>L.Shoulder+R.Shoulder"},
    {"@_elbow", "@.Elbow", kElbowOffset, "@.Elbow>@.Shoulder", "L.Shoulder>R.Shoulder", {}, "@.Elbow>@.Shoulder"},
    {"@_wrist", "@.Wrist"}};

// Acclaim skeletons of the CMU database: a bone is named by its start.
constexpr Row kAcclaim[] = {{"@_ball", "@toes"},   {"@_ankle", "@foot"},         {"@_knee", "@tibia"},
                            {"@_hip", "@femur"},   {"@_shoulder", "@humerus"},   {"@_elbow", "@radius"},
                            {"@_wrist", "@wrist"}, {"@_hand_front", "@fingers"}, {"l5s1", "lowerback"},
                            {"c7t1", "lowerneck"}, {"tragion", "head"}};

constexpr Table kTables[] = {{"omomo", "L", "R", kOmomo},
                             {"lieblich", "L", "R", kLieblich},
                             {"motionbuilder", "Left", "Right", kMotionBuilder},
                             {"cmu", "Left", "Right", kCmu},
                             {"anatomical", "Left", "Right", kAnatomical},
                             {"biovision", "Left", "Right", kBiovision},
                             {"iclone", "L", "R", kIClone},
                             {"poser", "l", "r", kPoser},
                             {"plug-in gait", "L", "R", kPlugInGait},
                             {"dotted", "L", "R", kDotted},
                             {"acclaim", "l", "r", kAcclaim}};

std::string with_side(std::string_view pattern, std::string_view side) {
  std::string text;
  for (const char c : pattern) c == '@' ? text += side : text += c;
  return text;
}

void add_row(JointMap& map, const Row& row, std::string_view joint_side, std::string_view point_side) {
  const auto span = [&](std::string_view text) {
    return text.empty() ? PointSpan{} : parse_span(with_side(text, point_side));
  };
  JointSource source(parse_mean(with_side(row.points, point_side)));
  source.offset = joint_side == "left" ? row.offset * Vec3(-1.0, 1.0, 1.0) : row.offset;
  source.scale = span(row.scale);
  source.across = span(row.across);
  source.ahead = span(row.ahead);
  source.along = span(row.along);
  map.sources.emplace_back(find_joint(with_side(row.joint, joint_side)).value(), std::move(source));
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
    canonical.sources.emplace_back(joint, JointSource{std::string(joint_name(joint))});
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
