// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "reachcast/predict/cross_validate.hpp"
#include "reachcast/predict/parallel.hpp"
#include "reachcast/predict/replay.hpp"
#include "recorded.hpp"

namespace reachcast {
namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;

std::vector<Pair> replicates_of(const Recorded& recorded, double within_m) {
  const auto near = [&](const Vec3& a, const Vec3& b) { return glm::distance(a, b) <= within_m; };
  std::vector<Pair> pairs;
  for (const auto& [subject, positions] : recorded.of_subject) {
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const MotionSummary& a = recorded.motion(positions[i]);
      for (std::size_t j = i + 1; j < positions.size() && !a.is_mirrored; ++j) {
        const MotionSummary& b = recorded.motion(positions[j]);
        if (!b.is_mirrored && near(a.home, b.home) && near(a.target, b.target)) {
          pairs.emplace_back(positions[i], positions[j]);
        }
      }
    }
  }
  return pairs;
}

/// Error of the one motion as a prediction of the other; not a number where one of them cannot be held.
double error_as_prediction(const Recorded& recorded, std::uint32_t model, std::uint32_t wanted) {
  const std::optional<Replay> replay = Replay::of(recorded.motion(wanted));
  ReplayPostures truth, guess;
  Blend blend;
  const WeightedCode only{&recorded.codes[model].code, 1.0};
  blend_codes({&only, 1}, {}, recorded.query(wanted), Average::coordinates, blend);
  if (!replay || !replay->perform(recorded.codes[wanted].code, PathForm::deviation, truth) ||
      !replay->perform(blend, PathForm::deviation, guess)) {
    return kMissing;
  }
  return mean_distance(truth, guess);
}

}  // namespace

NaturalVariation natural_variation(const Corpus& corpus, double within_m, std::uint64_t seed, unsigned threads) {
  if (!(within_m >= 0.0 && within_m <= 1.0)) {
    std::ostringstream out;
    out << "within is " << within_m << " m; it must lie between 0 and 1 m";
    throw std::invalid_argument(out.str());
  }
  const Recorded recorded(corpus);
  const std::vector<Pair> pairs = replicates_of(recorded, within_m);
  std::vector<double> found(pairs.size());
  for_each_number(pairs.size(), threads, [&](std::size_t i) {
    const double there = error_as_prediction(recorded, pairs[i].first, pairs[i].second);
    const double back = error_as_prediction(recorded, pairs[i].second, pairs[i].first);
    found[i] = std::isnan(there) ? back : std::isnan(back) ? there : 0.5 * (there + back);
  });
  NaturalVariation variation;
  std::vector<double> errors;
  std::vector<std::int64_t> subjects;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (std::isnan(found[i])) {
      ++variation.out_of_reach;
      continue;
    }
    errors.push_back(found[i]);
    subjects.push_back(recorded.motion(pairs[i].first).subject_id);
  }
  variation.pairs = errors.size();
  std::vector<double> medians;
  if (!errors.empty()) variation.error = summary_of(errors, Groups(subjects, seed), medians);
  return variation;
}

}  // namespace reachcast
