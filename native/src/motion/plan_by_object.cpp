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

/// Frames of one carry. An object that is on its way at an end of the recording has no grasp, or no release.
struct Carry {
  FrameRange moving;  ///< lift-off to placed
  std::optional<std::size_t> grasp, release;
};

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

/// How far from frame `from` towards `to` both hands stay as far from the object as they are there, to half the slip.
std::size_t contact_end(const HandTracks& hands, const Points& object, std::size_t from, std::size_t to,
                        double slip_m) {
  const auto holds = [&](std::size_t f) {
    return std::all_of(hands.grips.begin(), hands.grips.end(), [&](const Points& grip) {
      return std::abs(glm::distance(grip[f], object[f]) - glm::distance(grip[from], object[from])) <= 0.5 * slip_m;
    });
  };
  std::size_t end = from;
  while (end != to) {
    const std::size_t next = to > end ? end + 1 : end - 1;
    if (!holds(next)) break;
    end = next;
  }
  return end;
}

std::vector<Carry> find_carries(const HandTracks& hands, const Points& object, const FindOptions& options) {
  const std::vector<FrameRange> runs = moving_ranges(hands, object, options);
  std::vector<Carry> carries;
  const std::size_t last = hands.frames() - 1;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const FrameRange between{i == 0 ? 0 : carries.back().moving.last, i + 1 < runs.size() ? runs[i + 1].first : last};
    Carry carry{runs[i], {}, {}};
    settle_ends(object, hands.rate_hz, between, carry.moving);
    const std::size_t earliest = carries.empty() ? 0 : carries.back().release.value_or(between.first);
    if (carry.moving.first > 0) {
      carry.grasp = contact_end(hands, object, carry.moving.first, earliest, options.slip_m);
    }
    if (carry.moving.last < last) {
      carry.release = contact_end(hands, object, carry.moving.last, between.last, options.slip_m);
    }
    carries.push_back(carry);
  }
  return carries;
}

/// Ways of the empty hands between two carries: the first leads away from what was let go, the last to what is taken.
void plan_empty(const HandTracks& hands, const FrameRange& within, bool after, bool before, const FindOptions& options,
                Plan& plan) {
  const std::vector<FrameRange> found = ways(hands, within, options);
  for (std::size_t i = 0; i < found.size(); ++i) {
    Way way{found[i], {}, "the hands are empty and come neither to the object nor from it"};
    if (before && i + 1 == found.size()) way.phase = Phase::reach;
    if (after && i == 0 && !(way.phase && found.size() == 1)) way.phase = Phase::return_;
    plan.ways.push_back(way);
  }
}

void plan_loaded(const HandTracks& hands, const Carry& carry, const FindOptions& options, Home& home, Plan& plan) {
  home.pick_up(hands.hold[carry.moving.first]);
  std::vector<FrameRange> found = ways(hands, carry.moving, options);
  if (found.empty()) found.push_back(carry.moving);
  const auto near = [&](std::size_t a, std::size_t b) {
    return static_cast<double>(b - a) / hands.rate_hz < options.pause_s;
  };
  if (near(carry.moving.first, found.front().first)) found.front().first = carry.moving.first;
  if (near(found.back().last, carry.moving.last)) found.back().last = carry.moving.last;
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

Plan plan_by_object(const HandTracks& hands, const Points& object, const std::string& name,
                    const FindOptions& options) {
  Plan plan;
  const std::vector<Carry> carries = find_carries(hands, object, options);
  if (carries.empty()) {
    std::ostringstream text;
    text << "the object '" << name << "' is never carried: it moves at most "
         << std::round(100.0 * farthest(object, {0, object.size() - 1})) / 100.0 << " m";
    plan.nothing = text.str();
    return plan;
  }
  Home home;
  std::size_t cursor = 0;
  bool after = false;
  for (const Carry& carry : carries) {
    if (carry.grasp) {
      plan_empty(hands, {cursor, std::max(cursor, *carry.grasp)}, after, true, options, plan);
      plan.events.push_back({"grasp", *carry.grasp});
      plan.events.push_back({"lift-off", carry.moving.first});
    }
    plan_loaded(hands, carry, options, home, plan);
    after = carry.release.has_value();
    cursor = carry.release.value_or(carry.moving.last);
    if (!after) continue;
    plan.events.push_back({"placed", carry.moving.last});
    plan.events.push_back({"release", *carry.release});
  }
  plan_empty(hands, {cursor, hands.frames() - 1}, after, false, options, plan);
  return plan;
}

}  // namespace reachcast
