// SPDX-License-Identifier: GPL-3.0-or-later
/// From anybody's names for points to the canonical joints.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "reachcast/body/joints.hpp"
#include "reachcast/mocap/clip.hpp"

namespace reachcast {

/// The way from one point (or the mean of several) to another.
struct PointSpan {
  std::vector<std::string> from, to;
  [[nodiscard]] bool empty() const { return from.empty() || to.empty(); }
};

/// How a joint centre follows from recorded points: their mean (a name listed twice weighs twice), moved by an offset.
/// The offset's axes are right, forward and up: x is the direction of `across`, and the plane that holds the rest is
/// given by `ahead` (back to front) or by `along` (below to above); without either it is vertical.
struct JointSource {
  JointSource() = default;
  JointSource(std::vector<std::string> mean_of) : points(std::move(mean_of)) {}  // NOLINT: a mean is a source
  JointSource(std::initializer_list<std::string> mean_of) : points(mean_of.begin(), mean_of.end()) {}

  std::vector<std::string> points;
  Vec3 offset{0.0};  ///< metres, or parts of the median length of `scale` where that is given
  PointSpan scale, across, ahead, along;
};

/// Where each canonical joint comes from. Several entries for one joint are alternatives: the first whose points are
/// all recorded is taken. A recorded name matches as it is or after its namespace ("mixamorig:LeftArm" matches
/// "LeftArm"). Entries for left_clavicle and right_clavicle name the inner ends of the collar bones; they fix where the
/// chest is.
struct JointMap {
  std::string name;
  std::vector<std::pair<Joint, JointSource>> sources;
};

/// Throws std::invalid_argument naming the joint when a source names no point, when its offset is not finite or over
/// 5 m, and when it has an offset and no `across`.
void check_joint_map(const JointMap& map);

/// "A+B" as the names A and B; "A+B>C" as the way from the mean of A and B to C. Throws std::invalid_argument.
[[nodiscard]] std::vector<std::string> parse_mean(std::string_view text);
[[nodiscard]] PointSpan parse_span(std::string_view text);

/// The tables built in, in order of preference.
[[nodiscard]] const std::vector<JointMap>& joint_map_presets();

/// The preset with all twelve limb joints present and most entries found. Throws std::invalid_argument naming what the
/// nearest preset lacks.
[[nodiscard]] const JointMap& detect_joint_map(const Clip& clip);

/// A Clip whose names are exactly joint_names(), in order; rate, source and channels are kept. Both ankles, knees,
/// hips, shoulders, elbows and wrists must be recorded, else std::invalid_argument names each that is not. The rest is
/// derived where the map has no source for it (proportions and references in canonical.cpp), and `derived` says so;
/// it is also true for means of several points and for offsets. A frame in which a needed point is missing gives NaN.
/// A joint is `filled` where one of its points is; a derived one where any joint that was recorded is.
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
