// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/rig/retarget.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "reachcast/body/spine.hpp"
#include "reachcast/rig/turns.hpp"

namespace reachcast {
namespace {

constexpr double kLeastRestBend = 0.13917310096006544;  // sine of 8 degrees: a limb bent less is straight at rest
constexpr double kAside = 0.2;                          // sine of the least angle from which a cross product is used

/// Turns of every segment over time, and of each bone of the back.
class SegmentTurns {
 public:
  SegmentTurns(std::size_t frames, std::size_t back) : frames_(frames), turns_((kSegmentCount + back) * frames) {}
  [[nodiscard]] std::span<Mat3> of(Segment segment) {
    return std::span(turns_).subspan(index(segment) * frames_, frames_);
  }
  [[nodiscard]] std::span<Mat3> of_back(std::size_t number) {
    return std::span(turns_).subspan((kSegmentCount + number) * frames_, frames_);
  }

 private:
  std::size_t frames_;
  std::vector<Mat3> turns_;
};

Vec3 direction(const Posture& joints, Joint from, Joint to) {
  return unit_or_same(joints[index(to)] - joints[index(from)]);
}

Mat3 triangle(const Posture& joints, Joint base, Joint primary, Joint secondary) {
  return frame_towards(joints[index(primary)] - joints[index(base)], joints[index(secondary)] - joints[index(base)]);
}

/// Hinge axis of a limb at rest: from its own bend when it is bent enough and the right way, else `straight`.
HingeRest rest_hinge(const RestRig& rest, const HingeJoints& joints, const Vec3& straight) {
  const Vec3 upper = direction(rest.joints(), joints.root, joints.hinge);
  const Vec3 lower = direction(rest.joints(), joints.hinge, joints.end);
  const Vec3 bend = glm::cross(upper, lower);
  const bool is_bent = glm::length(bend) > kLeastRestBend && glm::dot(bend, straight) > 0.0;
  return {upper, lower, unit_or_same(across(is_bent ? bend : straight, upper))};
}

/// The elbow's axis of a straight arm: it bends forward, and up if it points forward.
Vec3 straight_elbow(const RestRig& rest, const ArmNames& arm) {
  const Vec3 upper = direction(rest.joints(), arm.shoulder, arm.elbow);
  const Vec3 axis = glm::cross(upper, rest.forward());
  return unit_or_same(glm::length(axis) > kAside ? axis : glm::cross(upper, rest.up()));
}

/// The chest at rest with its back bent: how its bones turn, and the triangle of its joints.
struct BentChest {
  BentBack back;
  Mat3 triangle_rest;  ///< transposed
};

BentChest bent_chest(const RestRig& rest, double bend_rad) {
  using enum Joint;
  if (bend_rad == 0.0) {
    return {{rest.at(c7t1) - rest.at(l5s1), std::vector<Mat3>(rest.back().size(), Mat3(1.0)), Mat3(1.0)},
            glm::transpose(triangle(rest.joints(), l5s1, c7t1, right_clavicle))};
  }
  BentBack back = bent_back(rest.back_pieces(), rest.right(), bend_rad);
  const Vec3 clavicle = back.end + back.upper * (rest.at(right_clavicle) - rest.at(c7t1));
  const Mat3 frame = frame_towards(back.end, clavicle);
  return {std::move(back), glm::transpose(frame)};
}

void turn_trunk(const RestRig& rest, Postures postures, std::span<const double> bends_rad, SegmentTurns& turns) {
  using enum Joint;
  const Mat3 pelvis_rest = glm::transpose(triangle(rest.joints(), left_hip, right_hip, l5s1));
  const auto pelvis = turns.of(Segment::pelvis), spine = turns.of(Segment::spine), chest = turns.of(Segment::chest);
  BentChest bent = bent_chest(rest, 0.0);
  for (std::size_t f = 0; f < postures.size(); ++f) {
    pelvis[f] = triangle(postures[f], left_hip, right_hip, l5s1) * pelvis_rest;
    if (!bends_rad.empty()) bent = bent_chest(rest, bends_rad[f]);
    const Mat3 whole = triangle(postures[f], l5s1, c7t1, right_clavicle) * bent.triangle_rest;
    for (std::size_t i = 0; i < rest.back().size(); ++i) turns.of_back(i)[f] = whole * bent.back.turns[i];
    spine[f] = turns.of_back(0)[f];
    chest[f] = whole * bent.back.upper;
  }
}

void turn_arm(const RestRig& rest, const ArmNames& arm, Postures postures, SegmentTurns& turns) {
  const Vec3 along = direction(rest.joints(), arm.clavicle_root, arm.shoulder);
  const auto chest = turns.of(Segment::chest), clavicle = turns.of(arm.clavicle), forearm = turns.of(arm.forearm);
  for (std::size_t f = 0; f < postures.size(); ++f) {
    clavicle[f] = smallest_turn(chest[f] * along, direction(postures[f], arm.clavicle_root, arm.shoulder)) * chest[f];
  }
  const HingeJoints elbow{arm.shoulder, arm.elbow, arm.wrist};
  const Vec3 straight = straight_elbow(rest, arm);
  turn_hinge(rest_hinge(rest, elbow, straight), elbow, postures, clavicle, turns.of(arm.upper_arm), forearm);
  // out of the palm at rest: down in a T pose, inwards when the arms hang
  const Vec3 hand = direction(rest.joints(), arm.wrist, arm.grip);
  turn_hand({hand, unit_or_same(across(arm.palm_sign * straight, hand))}, arm, postures, forearm, turns.of(arm.hand));
}

void turn_leg(const RestRig& rest, const LegNames& leg, Postures postures, SegmentTurns& turns) {
  const HingeJoints knee{leg.hip, leg.knee, leg.ankle};
  const Vec3 straight = glm::cross(direction(rest.joints(), leg.hip, leg.knee), -rest.forward());
  const auto shin = turns.of(leg.shin);
  turn_hinge(rest_hinge(rest, knee, straight), knee, postures, turns.of(Segment::pelvis), turns.of(leg.thigh), shin);
  const Vec3 foot = direction(rest.joints(), leg.ankle, leg.ball), level = glm::cross(foot, rest.up());
  const Vec3 side = glm::length(level) > kAside ? unit_or_same(level) : rest.right();
  turn_foot({foot, side, rest.up()}, leg, postures, shin, turns.of(leg.foot), turns.of(leg.toe));
}

void turn_neck_and_head(const RestRig& rest, Postures postures, SegmentTurns& turns) {
  using enum Joint;
  const Mat3 neck_rest = glm::transpose(frame_towards(rest.at(tragion) - rest.at(c7t1), rest.right()));
  const Vec3 face = direction(rest.joints(), tragion, nasion);
  const auto chest = turns.of(Segment::chest), neck = turns.of(Segment::neck), head = turns.of(Segment::head);
  for (std::size_t f = 0; f < postures.size(); ++f) {
    const Posture& at = postures[f];
    neck[f] = frame_towards(at[index(tragion)] - at[index(c7t1)], chest[f] * rest.right()) * neck_rest;
    head[f] = smallest_turn(neck[f] * face, direction(at, tragion, nasion)) * neck[f];
  }
}

/// Place of a bone among those of the back.
std::optional<std::size_t> place_in_back(const RestRig& rest, int bone) {
  const auto found = std::find(rest.back().begin(), rest.back().end(), bone);
  if (found == rest.back().end()) return std::nullopt;
  return static_cast<std::size_t>(found - rest.back().begin());
}

/// From segments to keyed bones: unmapped bones follow their parent, those above the pelvis stay at rest.
RigPose spread(const RestRig& rest, Postures postures, SegmentTurns& turns) {
  const std::size_t frames = postures.size();
  const Points& rest_heads = rest.bones().heads;
  const int pelvis = rest.bone(Segment::pelvis);
  RigPose pose{frames, std::vector<Mat3>(rest.keyed().size() * frames, Mat3(1.0)),
               Points(rest.keyed().size() * frames)};
  for (std::size_t slot = 0; slot < rest.keyed().size(); ++slot) {
    const int bone = rest.keyed()[slot], parent = rest.bones().parents[static_cast<std::size_t>(bone)];
    const std::size_t begin = slot * frames;
    const std::size_t above = parent < 0 ? 0 : static_cast<std::size_t>(rest.slot(parent)) * frames;
    const Vec3 head = rest_heads[static_cast<std::size_t>(bone)];
    const Vec3 anchor = bone == pelvis ? rest.at(Joint::left_hip)
                        : parent < 0   ? head
                                       : rest_heads[static_cast<std::size_t>(parent)];
    const std::optional<std::size_t> in_back = place_in_back(rest, bone);
    for (std::size_t f = 0; f < frames; ++f) {
      if (in_back) {
        pose.turns[begin + f] = turns.of_back(*in_back)[f];
      } else if (rest.segment(bone) != RestRig::kNone) {
        pose.turns[begin + f] = turns.of(static_cast<Segment>(rest.segment(bone)))[f];
      } else if (parent >= 0) {
        pose.turns[begin + f] = pose.turns[above + f];
      }
      if (bone == pelvis) {
        pose.heads[begin + f] = postures[f][index(Joint::left_hip)] + pose.turns[begin + f] * (head - anchor);
      } else {
        pose.heads[begin + f] = parent < 0 ? head : pose.heads[above + f] + pose.turns[above + f] * (head - anchor);
      }
    }
  }
  return pose;
}

void check(Postures postures, std::span<const double> bends_rad) {
  if (postures.empty()) throw std::invalid_argument("joints has 0 frames; there must be at least 1");
  if (!bends_rad.empty() && bends_rad.size() != postures.size()) {
    throw std::invalid_argument("bends has " + std::to_string(bends_rad.size()) + " values; there must be none or " +
                                std::to_string(postures.size()) + ", one per frame");
  }
  for (std::size_t f = 0; f < bends_rad.size(); ++f) {
    if (bends_rad[f] >= 0.0 && bends_rad[f] <= kMostBend_rad) continue;
    throw std::invalid_argument("bends is " + std::to_string(bends_rad[f]) + " at frame " + std::to_string(f) +
                                "; it must lie between 0 and " + std::to_string(kMostBend_rad));
  }
  for (std::size_t f = 0; f < postures.size(); ++f) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      if (is_finite(postures[f][j])) continue;
      throw std::invalid_argument("joints is not finite at frame " + std::to_string(f) + ", " +
                                  std::string(joint_name(static_cast<Joint>(j))));
    }
  }
}

}  // namespace

