// SPDX-License-Identifier: GPL-3.0-or-later
#include "recorded.hpp"

#include <algorithm>
#include <stdexcept>

#include "reachcast/motion/encode.hpp"

namespace reachcast {

Recorded::Recorded(const Corpus& corpus) : table(corpus.table()) {
  std::vector<std::int64_t> ids;
  for (std::uint32_t at = 0; at < columns().size(); ++at) {
    const MotionSummary& m = motion(at);
    ids.push_back(m.id);
    if (!m.is_mirrored) originals.push_back(at);
    of_subject[m.subject_id].push_back(at);
    of_origin[m.origin].push_back(at);
  }
  if (originals.empty()) {
    throw std::invalid_argument("the corpus " + corpus.path().string() + " holds no transfer that could be predicted");
  }
  codes = corpus.load(ids);
  if (codes.front().code.coefficients.size() != code_length()) {
    throw std::invalid_argument(
        "the motions of the corpus have " + std::to_string(codes.front().code.coefficients.size()) +
        " coefficients; this version needs " + std::to_string(code_length()) + ": import the recordings again");
  }
}

Query Recorded::query(std::uint32_t at) const {
  const MotionSummary& m = motion(at);
  return {Phase::transfer, m.home, m.target, m.subject, m.duration_s};
}

namespace {

std::vector<std::int64_t> each_once(std::vector<std::int64_t> keys) {
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

}  // namespace

Groups::Groups(const std::vector<std::int64_t>& keys, std::uint64_t seed)
    : count(each_once(keys).size()), resamples(count, kBootstrapTimes, seed) {
  const std::vector<std::int64_t> once = each_once(keys);
  for (const std::int64_t key : keys) {
    of.push_back(static_cast<std::uint32_t>(std::lower_bound(once.begin(), once.end(), key) - once.begin()));
  }
}

ErrorSummary summary_of(const std::vector<double>& errors, const Groups& groups, std::vector<double>& medians) {
  std::vector<double> rising = errors;
  std::sort(rising.begin(), rising.end());
  medians = resampled_medians(errors, groups.of, groups.resamples);
  return {.median_m = quantile(rising, 0.5),
          .lower_quartile_m = quantile(rising, 0.25),
          .upper_quartile_m = quantile(rising, 0.75),
          .median_interval_m = percentile_interval(medians),
          .groups = groups.count};
}

}  // namespace reachcast
