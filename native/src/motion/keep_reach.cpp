// SPDX-License-Identifier: GPL-3.0-or-later
#include "keep_reach.hpp"

#include <algorithm>
#include <stdexcept>

namespace reachcast {
namespace {

void check_options(const FindOptions& o) {
  const auto require = [](bool fits, const char* name, const char* limit, double value) {
    if (!fits) throw std::invalid_argument(std::string(name) + " must be " + limit + ", not " + std::to_string(value));
  };
  const auto part = [&](const char* name, double value) {
    require(value >= 0.0 && value <= 1.0, name, "0 to 1", value);
  };
  const auto over_0 = [&](const char* name, double value) { require(value > 0.0, name, "over 0", value); };
  const auto from_0 = [&](const char* name, double value) { require(value >= 0.0, name, "at least 0", value); };
  part("still_part", o.still_part);
  part("fastest_end", o.fastest_end);
  over_0("still_speed", o.still_speed);
  over_0("least_travel_m", o.least_travel_m);
  over_0("step_m", o.step_m);
  over_0("ankle_step_m", o.ankle_step_m);
  over_0("slip_m", o.slip_m);
  over_0("parted_m", o.parted_m);
  over_0("uneven_m", o.uneven_m);
  from_0("pause_s", o.pause_s);
  from_0("least_s", o.least_s);
  from_0("longest_filled_s", o.longest_filled_s);
  from_0("longest_gap_s", o.cut.longest_gap_s);
}

}  // namespace

Keeper::Keeper(const Clip& clip, const Subject& subject, const FindOptions& options, const Evidence& evidence)
    : clip_(clip), subject_(subject), options_(options) {
  origin_ = evidence.origin.empty() ? clip.source : evidence.origin;
  check_options(options);
  const auto& names = joint_names();
  if (!std::equal(clip.names.begin(), clip.names.end(), names.begin(), names.end())) {
    throw std::invalid_argument(clip.source + ": the clip is not in the canonical joints; convert it first");
  }
  if (clip.frames() == 0) throw std::invalid_argument(clip.source + ": the clip holds no frames");
  if (!(clip.rate_hz > 0.0)) {
    throw std::invalid_argument(clip.source + ": the rate must be over 0 Hz, not " + std::to_string(clip.rate_hz));
  }
  if (!(subject.stature_m >= 0.5 && subject.stature_m <= 2.6)) {
    throw std::invalid_argument("stature must be 0.5 to 2.6 m, not " + std::to_string(subject.stature_m));
  }
  if (evidence.object && evidence.object->positions.size() != clip.frames()) {
    throw std::invalid_argument("the object '" + evidence.object->name + "' has " +
                                std::to_string(evidence.object->positions.size()) + " frames, the clip " +
                                std::to_string(clip.frames()));
  }
}

void Keeper::keep(const FrameRange& frames, Phase phase, Hands hands, const std::string& reason,
                  FoundReaches& found) const {
  const auto reject = [&](const std::string& why) {
    found.rejections.push_back({std::string(phase_name(phase)), why, frames.first, frames.last});
  };
  if (!reason.empty()) {
    reject(reason);
    return;
  }
  const std::string origin = origin_ + ':' + std::to_string(frames.first) + '-' + std::to_string(frames.last);
  try {
    found.reaches.push_back(cut_reach(clip_, frames.first, frames.last, subject_, phase, origin, options_.cut));
    found.reaches.back().hands = hands;
    found.frames.push_back(frames);
  } catch (const std::invalid_argument& refusal) {
    reject(refusal.what());
  }
}

}  // namespace reachcast
