// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/mocap/tracking.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "reachcast/body/joints.hpp"
#include "units.hpp"

namespace reachcast {
namespace {

constexpr double kReturn_s = 0.5;          // a jump back within this belongs to the jump away
constexpr double kSameJump = 0.35;         // of its size: two jumps that cancel this well are one
constexpr double kOthersMove_m = 0.05;     // while a frozen point keeps its place
constexpr double kLeastExchange_m = 0.06;  // two points nearer than this can change places unseen
constexpr double kClearExchange = 0.4;     // of the way without it: an exchange must shorten the way this much
constexpr double kMostFrames = 0.9;        // of all frames: sides exchanged in so many are exchanged throughout

using Faults = std::vector<TrackingFault>;

std::string rounded(double value) {
  return show(std::round(value * 100.0) / 100.0);
}

struct Jump {
  std::size_t first, last;  ///< last frame before, first frame after
  Vec3 by;
};

/// Frames about which a point bends its path more than a body can.
std::vector<Jump> find_jumps(const Clip& clip, std::size_t joint, const TrackingLimits& limits) {
  const double most_m = limits.acceleration / (clip.rate_hz * clip.rate_hz) + limits.jump_m;
  std::vector<Jump> jumps;
  for (std::size_t frame = 1; frame + 1 < clip.frames(); ++frame) {
    const Vec3 before = clip.at(frame, joint) - clip.at(frame - 1, joint);
    const Vec3 after = clip.at(frame + 1, joint) - clip.at(frame, joint);
    if (!(glm::length(after - before) > most_m)) continue;
    const bool goes_before = glm::length(before) > glm::length(after);  // the longer step is the jump
    const std::size_t first = goes_before ? frame - 1 : frame;
    if (!jumps.empty() && jumps.back().first == first) continue;
    jumps.push_back({first, first + 1, goes_before ? before : after});
  }
  return jumps;
}

void check_jumps(const Clip& clip, std::size_t joint, const TrackingLimits& limits, Faults& faults) {
  const std::vector<Jump> jumps = find_jumps(clip, joint, limits);
  for (std::size_t i = 0; i < jumps.size(); ++i) {
    TrackingFault fault{clip.names[joint], jumps[i].first, jumps[i].last,
                        "jumps " + rounded(glm::length(jumps[i].by)) + " m"};
    if (i + 1 < jumps.size()) {
      const Jump& next = jumps[i + 1];
      const double away_s = static_cast<double>(next.first - jumps[i].last) / clip.rate_hz;
      const bool comes_back = glm::length(jumps[i].by + next.by) < kSameJump * glm::length(jumps[i].by);
      if (away_s <= kReturn_s && comes_back) {
        fault.first = jumps[i].last;
        fault.last = next.first;
        fault.reason += " away and back";
        ++i;
      }
    }
    faults.push_back(fault);
  }
}

/// Median way of the other points between two frames.
double others_moved(const Clip& clip, std::size_t joint, std::size_t first, std::size_t last) {
  std::vector<double> ways;
  for (std::size_t other = 0; other < clip.joints(); ++other) {
    double farthest = 0.0;
    for (std::size_t frame = first; other != joint && frame <= last; ++frame) {
      const double way = glm::distance(clip.at(frame, other), clip.at(first, other));
      if (way > farthest) farthest = way;
    }
    if (other != joint) ways.push_back(farthest);
  }
  return median_of(ways);
}

/// Feet that are pinned to the floor, as animation tools and cleaned recordings have them, are no fault.
bool stands_on_the_floor(const std::string& name) {
  return body_end(name) == BodyEnd::low || name.find("ball") != std::string::npos ||
         name.find("Ball") != std::string::npos;
}

void check_frozen(const Clip& clip, std::size_t joint, const TrackingLimits& limits, Faults& faults) {
  if (stands_on_the_floor(clip.names[joint])) return;
  for (std::size_t first = 0, frame = 1; frame <= clip.frames(); ++frame) {
    if (frame < clip.frames() && clip.at(frame, joint) == clip.at(first, joint)) continue;
    const double still_s = static_cast<double>(frame - first) / clip.rate_hz;
    const bool is_long = still_s >= limits.frozen_s && frame - first >= 3 && is_finite(clip.at(first, joint));
    if (is_long && others_moved(clip, joint, first, frame - 1) > kOthersMove_m) {
      faults.push_back({clip.names[joint], first, frame - 1, "frozen for " + rounded(still_s) + " s"});
    }
    first = frame;
  }
}

/// The name on the other side; empty for points that have none.
std::string other_side(const std::string& name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 3> words{
      {{"left", "right"}, {"Left", "Right"}, {"LEFT", "RIGHT"}}};
  for (const auto& [left, right] : words) {
    if (const std::size_t at = name.find(left); at != std::string::npos) {
      return std::string(name).replace(at, left.size(), right);
    }
  }
  const std::size_t colon = name.rfind(':');
  const std::size_t at = colon == std::string::npos ? 0 : colon + 1;
  if (at >= name.size() || (name[at] != 'L' && name[at] != 'l')) return {};
  std::string other = name;
  other[at] = name[at] == 'L' ? 'R' : 'r';
  return other;
}

std::vector<std::pair<std::size_t, std::size_t>> find_pairs(const Clip& clip) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t left = 0; left < clip.joints(); ++left) {
    const std::string other = other_side(clip.names[left]);
    if (other.empty()) continue;
    if (const std::optional<std::size_t> right = clip.find(other)) pairs.emplace_back(left, *right);
  }
  return pairs;
}

