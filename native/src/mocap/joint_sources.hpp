// SPDX-License-Identifier: GPL-3.0-or-later
/// Looking up the points of a JointMap in a recording. Private to mocap/.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "reachcast/mocap/joint_map.hpp"

namespace reachcast {

/// For each canonical joint the recorded points whose mean it is; empty where the recording has none.
using JointSources = std::array<std::vector<std::size_t>, kJointCount>;
[[nodiscard]] JointSources find_sources(const Clip& clip, const JointMap& map);

/// Names of the required joints without a source, "left_ball, right_ball"; empty when complete.
[[nodiscard]] std::string missing_joints(const JointSources& sources);

}  // namespace reachcast
