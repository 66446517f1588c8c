// SPDX-License-Identifier: GPL-3.0-or-later
#include "check_way.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace reachcast {
namespace {

using enum Joint;

constexpr std::array<const char*, 2> kSides{"left", "right"};

std::string frames_text(std::size_t first, std::size_t last) {
  return first == last ? "frame " + std::to_string(first)
                       : "frames " + std::to_string(first) + " to " + std::to_string(last);
}

std::string fault_in(const Tracked& recorded, const FrameRange& range) {
  for (const TrackingFault& fault : recorded.faults) {
    if (fault.first > range.last || fault.last < range.first) continue;
    return fault.joint + " " + fault.reason + " in " + frames_text(fault.first, fault.last);
  }
  return {};
}

std::string filled_in(const Clip& clip, const FrameRange& range, double longest_s) {
  if (clip.filled.empty()) return {};
  for (std::size_t joint = 0; joint < clip.joints(); ++joint) {
    const auto is_filled = [&](std::size_t f) { return clip.filled[f * clip.joints() + joint] != 0; };
    for (std::size_t f = range.first; f <= range.last; ++f) {
      if (!is_filled(f)) continue;
      std::size_t first = f, last = f;
      while (first > 0 && is_filled(first - 1)) --first;
      while (last + 1 < clip.frames() && is_filled(last + 1)) ++last;
      const double seconds = static_cast<double>(last - first + 1) / clip.rate_hz;
      if (seconds > longest_s + 0.5 / clip.rate_hz) {
        return clip.names[joint] + " was not recorded in " + frames_text(first, last) + " but filled in, for " +
               two_digits(seconds) + " s; at most " + two_digits(longest_s) + " s are taken";
      }
      f = last;
    }
  }
  return {};
}

std::string missing_object(const Tracked& recorded, const FrameRange& range, double longest_s) {
  std::size_t missing = 0;
  for (std::size_t f = range.first; f <= range.last; ++f) {
    missing = is_finite((*recorded.object_as_is)[f]) ? 0 : missing + 1;
    if (static_cast<double>(missing) > longest_s * recorded.clip.rate_hz + 0.5) {
      return "the object is missing in frame " + std::to_string(f) + " and more than " + two_digits(longest_s) +
             " s before";
    }
  }
  return {};
}

/// Whether the hands that work hold the same thing all the way.
std::string loose_hold(const Tracked& recorded, const FrameRange& range, const FindOptions& options) {
  const HandTracks& hands = recorded.hands;
  if (recorded.object) {
    for (std::size_t side = 0; side < 2; ++side) {
      if (!works(hands.hands, side)) continue;
      const double slip =
          spread(range, [&](std::size_t f) { return glm::distance(hands.grips[side][f], (*recorded.object)[f]); });
      if (slip > options.slip_m) {
        return std::string("the ") + kSides[side] + " hand is not on the object: their distance varies by " +
               two_digits(slip) + " m; at most " + two_digits(options.slip_m) + " m are taken for a hold";
      }
    }
    return missing_object(recorded, range, options.cut.longest_gap_s);
  }
  if (hands.hands != Hands::both) return {};
  const double parted = spread(range, [&](std::size_t f) { return hands.apart(f); });
  if (parted <= options.parted_m) return {};
  return "the distance between the hands varies by " + two_digits(parted) + " m; at most " +
         two_digits(options.parted_m) + " m are taken for a hold";
}

std::string uneven_hands(const HandTracks& hands, const FrameRange& range, const FindOptions& options) {
  if (hands.hands != Hands::both) return {};
  double uneven = 0.0;
  for (std::size_t f = range.first; f <= range.last; ++f) {
    uneven = std::max(uneven, std::abs(hands.grips[0][f].z - hands.grips[1][f].z));
  }
  if (uneven <= options.uneven_m) return {};
  return "one hand is " + two_digits(uneven) + " m higher than the other; at most " + two_digits(options.uneven_m) +
         " m are taken for two hands alike";
}

}  // namespace

std::string two_digits(double value) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << value;
  return text.str();
}

Standing standing_about(const Clip& clip, std::size_t anchor, const FrameRange& within, const FindOptions& options) {
  const bool has_balls = !clip.derived[index(left_ball)] && !clip.derived[index(right_ball)];
  const std::array<Joint, 2> feet = has_balls ? std::array{left_ball, right_ball} : std::array{left_ankle, right_ankle};
  const double limit = has_balls ? options.step_m : options.ankle_step_m;
  Standing standing{{anchor, anchor}, {}};
  const auto steps = [&](std::size_t f) {
    for (std::size_t side = 0; side < 2; ++side) {
      const double moved = glm::distance(clip.at(f, index(feet[side])), clip.at(anchor, index(feet[side])));
      if (!(moved > limit)) continue;  // a missing foot has not been seen to step
      standing.moved = std::string("the ") + kSides[side] + " foot steps in frame " + std::to_string(f) +
                       " (moved by more than " + two_digits(limit) + " m)";
      return true;
    }
    return false;
  };
  while (standing.frames.first > within.first && !steps(standing.frames.first - 1)) --standing.frames.first;
  while (standing.frames.last < within.last && !steps(standing.frames.last + 1)) ++standing.frames.last;
  return standing;
}

std::string why_not(const Tracked& recorded, const FrameRange& range, Phase phase, const FindOptions& options) {
  const HandTracks& hands = recorded.hands;
  const double seconds = static_cast<double>(range.last - range.first) / hands.rate_hz;
  if (seconds < options.least_s) {
    return "lasts only " + two_digits(seconds) + " s; at least " + two_digits(options.least_s) + " s are needed";
  }
  const double travel = glm::distance(hands.hold[range.first], hands.hold[range.last]);
  if (travel < options.least_travel_m) {
    return "the hands come only " + two_digits(travel) + " m from where they began; at least " +
           two_digits(options.least_travel_m) + " m are needed";
  }
  std::string reason = fault_in(recorded, range);
  if (reason.empty()) reason = filled_in(recorded.clip, range, options.longest_filled_s);
  if (!reason.empty()) return reason;
  if (is_loaded(phase)) {
    reason = loose_hold(recorded, range, options);
    return reason.empty() ? uneven_hands(hands, range, options) : reason;
  }
  const std::size_t contact = phase == Phase::reach ? range.last : range.first;
  return uneven_hands(hands, {contact, contact}, options);
}

}  // namespace reachcast
