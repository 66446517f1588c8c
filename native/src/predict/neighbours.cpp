// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace reachcast {
namespace {

constexpr double kOtherEnd = 0.25;  // weight of the distance at the other end of the motion

/// Rank of every value, smallest 0; equal values share the smallest rank.
std::vector<std::size_t> ranks(const std::vector<double>& values) {
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::size_t> out;
  out.reserve(values.size());
  for (const double v : values) {
    out.push_back(static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), v) - sorted.begin()));
  }
  return out;
}

}  // namespace

std::vector<Neighbour> nearest_motions(std::span<const MotionSummary> motions, const Query& query, End end, int k) {
  if (k < 1) throw std::invalid_argument("k is " + std::to_string(k) + "; it must be at least 1");
  std::vector<Neighbour> candidates;
  std::vector<double> task, stature;
  for (const MotionSummary& m : motions) {
    if (m.phase != query.phase) continue;
    const double target = glm::distance(m.target, query.target), home = glm::distance(m.home, query.home);
    task.push_back(end == End::target ? std::hypot(target, kOtherEnd * home) : std::hypot(home, kOtherEnd * target));
    stature.push_back(std::abs(m.subject.stature_m - query.stature_m));
    candidates.push_back({m.id, m.origin, m.is_mirrored, 0.0, target, home, stature.back()});
  }
  if (candidates.empty()) {
    throw std::invalid_argument("the corpus holds " + std::to_string(motions.size()) + " motions and none of phase " +
                                std::string(phase_name(query.phase)));
  }
  const auto by_task = ranks(task), by_stature = ranks(stature);
  std::vector<std::size_t> order(candidates.size());
  std::iota(order.begin(), order.end(), 0);
  const auto nearer = [&](std::size_t a, std::size_t b) {
    const auto sum = [&](std::size_t i) { return by_task[i] + by_stature[i]; };
    return sum(a) != sum(b) ? sum(a) < sum(b) : candidates[a].id < candidates[b].id;
  };
  const std::size_t count = std::min(candidates.size(), static_cast<std::size_t>(k));
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(), nearer);
  std::vector<Neighbour> nearest;
  for (std::size_t i = 0; i < count; ++i) {
    nearest.push_back(candidates[order[i]]);
    nearest.back().weight = static_cast<double>(count - i) / (0.5 * static_cast<double>(count * (count + 1)));
  }
  return nearest;
}

}  // namespace reachcast