RigPose retarget(const RestRig& rest, Postures postures, std::span<const double> bends_rad) {
  check(postures, bends_rad);
  SegmentTurns turns(postures.size(), rest.back().size());
  turn_trunk(rest, postures, bends_rad, turns);
  for (const ArmNames& arm : arms()) turn_arm(rest, arm, postures, turns);
  for (const LegNames& leg : legs()) turn_leg(rest, leg, postures, turns);
  turn_neck_and_head(rest, postures, turns);
  RigPose pose = spread(rest, postures, turns);
  pose.is_bent =
      rest.back().size() > 1 && std::any_of(bends_rad.begin(), bends_rad.end(), [](double b) { return b > 0.0; });
  return pose;
}

std::vector<Posture> posed_joints(const RestRig& rest, const RigPose& pose) {
  std::vector<Posture> postures(pose.frames);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const int bone = rest.bone(carrier(static_cast<Joint>(j)));
    const Vec3 offset = rest.joints()[j] - rest.bones().heads[static_cast<std::size_t>(bone)];
    const Turns turns = pose.turns_of(rest.slot(bone));
    const std::span<const Vec3> heads = pose.heads_of(rest.slot(bone));
    for (std::size_t f = 0; f < pose.frames; ++f) postures[f][j] = heads[f] + turns[f] * offset;
  }
  return postures;
}

