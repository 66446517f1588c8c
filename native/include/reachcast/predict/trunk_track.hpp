// SPDX-License-Identifier: GPL-3.0-or-later
/// The correction of the trunk over time, smooth and independent of the frame rate.
#pragma once

#include <vector>

#include "reachcast/posture/hold.hpp"

namespace reachcast {

/// What Holder::settle says at evenly spaced moments, smoothed by a Gaussian of 0.08 s and joined by cubics: neither
/// position nor speed jumps, whatever the frames between the moments.
class TrunkTrack {
 public:
  /// `moments`: at least 2, the first at time 0; spacing_s > 0.
  TrunkTrack(const std::vector<TrunkMotion>& moments, double spacing_s);

  /// time_s is clamped to the track's ends.
  [[nodiscard]] TrunkMotion at(double time_s) const;

 private:
  std::vector<TrunkMotion> smooth_;
  double spacing_s_;
};

}  // namespace reachcast
