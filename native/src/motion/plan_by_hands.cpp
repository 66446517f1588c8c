// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "plan_ways.hpp"

namespace reachcast {
namespace {

using enum Joint;

constexpr double kUpright = 0.87;  // cosine of 30 degrees: the trunk from the vertical
constexpr double kHanging = 0.9;   // cosine of 26 degrees: the arms from the vertical

double rise(const Vec3& from, const Vec3& to) {
  return (to.z - from.z) / glm::distance(from, to);
}

/// The arms hang down beside an upright trunk.
bool at_rest(const HandTracks& hands, const Clip& clip, std::size_t frame) {
  const auto at = [&](Joint joint) { return clip.at(frame, index(joint)); };
  const Vec3 hips = 0.5 * (at(left_hip) + at(right_hip)), shoulders = 0.5 * (at(left_shoulder) + at(right_shoulder));
  return rise(hips, shoulders) > kUpright && -rise(at(left_shoulder), hands.grips[0][frame]) > kHanging &&
         -rise(at(right_shoulder), hands.grips[1][frame]) > kHanging;
}

/// What the hands do, from one stroke to the next.
class HandState {
 public:
  HandState(const HandTracks& hands, const Clip& clip, const FindOptions& options)
      : hands_(hands), clip_(clip), options_(options) {}

  /// The phase of the next stroke; nothing when the hands only swing from rest to rest.
  std::optional<Phase> next(const FrameRange& stroke) {
    const bool from_rest = at_rest(hands_, clip_, stroke.first), to_rest = at_rest(hands_, clip_, stroke.last);
    const bool keep = hands_.hands != Hands::both ||
                      spread(stroke, [&](std::size_t f) { return hands_.apart(f); }) <= options_.parted_m;
    const bool come = state_ == State::arrived || (state_ == State::unknown && !from_rest);
    if (state_ == State::arrived ? keep : state_ == State::holding && keep && !to_rest) {
      if (state_ == State::arrived) home_.pick_up(hands_.hold[stroke.first]);
      state_ = State::holding;
      return home_.loaded_way(hands_.hold[stroke.first], hands_.hold[stroke.last]);
    }
    const bool leaves = state_ == State::holding || state_ == State::arrived;
    if (to_rest) {
      state_ = State::empty;
      if (leaves || (come && !from_rest)) return Phase::return_;
      return std::nullopt;
    }
    state_ = State::arrived;
    return Phase::reach;
  }

 private:
  enum class State { unknown, empty, arrived, holding };
  const HandTracks& hands_;
  const Clip& clip_;
  const FindOptions& options_;
  State state_ = State::unknown;
  Home home_;
};

/// Grasp and lift-off are the ends of the stop before a loaded way, placed and release those of the stop after it.
void add_events(const std::vector<Way>& ways, WayPlan& plan) {
  for (std::size_t i = 0; i < ways.size(); ++i) {
    if (!ways[i].phase || !is_loaded(*ways[i].phase)) continue;
    const auto is_empty = [&](std::size_t k) { return !ways[k].phase || !is_loaded(*ways[k].phase); };
    if (i > 0 && is_empty(i - 1)) {
      plan.events.push_back({"grasp", ways[i - 1].frames.last});
      plan.events.push_back({"lift-off", ways[i].frames.first});
    }
    if (i + 1 < ways.size() && is_empty(i + 1)) {
      plan.events.push_back({"placed", ways[i].frames.last});
      plan.events.push_back({"release", ways[i + 1].frames.first});
    }
  }
}

}  // namespace

WayPlan plan_by_hands(const HandTracks& hands, const Clip& clip, const FindOptions& options) {
  WayPlan plan;
  HandState state(hands, clip, options);
  for (const FrameRange& stroke : ways(hands, {0, hands.frames() - 1}, options)) {
    const std::optional<Phase> phase = state.next(stroke);
    plan.ways.push_back({stroke, phase, "the hands hang at the sides before and after"});
  }
  if (plan.ways.empty()) plan.nothing = "the hands stand still throughout";
  add_events(plan.ways, plan);
  return plan;
}

}  // namespace reachcast
