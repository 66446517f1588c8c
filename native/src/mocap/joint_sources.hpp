// SPDX-License-Identifier: GPL-3.0-or-later
/// Looking up the points of a JointMap in a recording. Private to mocap/.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "reachcast/mocap/joint_map.hpp"

namespace reachcast {

struct FoundSpan {
  std::vector<std::size_t> from, to;
};

/// A JointSource with its names replaced by indices into one recording.
struct FoundSource {
  std::vector<std::size_t> points;
  Vec3 offset{0.0};  ///< in the unit of the recording when it is scaled, else metres
  bool is_scaled = false;
  FoundSpan across, ahead, along;

  [[nodiscard]] bool empty() const { return points.empty(); }
  [[nodiscard]] bool has_offset() const { return offset != Vec3(0.0); }
};

/// For each canonical joint where it comes from; empty where the recording has nothing for it.
using JointSources = std::array<FoundSource, kJointCount>;
[[nodiscard]] JointSources find_sources(const Clip& clip, const JointMap& map);

/// Mean of points at a frame; NaN for none.
[[nodiscard]] Vec3 plain_mean(const Clip& clip, std::size_t frame, const std::vector<std::size_t>& points);

/// The joint centre at a frame; NaN where it does not follow.
[[nodiscard]] Vec3 joint_centre(const Clip& clip, std::size_t frame, const FoundSource& source);

/// Names of the required joints without a source, "left_ball, right_ball"; empty when complete.
[[nodiscard]] std::string missing_joints(const JointSources& sources);

/// As detect_joint_map; null when none fits.
[[nodiscard]] const JointMap* best_joint_map(const Clip& clip);

/// Stature in the unit of the recording: median shank, thigh and trunk over their published part of it. Offsets in
/// metres are left out.
[[nodiscard]] double stature_in_units(const Clip& clip, const JointSources& sources);

}  // namespace reachcast
