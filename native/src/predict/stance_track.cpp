// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/stance_track.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "reachcast/posture/trunk_pose.hpp"

namespace reachcast {
namespace {

constexpr double kSmoothing_s = 0.10;

void add_to(Stance& sum, const Stance& m, double weight) {
  sum.shift += weight * m.shift;
  sum.turn_rad += weight * m.turn_rad;
  for (const std::size_t side : {0u, 1u}) sum.wrist_from_grip[side] += weight * m.wrist_from_grip[side];
}

std::vector<Stance> smoothed(const std::vector<Stance>& moments, double spacing_s) {
  const auto count = static_cast<long>(moments.size());
  const long width = std::lround(std::ceil(3.0 * kSmoothing_s / spacing_s));
  std::vector<double> weights;
  for (long k = -width; k <= width; ++k) {
    const double away = static_cast<double>(k) * spacing_s / kSmoothing_s;
    weights.push_back(std::exp(-0.5 * away * away));
  }
  const double whole = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::vector<Stance> out(moments.size());
  for (long i = 0; i < count; ++i) {
    for (long k = -width; k <= width; ++k) {
      const Stance& moment = moments[static_cast<std::size_t>(std::clamp(i + k, 0L, count - 1))];
      add_to(out[static_cast<std::size_t>(i)], moment, weights[static_cast<std::size_t>(k + width)] / whole);
    }
  }
  return out;
}

}  // namespace

StanceTrack::StanceTrack(const std::vector<Stance>& moments, double spacing_s)
    : smooth_(smoothed(moments, spacing_s)), spacing_s_(spacing_s) {}

void StanceTrack::add(const std::vector<Stance>& changes) {
  const std::vector<Stance> smooth = smoothed(changes, spacing_s_);
  for (std::size_t i = 0; i < smooth_.size(); ++i) add_to(smooth_[i], smooth[i], 1.0);
}

Stance StanceTrack::at(double time_s) const {
  const auto last = static_cast<long>(smooth_.size()) - 1;
  const double place = std::clamp(time_s / spacing_s_, 0.0, static_cast<double>(last));
  const long before = std::min(static_cast<long>(place), last - 1);
  const double t = place - static_cast<double>(before);
  const auto node = [&](long i) { return smooth_[static_cast<std::size_t>(std::clamp(i, 0L, last))]; };
  const std::array<double, 4> weights = cubic_weights(t);
  Stance out;
  for (long k = 0; k < 4; ++k) add_to(out, node(before - 1 + k), weights[static_cast<std::size_t>(k)]);
  return out;
}

}  // namespace reachcast
