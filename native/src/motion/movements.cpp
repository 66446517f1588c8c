// SPDX-License-Identifier: GPL-3.0-or-later
#include "movements.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace reachcast {
namespace {

constexpr double kSmoothing_s = 0.05;
constexpr double kSlowestPeak = 0.15;  // m/s: a movement that never gets faster is part of standing still
constexpr double kNearly = 0.1;        // of a movement's path: so little may be left of it when it ends

Points smoothed(const Points& points, double rate_hz) {
  const double width = kSmoothing_s * rate_hz;
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(3.0 * width));
  const auto count = static_cast<std::ptrdiff_t>(points.size());
  Points out(points.size());
  for (std::ptrdiff_t frame = 0; frame < count; ++frame) {
    // As many frames before as after, so that the ends of a recording do not drag.
    const std::ptrdiff_t side = std::min({reach, frame, count - 1 - frame});
    Vec3 sum(0.0);
    double total = 0.0;
    for (std::ptrdiff_t k = -side; k <= side; ++k) {
      const double weight = std::exp(-0.5 * std::pow(static_cast<double>(k) / width, 2.0));
      sum += weight * points[static_cast<std::size_t>(frame + k)];
      total += weight;
    }
    out[static_cast<std::size_t>(frame)] = sum / total;
  }
  return out;
}

/// Frames at which one movement may give way to the next: both ends of the range and the minima of speed between.
std::vector<std::size_t> turning_frames(const std::vector<double>& speed, const FrameRange& within) {
  std::vector<std::size_t> frames{within.first};
  for (std::size_t f = within.first + 1; f < within.last; ++f) {
    if (speed[f] < speed[f - 1] && speed[f] <= speed[f + 1]) frames.push_back(f);
  }
  frames.push_back(within.last);
  return frames;
}

std::size_t peak_between(const std::vector<double>& speed, std::size_t first, std::size_t last) {
  const auto at = [&](std::size_t f) { return speed.begin() + static_cast<std::ptrdiff_t>(f); };
  return static_cast<std::size_t>(std::max_element(at(first), at(last) + 1) - speed.begin());
}

/// Takes away the shallowest minimum until each that is left is a stop.
void keep_stops(const std::vector<double>& speed, const FindOptions& options, std::vector<std::size_t>& frames) {
  while (frames.size() > 2) {
    double worst = options.still_part;
    std::size_t shallowest = 0;
    for (std::size_t i = 1; i + 1 < frames.size(); ++i) {
      const double here = speed[frames[i]];
      if (here <= options.still_speed) continue;
      const double before = speed[peak_between(speed, frames[i - 1], frames[i])];
      const double after = speed[peak_between(speed, frames[i], frames[i + 1])];
      const double part = here / std::min(before, after);
      if (part > worst) {
        worst = part;
        shallowest = i;
      }
    }
    if (shallowest == 0) return;
    frames.erase(frames.begin() + static_cast<std::ptrdiff_t>(shallowest));
  }
}

/// The part of a movement around its peak, out to the first frames that are slow and all but at the ends of its path.
FrameRange without_slow_ends(const std::vector<double>& speed, const FrameRange& cell, std::size_t peak,
                             double still_part) {
  double total = 0.0;
  for (std::size_t f = cell.first; f <= cell.last; ++f) total += speed[f];
  const double slow = still_part * speed[peak];
  FrameRange kept = cell;
  double outside = 0.0;
  for (std::size_t f = cell.first; f < peak && (outside += speed[f]) <= kNearly * total; ++f) {
    if (speed[f] < slow) kept.first = f;
  }
  outside = 0.0;
  for (std::size_t f = cell.last; f > peak && (outside += speed[f]) <= kNearly * total; --f) {
    if (speed[f] < slow) kept.last = f;
  }
  return kept;
}

