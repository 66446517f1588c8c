// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/bootstrap.hpp"

#include <algorithm>
#include <numeric>
#include <random>

namespace reachcast {
namespace {

/// Below `limit`, every number alike. The distributions of <random> differ between libraries; its engines do not.
std::size_t below(std::mt19937_64& random, std::size_t limit) {
  const std::uint64_t most = std::mt19937_64::max() - std::mt19937_64::max() % limit;
  for (;;) {
    const std::uint64_t drawn = random();
    if (drawn < most) return static_cast<std::size_t>(drawn % limit);
  }
}

double between(double low, double high, double share) {
  return share == 0.0 || low == high ? low : low + share * (high - low);  // no infinity less infinity
}

/// The median of the values, each as often as its group was drawn. `order`: from the smallest value to the largest.
double median_of(std::span<const double> values, std::span<const std::uint32_t> group_of,
                 std::span<const std::uint32_t> order, std::span<const std::uint32_t> counts) {
  std::size_t all = 0;
  for (const std::uint32_t group : group_of) all += counts[group];
  const std::size_t lower = (all - 1) / 2, upper = all / 2;
  std::size_t seen = 0;
  double low = 0.0;
  bool has_low = false;
  for (const std::uint32_t i : order) {
    seen += counts[group_of[i]];
    if (!has_low && seen > lower) low = values[i], has_low = true;
    if (seen > upper) return between(low, values[i], 0.5);
  }
  return low;
}

}  // namespace

double quantile(std::span<const double> rising, double q) {
  const double at = q * static_cast<double>(rising.size() - 1);
  const auto lower = static_cast<std::size_t>(at);
  return between(rising[lower], rising[std::min(lower + 1, rising.size() - 1)], at - static_cast<double>(lower));
}

Resamples::Resamples(std::size_t groups, std::size_t times, std::uint64_t seed)
    : groups_(groups), times_(times), counts_(groups * times, 0) {
  std::mt19937_64 random(seed);
  for (std::size_t time = 0; time < times; ++time) {
    for (std::size_t draw = 0; draw < groups; ++draw) ++counts_[time * groups + below(random, groups)];
  }
}

std::vector<double> resampled_medians(std::span<const double> values, std::span<const std::uint32_t> group_of,
                                      const Resamples& resamples) {
  std::vector<std::uint32_t> order(values.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return values[a] < values[b]; });
  std::vector<double> medians;
  medians.reserve(resamples.times());
  for (std::size_t time = 0; time < resamples.times(); ++time) {
    medians.push_back(median_of(values, group_of, order, resamples.counts(time)));
  }
  return medians;
}

Interval95 percentile_interval(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {quantile(values, 0.025), quantile(values, 0.975)};
}

}  // namespace reachcast
