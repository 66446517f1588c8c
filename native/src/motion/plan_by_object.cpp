// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <sstream>

#include "plan_ways.hpp"

namespace reachcast {
namespace {

constexpr double kObjectStill = 0.05;  // m/s
constexpr double kNudge_m = 0.05;      // an object that ends and stays nearer than this was not carried
constexpr double kLifted_m = 0.01;     // from its resting place
constexpr double kRest_s = 0.5;        // looked at to find a resting place
constexpr double kSamePlace_m = 0.25;  // between where the hands take or put the object, and home

double farthest(const Points& points, const FrameRange& range) {
  double far = 0.0;
  for (std::size_t f = range.first; f <= range.last; ++f)
    far = std::max(far, glm::distance(points[f], points[range.first]));
  return far;
}

/// The hands stay where they are on the object.
bool is_held(const HandTracks& hands, const Points& object, const FrameRange& range, double slip_m) {
  return spread(range, [&](std::size_t f) { return glm::distance(hands.hold[f], object[f]); }) <= slip_m;
}

/// Frames in which the object moves, those between which the hands keep hold of it taken together.
std::vector<FrameRange> moving_ranges(const HandTracks& hands, const Points& object, const FindOptions& options) {
  const std::vector<double> speed = smooth_speeds(object, hands.rate_hz);
  std::vector<FrameRange> found;
  for (std::size_t f = 0; f < speed.size(); ++f) {
    if (speed[f] < kObjectStill) continue;
    FrameRange run{f, f};
    while (run.last + 1 < speed.size() && speed[run.last + 1] >= kObjectStill) ++run.last;
    f = run.last;
    if (!found.empty() && (seconds_between(found.back(), run, hands.rate_hz) < options.pause_s ||
                           is_held(hands, object, {found.back().last, run.first}, options.slip_m))) {
      found.back().last = run.last;
    } else {
      found.push_back(run);
    }
  }
  std::erase_if(found, [&](const FrameRange& run) { return farthest(object, run) < kNudge_m; });
  return found;
}

/// Lift-off and placing are where the object leaves its resting places by kLifted_m.
void settle_ends(const Points& object, double rate_hz, const FrameRange& between, FrameRange& run) {
  const auto rest = static_cast<std::size_t>(kRest_s * rate_hz);
  const Vec3 before = object[run.first < between.first + rest ? between.first : run.first - rest];
  const Vec3 after = object[std::min(run.last + rest, between.last)];
  const auto lifted = [&](std::size_t f, const Vec3& place) { return glm::distance(object[f], place) > kLifted_m; };
  while (run.first < run.last && !lifted(run.first, before)) ++run.first;
  while (run.first > between.first && lifted(run.first - 1, before)) --run.first;
  while (run.last > run.first && !lifted(run.last, after)) --run.last;
  while (run.last < between.last && lifted(run.last + 1, after)) ++run.last;
}

/// Lift-off to placed of each carry. One that touches an end of the recording was on its way there.
std::vector<FrameRange> find_carries(const HandTracks& hands, const Points& object, const FindOptions& options) {
  std::vector<FrameRange> carries = moving_ranges(hands, object, options);
  for (std::size_t i = 0; i < carries.size(); ++i) {
    const std::size_t after = i + 1 < carries.size() ? carries[i + 1].first : hands.frames() - 1;
    settle_ends(object, hands.rate_hz, {i == 0 ? 0 : carries[i - 1].last, after}, carries[i]);
  }
  return carries;
}

/// The frame at which the hands are slowest while they touch the object at rest: from `from` towards `to`, as long as
/// those that work stay as far from it as they are at `from`, to half the slip.
std::size_t stillest_touch(const HandTracks& hands, const Points& object, std::size_t from, std::size_t to,
                           const FindOptions& options) {
  const auto touch = [&](std::size_t f) {
    const auto stays = [&](const Points& grip) {
      const double now = glm::distance(grip[f], object[f]), then = glm::distance(grip[from], object[from]);
      return std::abs(now - then) <= 0.5 * options.slip_m;
    };
    return (!works(hands.hands, 0) || stays(hands.grips[0])) && (!works(hands.hands, 1) || stays(hands.grips[1]));
  };
  std::size_t stillest = from;
  for (std::size_t f = from; f != to;) {
    f = to > f ? f + 1 : f - 1;
    if (!touch(f)) break;
    if (hands.speed[f] < hands.speed[stillest]) stillest = f;
  }
  return stillest;
}

/// Ways of the empty hands between two carries: the first leads away from what was let go, the last to what is taken.
/// The hands let go when the first begins, and grasp when the last ends.
void plan_empty(const HandTracks& hands, const FrameRange& within, bool after, bool before, const FindOptions& options,
                WayPlan& plan) {
  const std::vector<FrameRange> found = ways(hands, within, options);
  if (after && !found.empty()) plan.events.push_back({"release", found.front().first});
  for (std::size_t i = 0; i < found.size(); ++i) {
    Way way{found[i], {}, "the hands are empty and come neither to the object nor from it"};
    if (before && i + 1 == found.size()) way.phase = Phase::reach;
    if (after && i == 0 && !(before && found.size() == 1)) way.phase = Phase::return_;
    plan.ways.push_back(way);
  }
  if (before && !found.empty()) plan.events.push_back({"grasp", found.back().last});
}

void plan_loaded(const HandTracks& hands, const FrameRange& carry, const FindOptions& options, Home& home,
                 WayPlan& plan) {
  home.pick_up(hands.hold[carry.first]);
  std::vector<FrameRange> found = ways(hands, carry, options);
  if (found.empty()) found.push_back(carry);
  const auto near = [&](std::size_t a, std::size_t b) {
    return static_cast<double>(b - a) / hands.rate_hz < options.pause_s;
  };
  if (near(carry.first, found.front().first)) found.front().first = carry.first;
  if (near(found.back().last, carry.last)) found.back().last = carry.last;
  for (const FrameRange& range : found) {
    plan.ways.push_back({range, home.loaded_way(hands.hold[range.first], hands.hold[range.last]), {}});
  }
}

}  // namespace

void Home::pick_up(const Vec3& place) {
  const auto same = [&](const std::optional<Vec3>& other) {
    return other && glm::distance(*other, place) < kSamePlace_m;
  };
  if (!same(put_)) home_ = place;
  put_.reset();
}

Phase Home::loaded_way(const Vec3& from, const Vec3& to) {
  if (!home_) home_ = from;
  put_ = to;
  const double before = glm::distance(from, *home_), after = glm::distance(to, *home_);
  return after < kSamePlace_m && after < 0.5 * before ? Phase::retrieve : Phase::transfer;
}

WayPlan plan_by_object(const HandTracks& hands, const Points& object, const std::string& name,
                       const FindOptions& options) {
  WayPlan plan;
  const std::vector<FrameRange> carries = find_carries(hands, object, options);
  if (carries.empty()) {
    std::ostringstream text;
    text << "the object '" << name << "' is never carried: it moves at most "
         << std::round(100.0 * farthest(object, {0, object.size() - 1})) / 100.0 << " m";
    plan.nothing = text.str();
    return plan;
  }
  Home home;
  const std::size_t last = hands.frames() - 1;
  std::size_t cursor = 0;
  for (std::size_t i = 0; i < carries.size(); ++i) {
    const FrameRange& carry = carries[i];
    const std::size_t grasped = stillest_touch(hands, object, carry.first, cursor, options);
    plan_empty(hands, {cursor, grasped}, cursor > 0, true, options, plan);
    if (carry.first > 0) plan.events.push_back({"lift-off", carry.first});
    plan_loaded(hands, carry, options, home, plan);
    if (carry.last < last) plan.events.push_back({"placed", carry.last});
    const std::size_t next = i + 1 < carries.size() ? carries[i + 1].first : last;
    cursor = stillest_touch(hands, object, carry.last, next, options);
  }
  plan_empty(hands, {cursor, last}, true, false, options, plan);
  return plan;
}

}  // namespace reachcast
