// SPDX-License-Identifier: GPL-3.0-or-later
/// What stands on a surface leaves it upwards and comes to it from above.
#pragma once

#include <span>

#include "reachcast/predict/task.hpp"

namespace reachcast {

/// Raises the path of a box so that it clears the edges of what it stands on at home and at the target: within half its
/// depth and 15 cm of either place it stays above that place's height. Each end has one smooth bump, zero in value and
/// slope at both ends of the path; the ends themselves do not move. Where home and target stand above each other there
/// is no edge to clear and less of the path is touched. Returns the largest rise, metres; it is at most 0.15, which
/// clears most edges and keeps the path that of a person.
/// `path`: positions from home to target, evenly spaced in time.
[[nodiscard]] double clear_edges(std::span<BoxPose> path, const Box& box);

}  // namespace reachcast
