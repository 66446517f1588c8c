// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/motion/find_reaches.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include "check_way.hpp"
#include "keep_reach.hpp"
#include "plan_ways.hpp"
#include "working_hands.hpp"

namespace reachcast {
namespace {

/// A way with standing feet; `open` is the speed at an end that a step cut off, as a part of the peak.
struct Part {
  FrameRange frames;
  double open = 0.0;
};

double peak_speed(const HandTracks& hands, const FrameRange& range) {
  const auto at = [&](std::size_t f) { return hands.speed.begin() + static_cast<std::ptrdiff_t>(f); };
  return *std::max_element(at(range.first), at(range.last) + 1);
}

/// What is left of a way when it ends before the first step after its first frame.
Part head_of(const HandTracks& hands, const FrameRange& way, const FrameRange& standing, const FindOptions& options) {
  const std::vector<FrameRange> found = movements(hands, standing, options);
  Part part{{way.first, found.empty() ? standing.last : std::max(way.first, found.front().last)}};
  part.open = hands.speed[part.frames.last] / peak_speed(hands, part.frames);
  return part;
}

/// What is left of a way when it begins after the last step before its last frame.
Part tail_of(const HandTracks& hands, const FrameRange& way, const FrameRange& standing, const FindOptions& options) {
  const std::vector<FrameRange> found = movements(hands, standing, options);
  Part part{{found.empty() ? standing.first : std::min(way.last, found.back().first), way.last}};
  part.open = hands.speed[part.frames.first] / peak_speed(hands, part.frames);
  return part;
}

class Cutter {
 public:
  Cutter(const Tracked& recorded, const Keeper& keeper, const FindOptions& options, FoundReaches& found)
      : recorded_(recorded), keeper_(keeper), options_(options), found_(found) {}

  void cut(const Way& way) {
    if (!way.phase) {
      found_.rejections.push_back({"movement", way.why_not, way.frames.first, way.frames.last});
      return;
    }
    const Phase phase = *way.phase;
    const Standing after = standing_about(recorded_.clip, way.frames.first, way.frames, options_);
    if (after.moved.empty()) {
      take({way.frames, 0.0}, phase);
      return;
    }
    const Standing before = standing_about(recorded_.clip, way.frames.last, way.frames, options_);
    if (phase != Phase::reach) take(head_of(recorded_.hands, way.frames, after.frames, options_), phase);
    const FrameRange middle{phase == Phase::reach ? way.frames.first : after.frames.last + 1,
                            phase == Phase::return_ ? way.frames.last : before.frames.first};
    found_.rejections.push_back(
        {std::string(phase_name(phase)), after.moved, middle.first, std::max(middle.first, middle.last)});
    if (phase != Phase::return_) take(tail_of(recorded_.hands, way.frames, before.frames, options_), phase);
  }

 private:
  void take(const Part& part, Phase phase) {
    std::string reason = why_not(recorded_, part.frames, phase, options_);
    if (reason.empty() && part.open > options_.fastest_end) {
      reason = "a step cuts it off while the hands move at " + std::to_string(std::lround(100.0 * part.open)) +
               " % of their peak speed; at most " + std::to_string(std::lround(100.0 * options_.fastest_end)) +
               " % are taken";
    }
    keeper_.keep(part.frames, phase, recorded_.hands.hands, reason, found_);
  }

  const Tracked& recorded_;
  const Keeper& keeper_;
  const FindOptions& options_;
  FoundReaches& found_;
};

}  // namespace

std::optional<ObjectTrack> object_track(const Clip& recorded, const std::optional<std::string>& name) {
  std::optional<std::size_t> column;
  std::string known;
  for (std::size_t joint = 0; joint < recorded.joints(); ++joint) {
    std::string lower = recorded.names[joint];
    std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
    const bool fits = name ? recorded.names[joint] == *name : lower == "obj" || lower == "object" || lower == "box";
    if (fits && !column) column = joint;
    known += (known.empty() ? "" : ", ") + recorded.names[joint];
  }
  if (!column && name) {
    throw std::invalid_argument(recorded.source + ": object '" + *name +
                                "' is not a point of the recording, which has " + known);
  }
  if (!column) return std::nullopt;
  ObjectTrack track{recorded.names[*column], {}};
  for (std::size_t f = 0; f < recorded.frames(); ++f) track.positions.push_back(recorded.at(f, *column));
  return track;
}

FoundReaches find_reaches(const Clip& clip, const Subject& subject, const FindOptions& options,
                          const Evidence& evidence) {
  const Keeper keeper(clip, subject, options, evidence);
  FoundReaches found;
  const auto nothing = [&](const std::string& why) {
    found.rejections.push_back({"recording", why, 0, clip.frames() - 1});
    return found;
  };
  HandTracks hands;
  std::optional<Points> object;
  try {
    hands = hand_tracks(clip);
    if (evidence.object) object = bridged(evidence.object->positions, "the object '" + evidence.object->name + "'");
    const Hands working = working_hands(hands, clip, object ? &*object : nullptr, options);
    if (working != Hands::both) hands = hand_tracks(clip, working);
  } catch (const std::invalid_argument& missing) {
    return nothing(missing.what());
  }
  const WayPlan plan =
      object ? plan_by_object(hands, *object, evidence.object->name, options) : plan_by_hands(hands, clip, options);
  found.events = plan.events;
  if (!plan.nothing.empty()) return nothing(plan.nothing);
  const Tracked recorded{clip, hands, object ? &*object : nullptr, object ? &evidence.object->positions : nullptr,
                         evidence.faults};
  Cutter cutter(recorded, keeper, options, found);
  for (const Way& way : plan.ways) cutter.cut(way);
  return found;
}

}  // namespace reachcast
