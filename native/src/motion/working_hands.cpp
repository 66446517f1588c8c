// SPDX-License-Identifier: GPL-3.0-or-later
#include "working_hands.hpp"

#include <algorithm>

namespace reachcast {
namespace {

constexpr double kHangs = 0.85;        // cosine of 32 degrees: shoulder to grip from the vertical
constexpr double kObjectMoves = 0.10;  // m/s
constexpr double kLeastCarry_s = 0.3;

/// Ranges in which the object is on its way.
std::vector<FrameRange> carries_of(const Points& object, double rate_hz) {
  const std::vector<double> speed = smooth_speeds(object, rate_hz);
  std::vector<FrameRange> found;
  for (std::size_t f = 0; f < speed.size(); ++f) {
    if (speed[f] < kObjectMoves) continue;
    FrameRange run{f, f};
    while (run.last + 1 < speed.size() && speed[run.last + 1] >= kObjectMoves) ++run.last;
    f = run.last;
    if (static_cast<double>(run.last - run.first) >= kLeastCarry_s * rate_hz) found.push_back(run);
  }
  return found;
}

bool hangs(const HandTracks& hands, const Clip& clip, std::size_t side, const FrameRange& range) {
  const Joint shoulder = side == 0 ? Joint::left_shoulder : Joint::right_shoulder;
  for (std::size_t f = range.first; f <= range.last; ++f) {
    const Vec3 arm = hands.grips[side][f] - clip.at(f, index(shoulder));
    if (!(-arm.z >= kHangs * glm::length(arm))) return false;
  }
  return true;
}

}  // namespace

Hands working_hands(const HandTracks& both, const Clip& clip, const Points* object, const FindOptions& options) {
  const std::vector<FrameRange> work =
      object ? carries_of(*object, both.rate_hz) : std::vector<FrameRange>{{0, both.frames() - 1}};
  if (work.empty()) return Hands::both;
  for (const Hands hands : {Hands::left, Hands::right}) {
    const Points& grip = both.grips[working_side(hands)];
    const bool works_alone = std::all_of(work.begin(), work.end(), [&](const FrameRange& range) {
      const auto away = [&](std::size_t f) { return glm::distance(grip[f], (*object)[f]); };
      return hangs(both, clip, free_side(hands), range) && !hangs(both, clip, working_side(hands), range) &&
             (!object || spread(range, away) <= options.slip_m);
    });
    if (works_alone) return hands;
  }
  return Hands::both;
}

}  // namespace reachcast
