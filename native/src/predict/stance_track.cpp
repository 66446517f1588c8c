// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/stance_track.hpp"

#include <algorithm>
#include <cmath>

namespace reachcast {
namespace {

constexpr double kSmoothing_s = 0.10;

void add(Stance& sum, const Stance& m, double weight) {
  sum.shift += weight * m.shift;
  sum.turn_rad += weight * m.turn_rad;
  for (const std::size_t side : {0u, 1u}) sum.wrist_from_grip[side] += weight * m.wrist_from_grip[side];
}

}  // namespace

StanceTrack::StanceTrack(const std::vector<Stance>& moments, double spacing_s) : spacing_s_(spacing_s) {
  const auto count = static_cast<long>(moments.size());
  const long width = std::lround(std::ceil(3.0 * kSmoothing_s / spacing_s));
  const auto weight_of = [&](long k) {
    const double away = static_cast<double>(k) * spacing_s / kSmoothing_s;
    return std::exp(-0.5 * away * away);
  };
  for (long i = 0; i < count; ++i) {
    Stance mean;
    double whole = 0.0;
    for (long k = -width; k <= width; ++k) whole += weight_of(k);
    for (long k = -width; k <= width; ++k) {
      add(mean, moments[static_cast<std::size_t>(std::clamp(i + k, 0L, count - 1))], weight_of(k) / whole);
    }
    smooth_.push_back(mean);
  }
}

Stance StanceTrack::at(double time_s) const {
  const auto last = static_cast<long>(smooth_.size()) - 1;
  const double place = std::clamp(time_s / spacing_s_, 0.0, static_cast<double>(last));
  const long before = std::min(static_cast<long>(place), last - 1);
  const double t = place - static_cast<double>(before);
  const auto node = [&](long i) { return smooth_[static_cast<std::size_t>(std::clamp(i, 0L, last))]; };
  // Catmull-Rom weights of the four nodes around the moment.
  const std::array<double, 4> weights{0.5 * t * (-1.0 + t * (2.0 - t)), 1.0 + 0.5 * t * t * (3.0 * t - 5.0),
                                      0.5 * t * (1.0 + t * (4.0 - 3.0 * t)), 0.5 * t * t * (t - 1.0)};
  Stance out;
  for (long k = 0; k < 4; ++k) add(out, node(before - 1 + k), weights[static_cast<std::size_t>(k)]);
  return out;
}

}  // namespace reachcast
