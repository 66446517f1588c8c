// SPDX-License-Identifier: GPL-3.0-or-later
/// How far a median could have come out otherwise: the bootstrap's percentile interval (Efron 1979), the same on every
/// machine.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace reachcast {

/// Of rising values, at least one; q in [0, 1], linear between them (type 7 of Hyndman & Fan 1996). May be infinite.
[[nodiscard]] double quantile(std::span<const double> rising, double q);

/// Whole groups drawn with replacement, as many as there are: how often each was drawn, many times over.
class Resamples {
 public:
  /// groups >= 1.
  Resamples(std::size_t groups, std::size_t times, std::uint64_t seed);

  [[nodiscard]] std::size_t times() const { return times_; }
  [[nodiscard]] std::span<const std::uint32_t> counts(std::size_t time) const {
    return std::span(counts_).subspan(time * groups_, groups_);
  }

 private:
  std::size_t groups_, times_;
  std::vector<std::uint32_t> counts_;
};

struct Interval95 {
  double low = 0.0, high = 0.0;
};

/// The median of each resample. values: at least one; group_of: the group that each value is drawn with, each group
/// with at least one value.
[[nodiscard]] std::vector<double> resampled_medians(std::span<const double> values,
                                                    std::span<const std::uint32_t> group_of,
                                                    const Resamples& resamples);

/// From the 2.5 % to the 97.5 % quantile. At least one value.
[[nodiscard]] Interval95 percentile_interval(std::vector<double> values);

}  // namespace reachcast
