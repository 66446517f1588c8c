// SPDX-License-Identifier: GPL-3.0-or-later
/// The correction of trunk and hands over time, smooth and independent of the frame rate.
#pragma once

#include <vector>

#include "reachcast/posture/hold.hpp"

namespace reachcast {

/// What Holder::settle says at evenly spaced moments, smoothed by a Gaussian of 0.10 s and joined by a cubic B-spline:
/// neither position nor speed nor acceleration jumps, whatever the frames between the moments.
class StanceTrack {
 public:
  /// `moments`: at least 2, the first at time 0; spacing_s > 0.
  StanceTrack(const std::vector<Stance>& moments, double spacing_s);

  /// Adds changes at the same moments, smoothed as the moments were. Directions of wrists add up too: zero is no
  /// change.
  void add(const std::vector<Stance>& changes);

  /// time_s is clamped to the track's ends.
  [[nodiscard]] Stance at(double time_s) const;

 private:
  std::vector<Stance> smooth_;
  double spacing_s_;
};

}  // namespace reachcast
