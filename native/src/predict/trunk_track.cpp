// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/trunk_track.hpp"

#include <algorithm>
#include <cmath>

namespace reachcast {
namespace {

constexpr double kSmoothing_s = 0.08;

TrunkMotion scaled(const TrunkMotion& m, double by) {
  return {m.shift * by, m.turn_rad * by};
}
TrunkMotion sum(const TrunkMotion& a, const TrunkMotion& b) {
  return {a.shift + b.shift, a.turn_rad + b.turn_rad};
}

}  // namespace

TrunkTrack::TrunkTrack(const std::vector<TrunkMotion>& moments, double spacing_s) : spacing_s_(spacing_s) {
  const auto count = static_cast<long>(moments.size());
  const long width = std::lround(std::ceil(3.0 * kSmoothing_s / spacing_s));
  for (long i = 0; i < count; ++i) {
    TrunkMotion mean;
    double whole = 0.0;
    for (long k = -width; k <= width; ++k) {
      const double away = static_cast<double>(k) * spacing_s / kSmoothing_s, weight = std::exp(-0.5 * away * away);
      mean = sum(mean, scaled(moments[static_cast<std::size_t>(std::clamp(i + k, 0L, count - 1))], weight));
      whole += weight;
    }
    smooth_.push_back(scaled(mean, 1.0 / whole));
  }
}

TrunkMotion TrunkTrack::at(double time_s) const {
  const auto last = static_cast<long>(smooth_.size()) - 1;
  const double place = std::clamp(time_s / spacing_s_, 0.0, static_cast<double>(last));
  const long before = std::min(static_cast<long>(place), last - 1);
  const double t = place - static_cast<double>(before);
  const auto node = [&](long i) { return smooth_[static_cast<std::size_t>(std::clamp(i, 0L, last))]; };
  // Catmull-Rom weights of the four nodes around the moment.
  const std::array<double, 4> weights{0.5 * t * (-1.0 + t * (2.0 - t)), 1.0 + 0.5 * t * t * (3.0 * t - 5.0),
                                      0.5 * t * (1.0 + t * (4.0 - 3.0 * t)), 0.5 * t * t * (t - 1.0)};
  TrunkMotion out;
  for (long k = 0; k < 4; ++k) out = sum(out, scaled(node(before - 1 + k), weights[static_cast<std::size_t>(k)]));
  return out;
}

}  // namespace reachcast