std::vector<Mat3> local_rotations(const RestRig& rest, const RigPose& pose, int bone) {
  const auto count = static_cast<int>(rest.bones().parents.size());
  if (bone < 0 || bone >= count || rest.slot(bone) == RestRig::kNone) {
    throw std::invalid_argument("bone " + std::to_string(bone) + " is not one of the keyed bones");
  }
  std::vector<Mat3> local(pose.frames, Mat3(1.0));
  const int parent = rest.bones().parents[static_cast<std::size_t>(bone)];
  const bool bends = pose.is_bent && place_in_back(rest, bone);
  if (rest.segment(bone) == RestRig::kNone && !bends) return local;  // it follows its parent, or stays where it is
  const Mat3& own = rest.bones().rotations[static_cast<std::size_t>(bone)];
  const Mat3 back = glm::transpose(own);
  const Turns turns = pose.turns_of(rest.slot(bone));
  for (std::size_t f = 0; f < pose.frames; ++f) local[f] = turns[f] * own;
  if (parent >= 0) {
    const Turns above = pose.turns_of(rest.slot(parent));
    for (std::size_t f = 0; f < pose.frames; ++f) local[f] = glm::transpose(above[f]) * local[f];
  }
  for (Mat3& rotation : local) rotation = back * rotation;
  return local;
}

}  // namespace reachcast
