// SPDX-License-Identifier: GPL-3.0-or-later
/// From anybody's names for points to the canonical joints.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "reachcast/body/joints.hpp"
#include "reachcast/mocap/clip.hpp"

namespace reachcast {

/// Where each canonical joint comes from. An entry names the points whose mean is the joint; a name listed twice weighs
/// twice. Several entries for one joint are alternatives: the first whose points are all recorded is taken. A recorded
/// name matches as it is or after its namespace ("mixamorig:LeftArm" matches "LeftArm").
/// Entries for left_clavicle and right_clavicle name the inner ends of the collar bones; they fix where the chest is.
struct JointMap {
  std::string name;
  std::vector<std::pair<Joint, std::vector<std::string>>> sources;
};

/// The tables built in, in order of preference.
[[nodiscard]] const std::vector<JointMap>& joint_map_presets();

/// The preset with all twelve limb joints present and most entries found. Throws std::invalid_argument naming what the
/// nearest preset lacks.
[[nodiscard]] const JointMap& detect_joint_map(const Clip& clip);

/// A Clip whose names are exactly joint_names(), in order; rate, source and channels are kept. Both ankles, knees,
/// hips, shoulders, elbows and wrists must be recorded, else std::invalid_argument names each that is not. The rest is
/// derived where the map has no source for it (proportions and references in canonical.cpp), and `derived` says so;
/// it is also true for means of several points. A frame in which a needed point is missing gives NaN.
/// - hand_front: the knuckles if recorded; hand_back: 0.7 of the way from the wrist to it; grip: between the two.
///   With a wrist alone the hand continues the forearm, the grip 0.39 forearm lengths beyond the wrist.
/// - both clavicle roots are the suprasternale.
[[nodiscard]] Clip to_canonical(const Clip& clip, const JointMap& map);
[[nodiscard]] inline Clip to_canonical(const Clip& clip) {
  return to_canonical(clip, detect_joint_map(clip));
}

/// The twelve joints that a recording must have, left before right, in the order of the Joint enumeration.
[[nodiscard]] const std::vector<Joint>& required_joints();

}  // namespace reachcast
