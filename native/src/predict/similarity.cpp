// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/similarity.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "reachcast/predict/smoothing.hpp"

namespace reachcast {
namespace {

constexpr double kOtherEnd = 0.25;  // weight of the distance at the other end of the motion
constexpr double kNoSpread = 1e-6;  // metres, years, kilograms: what differs less must not become a divisor

EndWeights weights_of(End end) {
  if (end == End::both) return {1.0, 1.0};
  constexpr double other = kOtherEnd * kOtherEnd;
  return end == End::home ? EndWeights{1.0, other} : EndWeights{other, 1.0};
}

double or_one(double spread) {
  return spread > kNoSpread ? spread : 1.0;
}

/// What is added to a phase's name when not both hands work.
std::string with_hands(Hands hands) {
  return hands == Hands::both ? "" : " with the " + std::string(hands_name(hands)) + " hand";
}

/// How many of the values are nearer to `wanted` than `away`. They fall towards it from below and rise from above.
std::size_t count_nearer(const std::vector<double>& sorted, double wanted, double away) {
  const auto middle = std::lower_bound(sorted.begin(), sorted.end(), wanted);
  const auto first =
      std::partition_point(sorted.begin(), middle, [&](double s) { return std::abs(s - wanted) >= away; });
  const auto last = std::partition_point(middle, sorted.end(), [&](double s) { return std::abs(s - wanted) < away; });
  return static_cast<std::size_t>(last - first);
}

/// The k smallest scores seen, equal ones by position.
class Best {
 public:
  explicit Best(std::size_t k) : k_(k) {}

  [[nodiscard]] bool is_full() const { return heap_.size() == k_; }
  [[nodiscard]] double worst() const { return heap_.front().first; }

  void offer(double score, std::uint32_t at) {
    const std::pair<double, std::uint32_t> candidate{score, at};
    if (!is_full()) {
      heap_.push_back(candidate);
      std::push_heap(heap_.begin(), heap_.end());
    } else if (candidate < heap_.front()) {
      std::pop_heap(heap_.begin(), heap_.end());
      heap_.back() = candidate;
      std::push_heap(heap_.begin(), heap_.end());
    }
  }

  [[nodiscard]] std::vector<std::uint32_t> in_order() && {
    std::sort_heap(heap_.begin(), heap_.end());
    std::vector<std::uint32_t> positions;
    positions.reserve(heap_.size());
    for (const auto& [score, at] : heap_) positions.push_back(at);
    return positions;
  }

 private:
  std::size_t k_;
  std::vector<std::pair<double, std::uint32_t>> heap_;  ///< largest on top
};

}  // namespace

/// A scheme and an end, resolved for the query.
struct Search::Comparison {
  struct Part {
    const std::vector<double>*values, *sorted, *left_out;
    double wanted = 0.0, scale = 1.0;
    KnownRanks* known = nullptr;
  };
  std::vector<Part> parts;                                   ///< by trait
  double too_far = std::numeric_limits<double>::infinity();  ///< difference of the first part that rules a motion out
  double task_scale = 1.0;

  /// Number of motions that are nearer by this trait; the middle for an unknown value.
  [[nodiscard]] static std::size_t rank(const Part& part, std::uint32_t at) {
    const double value = (*part.values)[at];
    if (std::isnan(value)) return (part.sorted->size() - part.left_out->size()) / 2;
    const std::size_t place = (std::bit_cast<std::uint64_t>(value) * 0x9E3779B97F4A7C15U >> 32) % KnownRanks::kPlaces;
    if (part.known->value[place] == value) return part.known->rank[place];
    const double away = std::abs(value - part.wanted);
    const std::size_t rank =
        count_nearer(*part.sorted, part.wanted, away) - count_nearer(*part.left_out, part.wanted, away);
    part.known->value[place] = value;
    part.known->rank[place] = static_cast<std::uint32_t>(rank);
    return rank;
  }

  [[nodiscard]] double rank_sum(std::uint32_t at, std::size_t task_rank) const {
    std::size_t sum = task_rank;
    for (const Part& part : parts) sum += rank(part, at);
    return static_cast<double>(sum);
  }

  [[nodiscard]] bool is_too_far(std::uint32_t at) const {
    return !parts.empty() && std::abs((*parts[0].values)[at] - parts[0].wanted) >= too_far;  // false where unknown
  }