/// Frames at which the two points change places.
std::vector<std::size_t> find_exchanges(const Clip& clip, std::size_t left, std::size_t right) {
  std::vector<std::size_t> exchanges;
  for (std::size_t frame = 1; frame < clip.frames(); ++frame) {
    const Vec3 &l0 = clip.at(frame - 1, left), &r0 = clip.at(frame - 1, right);
    const Vec3 &l1 = clip.at(frame, left), &r1 = clip.at(frame, right);
    const double kept = glm::distance(l0, l1) + glm::distance(r0, r1);
    const double exchanged = glm::distance(l0, r1) + glm::distance(r0, l1);
    if (kept > 2.0 * kLeastExchange_m && exchanged < kClearExchange * kept) exchanges.push_back(frame);
  }
  return exchanges;
}

void add_exchange(const Clip& clip, std::size_t left, std::size_t right, std::size_t first, std::size_t last,
                  Faults& faults) {
  const std::string reason = "left and right exchanged with ";
  faults.push_back({clip.names[left], first, last, reason + clip.names[right]});
  faults.push_back({clip.names[right], first, last, reason + clip.names[left]});
}

/// From the first change of places to the next, and so on; a last one without return lasts to the end. When that makes
/// more than half of the clip, the other half is the wrong one.
void check_exchanges(const Clip& clip, std::size_t left, std::size_t right, Faults& faults) {
  std::vector<std::size_t> edges = find_exchanges(clip, left, right);
  if (edges.empty()) return;
  std::size_t exchanged = 0;
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    exchanged += (i + 1 < edges.size() ? edges[i + 1] : clip.frames()) - edges[i];
  }
  if (2 * exchanged > clip.frames()) edges.insert(edges.begin(), 0);
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    const std::size_t end = i + 1 < edges.size() ? edges[i + 1] : clip.frames();
    if (end > edges[i]) add_exchange(clip, left, right, edges[i], end - 1, faults);
  }
}

