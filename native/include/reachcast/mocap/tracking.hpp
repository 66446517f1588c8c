// SPDX-License-Identifier: GPL-3.0-or-later
/// What a recording shows that no body does: points that jump, stand still, or change sides, and bones that stretch.
#pragma once

#include <string>
#include <vector>

#include "reachcast/mocap/clip.hpp"

namespace reachcast {

/// Frames first to last of a point are not to be believed.
struct TrackingFault {
  std::string joint;
  std::size_t first = 0;
  std::size_t last = 0;
  std::string reason;  ///< "jumps 0.31 m", "frozen for 0.50 s", "left and right exchanged with RANK", ...
};

struct TrackingLimits {
  double acceleration = 150.0;  ///< m/s^2, > 0: a point that would need more between three frames jumps
  double jump_m = 0.02;         ///< > 0, and by which it must be off besides
  double frozen_s = 0.2;        ///< > 0: a point exactly in its place for this long while most others move; not feet
  double stretch = 0.15;        ///< > 0, of a segment's median length; canonical clips only
};

/// All faults, by point and first frame. A point that jumps away and back within half a second is one fault; frames in
/// between belong to it. Left and right are told by names: left_ and right_, Left and Right, L and R at the beginning.
/// Missing frames are no faults. Throws std::invalid_argument for limits that are not over 0.
[[nodiscard]] std::vector<TrackingFault> check_tracking(const Clip& clip, const TrackingLimits& limits = {});

}  // namespace reachcast
