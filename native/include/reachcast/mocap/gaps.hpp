// SPDX-License-Identifier: GPL-3.0-or-later
/// Filling short gaps in recorded points.
#pragma once

#include "reachcast/mocap/clip.hpp"

namespace reachcast {

/// The clip with each gap of at most limit_s seconds (0 to 2) filled and its frames marked in `filled`. Each point by
/// itself: a cubic joins the recorded points on both sides, with the slopes that parabolas through up to nine frames on
/// either side have there. Longer gaps, and those at an end of the recording, stay NaN. Throws std::invalid_argument
/// for another limit.
[[nodiscard]] Clip fill_gaps(const Clip& clip, double limit_s = 0.2);

}  // namespace reachcast