/// A pair that lies the wrong way round in nearly all frames, judged by all pairs together.
void check_sides(const Clip& clip, const std::vector<std::pair<std::size_t, std::size_t>>& pairs, Faults& faults) {
  if (pairs.size() < 3) return;
  std::vector<std::size_t> wrong(pairs.size(), 0), seen(pairs.size(), 0);
  for (std::size_t frame = 0; frame < clip.frames(); ++frame) {
    Vec3 right(0.0);
    for (const auto& [l, r] : pairs) {
      const Vec3 across = clip.at(frame, r) - clip.at(frame, l);
      if (is_finite(across) && glm::length(across) > 0.0) right += glm::normalize(across);
    }
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const double along = glm::dot(clip.at(frame, pairs[i].second) - clip.at(frame, pairs[i].first), right);
      seen[i] += std::isfinite(along);
      wrong[i] += along < 0.0;
    }
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (seen[i] == 0 || static_cast<double>(wrong[i]) < kMostFrames * static_cast<double>(seen[i])) continue;
    add_exchange(clip, pairs[i].first, pairs[i].second, 0, clip.frames() - 1, faults);
  }
}

/// Thighs, shanks, upper and lower arms of a canonical clip.
void check_lengths(const Clip& clip, const TrackingLimits& limits, Faults& faults) {
  using enum Joint;
  constexpr std::array segments{std::pair{left_hip, left_knee}, std::pair{left_knee, left_ankle},
                                std::pair{left_shoulder, left_elbow}, std::pair{left_elbow, left_wrist}};
  for (const auto& [left_near, left_far] : segments) {
    for (const auto& [near, far] :
         {std::pair{left_near, left_far}, std::pair{mirrored(left_near), mirrored(left_far)}}) {
      std::vector<double> lengths;
      for (std::size_t frame = 0; frame < clip.frames(); ++frame) {
        lengths.push_back(glm::distance(clip.at(frame, index(near)), clip.at(frame, index(far))));
      }
      std::vector<double> sorted = lengths;
      const double usual = median_of(sorted);
      const auto off = [&](std::size_t frame) { return std::abs(lengths[frame] / usual - 1.0); };
      for (std::size_t frame = 0; frame < clip.frames(); ++frame) {
        if (!(off(frame) > limits.stretch)) continue;
        const std::size_t first = frame;
        double worst = 0.0;
        for (; frame < clip.frames() && off(frame) > limits.stretch; ++frame) worst = std::max(worst, off(frame));
        faults.push_back({std::string(joint_name(far)), first, frame - 1,
                          "its distance from " + std::string(joint_name(near)) + " is off by " +
                              show(std::round(100.0 * worst)) + " %"});
      }
    }
  }
}

void check_limits(const TrackingLimits& limits) {
  const auto positive = [](double value, const char* name) {
    if (!(value > 0.0)) throw std::invalid_argument(std::string(name) + " must be over 0, not " + show(value));
  };
  positive(limits.acceleration, "acceleration");
  positive(limits.jump_m, "jump");
  positive(limits.frozen_s, "frozen");
  positive(limits.stretch, "stretch");
}

}  // namespace

std::vector<TrackingFault> check_tracking(const Clip& clip, const TrackingLimits& limits) {
  check_limits(limits);
  Faults exchanges;
  const auto pairs = find_pairs(clip);
  for (const auto& [left, right] : pairs) check_exchanges(clip, left, right, exchanges);
  check_sides(clip, pairs, exchanges);
  Faults faults = exchanges;
  for (std::size_t joint = 0; joint < clip.joints(); ++joint) {
    Faults jumps;
    check_jumps(clip, joint, limits, jumps);
    for (const TrackingFault& jump : jumps) {  // an exchange is a jump of two points: said once
      const bool is_said = std::any_of(exchanges.begin(), exchanges.end(), [&](const TrackingFault& exchange) {
        return exchange.joint == jump.joint && jump.first <= exchange.last + 1 && exchange.first <= jump.last + 1;
      });
      if (!is_said) faults.push_back(jump);
    }
    check_frozen(clip, joint, limits, faults);
  }
  const auto& names = joint_names();
  const bool is_canonical = std::equal(clip.names.begin(), clip.names.end(), names.begin(), names.end());
  if (is_canonical) check_lengths(clip, limits, faults);
  std::stable_sort(faults.begin(), faults.end(), [&](const TrackingFault& a, const TrackingFault& b) {
    return std::pair(clip.find(a.joint), a.first) < std::pair(clip.find(b.joint), b.first);
  });
  return faults;
}

}  // namespace reachcast
