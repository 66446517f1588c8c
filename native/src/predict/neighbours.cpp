// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace reachcast {
namespace {

constexpr double kOtherEnd = 0.25;  // weight of the distance at the other end of the motion

double square(const Vec3& v) {
  return glm::dot(v, v);
}

/// A motion that is not left out.
struct Candidate {
  double task = 0.0;      ///< square of the task's distance
  std::uint32_t at = 0;   ///< in the columns
  std::size_t score = 0;  ///< rank sum
};

std::vector<Candidate> candidates_of(const PhaseColumns& columns, const Query& query, End end, const LeftOut& left_out,
                                     const MotionTable& table) {
  const double home_weight = end == End::home ? 1.0 : kOtherEnd * kOtherEnd;
  const double target_weight = end == End::target ? 1.0 : kOtherEnd * kOtherEnd;
  std::vector<Candidate> out;
  out.reserve(columns.size());
  for (std::uint32_t i = 0; i < columns.size(); ++i) {
    if (left_out && left_out(table.motions()[columns.rows[i]])) continue;
    const double task =
        home_weight * square(columns.home[i] - query.home) + target_weight * square(columns.target[i] - query.target);
    out.push_back({task, i, 0});
  }
  return out;
}

std::vector<double> sorted_statures(const PhaseColumns& columns, const std::vector<Candidate>& candidates) {
  std::vector<double> out;
  out.reserve(candidates.size());
  for (const Candidate& c : candidates) out.push_back(columns.stature_m[c.at]);
  std::sort(out.begin(), out.end());
  return out;
}

/// How many statures are nearer to `wanted` than `stature` is. They fall towards it from below and rise from above.
std::size_t stature_rank(const std::vector<double>& sorted, double stature, double wanted) {
  const double away = std::abs(stature - wanted);
  const auto middle = std::lower_bound(sorted.begin(), sorted.end(), wanted);
  const auto first =
      std::partition_point(sorted.begin(), middle, [&](double s) { return std::abs(s - wanted) >= away; });
  const auto last = std::partition_point(middle, sorted.end(), [&](double s) { return std::abs(s - wanted) < away; });
  return static_cast<std::size_t>(last - first);
}

bool has_smaller_score(const Candidate& a, const Candidate& b) {
  return a.score != b.score ? a.score < b.score : a.at < b.at;
}

/// Brings the `count` candidates with the smallest rank sums to the front, without ranking all: who is farther by the
/// task alone than the best are by both ranks needs no second look.
void bring_nearest_to_front(std::vector<Candidate>& candidates, std::size_t count,
                            const std::function<std::size_t(const Candidate&)>& rank_by_stature) {
  const auto nearer = [](const Candidate& a, const Candidate& b) { return a.task < b.task; };
  const std::size_t all = candidates.size();
  // The k-th smallest sum of two independent ranks among n is about sqrt(2 k n).
  auto looked_at = static_cast<std::size_t>(2.0 * std::sqrt(2.0 * static_cast<double>(count * all))) + count;
  for (;; looked_at *= 2) {
    looked_at = std::min(looked_at, all);
    const auto end = candidates.begin() + static_cast<std::ptrdiff_t>(looked_at);
    if (looked_at < all) std::nth_element(candidates.begin(), end - 1, candidates.end(), nearer);
    std::sort(candidates.begin(), end, nearer);
    std::size_t rank = 0;
    for (std::size_t i = 0; i < looked_at; ++i) {
      if (candidates[i].task > candidates[rank].task) rank = i;
      candidates[i].score = rank + rank_by_stature(candidates[i]);
    }
    const auto last = candidates.begin() + static_cast<std::ptrdiff_t>(count) - 1;
    std::partial_sort(candidates.begin(), last + 1, end, has_smaller_score);
    if (looked_at == all || last->score < rank) return;
  }
}

}  // namespace

std::vector<Neighbour> nearest_motions(const MotionTable& table, const Query& query, End end, int k,
                                       const LeftOut& left_out) {
  if (k < 1) throw std::invalid_argument("k is " + std::to_string(k) + "; it must be at least 1");
  const PhaseColumns& columns = table.of(query.phase);
  std::vector<Candidate> candidates = candidates_of(columns, query, end, left_out, table);
  if (candidates.empty()) {
    throw std::invalid_argument("the corpus holds " + std::to_string(table.motions().size()) +
                                " motions and none of phase " + std::string(phase_name(query.phase)) +
                                (columns.size() > 0 ? " that is not left out" : ""));
  }
  const std::vector<double> statures = left_out ? sorted_statures(columns, candidates) : std::vector<double>();
  const std::vector<double>& sorted = left_out ? statures : columns.sorted_stature_m;
  const std::size_t count = std::min(candidates.size(), static_cast<std::size_t>(k));
  bring_nearest_to_front(candidates, count, [&](const Candidate& c) {
    return stature_rank(sorted, columns.stature_m[c.at], query.stature_m);
  });
  std::vector<Neighbour> nearest;
  nearest.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const MotionSummary& m = table.motions()[columns.rows[candidates[i].at]];
    nearest.push_back({m.id, m.origin, m.is_mirrored,
                       static_cast<double>(count - i) / (0.5 * static_cast<double>(count * (count + 1))),
                       glm::distance(m.target, query.target), glm::distance(m.home, query.home),
                       std::abs(m.subject.stature_m - query.stature_m)});
  }
  return nearest;
}

}  // namespace reachcast
