// SPDX-License-Identifier: GPL-3.0-or-later
/// Where the hands go and when they are still. Private to motion/.
#pragma once

#include <array>
#include <vector>

#include "reachcast/mocap/clip.hpp"
#include "reachcast/motion/find_reaches.hpp"

namespace reachcast {

/// The points with missing frames bridged by straight lines; those at an end repeat the nearest. Throws
/// std::invalid_argument with `what` when all are missing.
[[nodiscard]] Points bridged(Points points, const std::string& what);

/// Metres per second at each frame, of points smoothed by a Gaussian of 0.05 s.
[[nodiscard]] std::vector<double> smooth_speeds(const Points& points, double rate_hz);

struct HandTracks {
  double rate_hz = 0.0;
  std::array<Points, 2> grips;  ///< left, right; bridged
  Points hold;                  ///< their middle, or the grip of the one hand that works
  std::vector<double> speed;    ///< of the hold, m/s, smoothed
  Hands hands = Hands::both;    ///< which work

  [[nodiscard]] std::size_t frames() const { return hold.size(); }
  [[nodiscard]] double apart(std::size_t frame) const { return glm::distance(grips[0][frame], grips[1][frame]); }
};
[[nodiscard]] HandTracks hand_tracks(const Clip& clip, Hands hands = Hands::both);

/// Movements of the hold point within a range, in order: between stops, without their slow beginnings and ends.
[[nodiscard]] std::vector<FrameRange> movements(const HandTracks& hands, const FrameRange& within,
                                                const FindOptions& options);

/// The same, those taken together that follow each other after less than options.pause_s without turning back (by 90
/// degrees or more).
[[nodiscard]] std::vector<FrameRange> ways(const HandTracks& hands, const FrameRange& within,
                                           const FindOptions& options);

[[nodiscard]] double seconds_between(const FrameRange& earlier, const FrameRange& later, double rate_hz);

/// Largest less smallest value of a function of the frame over a range.
template <typename Value>
[[nodiscard]] double spread(const FrameRange& range, Value value) {
  double low = value(range.first), high = low;
  for (std::size_t frame = range.first; frame <= range.last; ++frame) {
    const double here = value(frame);
    low = std::min(low, here);
    high = std::max(high, here);
  }
  return high - low;
}

}  // namespace reachcast