  /// The task's rank never falls from now on, and the worst of the best never rises: whoever differs as much by the
  /// first trait as one that this trait and the task alone rule out needs no second look.
  void rule_out(std::uint32_t at, std::size_t task_rank, double worst) {
    if (parts.empty() || std::isnan((*parts[0].values)[at])) return;
    if (static_cast<double>(task_rank + rank(parts[0], at)) <= worst) return;
    too_far = std::min(too_far, std::abs((*parts[0].values)[at] - parts[0].wanted));
  }

  [[nodiscard]] double scaled_task(double squared_distance) const {
    return squared_distance / (task_scale * task_scale);
  }

  [[nodiscard]] double squared_sum(std::uint32_t at, double scaled_task_distance) const {
    double sum = scaled_task_distance;
    for (const Part& part : parts) {
      const double value = (*part.values)[at];
      const double away = std::isnan(value) ? 1.0 : (value - part.wanted) / part.scale;
      sum += away * away;
    }
    return sum;
  }
};

Search::Search(const MotionTable& table, const Query& query, std::vector<std::uint32_t> left_out)
    : columns_(table.of(query.phase, query.hands)),
      query_(query),
      wanted_(traits_of(query.subject, query.duration_s.value_or(kMissing))),
      left_out_(std::move(left_out)) {
  if (columns_.size() == left_out_.size()) {
    throw std::invalid_argument("the corpus holds " + std::to_string(table.motions().size()) +
                                " motions and none of phase " + std::string(phase_name(query.phase)) +
                                with_hands(query.hands) + (columns_.size() > 0 ? " that is not left out" : ""));
  }
  if (left_out_.empty()) return;
  is_left_out_.resize(columns_.size(), false);
  std::vector<std::uint32_t> originals;
  for (const std::uint32_t at : left_out_) {
    is_left_out_[at] = true;
    if (!columns_.is_mirrored[at]) originals.push_back(at);
  }
  missing_ = Pool(columns_, left_out_);
  missing_originals_ = Pool(columns_, originals);
}

bool Search::takes_part(std::uint32_t at, bool mirrored) const {
  return (mirrored || !columns_.is_mirrored[at]) && (is_left_out_.empty() || !is_left_out_[at]);
}

std::size_t Search::count(bool mirrored) const {
  return columns_.pool(mirrored).size - missing(mirrored).size;
}

double Search::squared_task_distance_of(std::uint32_t at, End end) const {
  const Vec3 home = columns_.home[at] - query_.home, target = columns_.target[at] - query_.target;
  return squared_task_distance({home.x, home.y, home.z, target.x, target.y, target.z}, weights_of(end));
}

Search::Comparison Search::comparison(const Scheme& scheme, End end) {
  check(scheme);
  if (scheme.uses(Trait::duration) && !query_.duration_s) {
    throw std::invalid_argument("the scheme compares durations; then the duration must be given");
  }
  if (count(scheme.mirrored) == 0) {
    throw std::invalid_argument("the corpus holds only mirror images of phase " +
                                std::string(phase_name(query_.phase)) + with_hands(query_.hands) +
                                " and the scheme takes none");
  }
  const Pool &pool = columns_.pool(scheme.mirrored), &out = missing(scheme.mirrored);
  const EndWeights weights = weights_of(end);
  const double home = spread(pool.home, out.home), target = spread(pool.target, out.target);
  Comparison compared;
  compared.task_scale = scheme.task_scale_m > 0.0
                            ? scheme.task_scale_m
                            : or_one(std::sqrt(weights.home * home * home + weights.target * target * target));
  for (std::size_t t = 0; t < kTraitCount; ++t) {
    if (!scheme.traits[t] || std::isnan(wanted_[t])) continue;
    const double scale = scheme.trait_scales[t];
    std::optional<KnownRanks>& known = known_ranks_[2 * t + (scheme.mirrored ? 1 : 0)];
    if (!known) known.emplace();
    compared.parts.push_back({&columns_.traits[t], &pool.sorted[t], &out.sorted[t], wanted_[t],
                              scale > 0.0 ? scale : or_one(spread(pool.traits[t], out.traits[t])), &*known});
  }
  if (!scheme.task && compared.parts.empty()) {
    throw std::invalid_argument("the scheme compares nothing that is known of the subject");
  }
  return compared;
}

/// The motion with this number in the order of the task's distance, or null after the last.
const Search::TaskOrder::Step* Search::step(End end, bool mirrored, std::size_t number) {
  std::optional<TaskOrder>& order = orders_[2 * static_cast<std::size_t>(end) + (mirrored ? 1 : 0)];
  if (!order) order.emplace(TaskOrder{TaskWalk(columns_.index, query_.home, query_.target, weights_of(end)), {}});
  std::vector<TaskOrder::Step>& steps = order->steps;
  while (steps.size() <= number) {
    const std::optional<TaskWalk::Step> next = order->walk.next();
    if (!next) return nullptr;
    if (!takes_part(next->at, mirrored)) continue;
    const bool ties = !steps.empty() && steps.back().squared_distance == next->squared_distance;
    steps.push_back({next->at, next->squared_distance, ties ? steps.back().rank : steps.size()});
  }
  return &steps[number];
}

std::vector<std::uint32_t> Search::nearest(const Scheme& scheme, End end) {
  Comparison compared = comparison(scheme, end);
  const bool by_rank = scheme.measure == Measure::ranks;
  Best best(std::min(count(scheme.mirrored), static_cast<std::size_t>(scheme.k)));
  const auto look_at = [&](std::uint32_t at, std::size_t task_rank, double scaled_task) {
    if (by_rank && compared.is_too_far(at)) return;
    const double score = by_rank ? compared.rank_sum(at, task_rank) : compared.squared_sum(at, scaled_task);
    if (by_rank && best.is_full() && score > best.worst()) compared.rule_out(at, task_rank, best.worst());
    best.offer(score, at);
  };
  if (!scheme.task) {
    for (std::uint32_t at = 0; at < columns_.size(); ++at) {
      if (takes_part(at, scheme.mirrored)) look_at(at, 0, 0.0);
    }
    return std::move(best).in_order();
  }
  for (std::size_t number = 0; const TaskOrder::Step* near = step(end, scheme.mirrored, number); ++number) {
    const double scaled_task = compared.scaled_task(near->squared_distance);
    // The other parts only add to the task's.
    if (best.is_full() && best.worst() < (by_rank ? static_cast<double>(near->rank) : scaled_task)) break;
    look_at(near->at, near->rank, scaled_task);
  }
  return std::move(best).in_order();
}

/// One row for each motion: differences of home, target and stature in spreads.
Eigen::MatrixXd Search::offsets(std::span<const std::uint32_t> motions, bool mirrored) const {
  const Pool &pool = columns_.pool(mirrored), &out = missing(mirrored);
  const double home = or_one(spread(pool.home, out.home)), target = or_one(spread(pool.target, out.target));
  const double stature = or_one(spread(pool.traits[0], out.traits[0]));
  Eigen::MatrixXd x(static_cast<Eigen::Index>(motions.size()), 7);
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const std::uint32_t at = motions[static_cast<std::size_t>(i)];
    x.row(i).head<3>() = to_eigen((columns_.home[at] - query_.home) / home);
    x.row(i).segment<3>(3) = to_eigen((columns_.target[at] - query_.target) / target);
    x(i, 6) = (columns_.traits[0][at] - wanted_[0]) / stature;
  }
  return x;
}

std::vector<Share> Search::shares(const Scheme& scheme, End end, std::span<const std::uint32_t> nearest) {
  std::vector<double> weights;
  if (scheme.smoother == Smoother::uniform) weights = uniform_weights(nearest.size());
  if (scheme.smoother == Smoother::triangular) weights = triangular_weights(nearest.size());
  if (scheme.smoother == Smoother::kernel || scheme.smoother == Smoother::linear) {
    const Comparison compared = comparison(scheme, end);
    std::vector<double> squared;
    for (const std::uint32_t at : nearest) {
      const double by_task = scheme.task ? compared.scaled_task(squared_task_distance_of(at, end)) : 0.0;
      squared.push_back(compared.squared_sum(at, by_task));
    }
    weights = kernel_weights(squared, scheme.bandwidth);
  }
  if (scheme.smoother == Smoother::linear) {
    weights = local_line_weights(weights, offsets(nearest, scheme.mirrored), scheme.ridge);
  }
  std::vector<Share> shares;
  for (std::size_t i = 0; i < nearest.size(); ++i) shares.push_back({nearest[i], weights[i]});
  return shares;
}

}  // namespace reachcast