bool goes_on(const HandTracks& hands, const FrameRange& before, const FrameRange& after) {
  const auto travel = [&](const FrameRange& range) { return hands.hold[range.last] - hands.hold[range.first]; };
  return glm::dot(travel(before), travel(after)) > 0.0;
}

}  // namespace

Points bridged(Points points, const std::string& what) {
  const std::size_t count = points.size();
  std::size_t before = count;  // the last frame that is there
  for (std::size_t f = 0; f < count; ++f) {
    if (!is_finite(points[f])) continue;
    const std::size_t begin = before == count ? 0 : before + 1;
    for (std::size_t g = begin; g < f; ++g) {
      const double share = static_cast<double>(g - begin + 1) / static_cast<double>(f - begin + 1);
      points[g] = before == count ? points[f] : glm::mix(points[before], points[f], share);
    }
    before = f;
  }
  if (before == count) throw std::invalid_argument(what + " is missing in all frames");
  for (std::size_t g = before + 1; g < count; ++g) points[g] = points[before];
  return points;
}

std::vector<double> smooth_speeds(const Points& points, double rate_hz) {
  const Points smooth = smoothed(points, rate_hz);
  std::vector<double> speeds(points.size(), 0.0);
  for (std::size_t f = 0; f < points.size() && points.size() > 1; ++f) {
    const std::size_t before = f == 0 ? f : f - 1, after = std::min(f + 1, points.size() - 1);
    speeds[f] = glm::distance(smooth[after], smooth[before]) * rate_hz / static_cast<double>(after - before);
  }
  return speeds;
}

HandTracks hand_tracks(const Clip& clip, Hands hands) {
  HandTracks tracks;
  tracks.rate_hz = clip.rate_hz;
  tracks.hands = hands;
  constexpr std::array<Joint, 2> grips{Joint::left_grip, Joint::right_grip};
  for (std::size_t side = 0; side < 2; ++side) {
    Points points;
    for (std::size_t f = 0; f < clip.frames(); ++f) points.push_back(clip.at(f, index(grips[side])));
    tracks.grips[side] = bridged(std::move(points), std::string(joint_name(grips[side])));
  }
  for (std::size_t f = 0; f < clip.frames(); ++f) {
    const Vec3 &left = tracks.grips[0][f], &right = tracks.grips[1][f];
    tracks.hold.push_back(hands == Hands::both ? 0.5 * (left + right) : hands == Hands::left ? left : right);
  }
  tracks.speed = smooth_speeds(tracks.hold, clip.rate_hz);
  return tracks;
}

std::vector<FrameRange> movements(const HandTracks& hands, const FrameRange& within, const FindOptions& options) {
  std::vector<FrameRange> found;
  if (within.last <= within.first) return found;
  std::vector<std::size_t> frames = turning_frames(hands.speed, within);
  keep_stops(hands.speed, options, frames);
  for (std::size_t i = 0; i + 1 < frames.size(); ++i) {
    const FrameRange cell{frames[i], frames[i + 1]};
    const std::size_t peak = peak_between(hands.speed, cell.first, cell.last);
    if (hands.speed[peak] < kSlowestPeak) continue;
    found.push_back(without_slow_ends(hands.speed, cell, peak, options.still_part));
  }
  return found;
}

double seconds_between(const FrameRange& earlier, const FrameRange& later, double rate_hz) {
  return (static_cast<double>(later.first) - static_cast<double>(earlier.last)) / rate_hz;
}

std::vector<FrameRange> ways(const HandTracks& hands, const FrameRange& within, const FindOptions& options) {
  std::vector<FrameRange> joined;
  for (const FrameRange& next : movements(hands, within, options)) {
    const bool short_stop = !joined.empty() && seconds_between(joined.back(), next, hands.rate_hz) < options.pause_s;
    if (short_stop && goes_on(hands, joined.back(), next)) {
      joined.back().last = next.last;
    } else {
      joined.push_back(next);
    }
  }
  return joined;
}

}  // namespace reachcast
