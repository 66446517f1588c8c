// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/cross_validate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "reachcast/predict/parallel.hpp"
#include "reachcast/predict/replay.hpp"
#include "recorded.hpp"

namespace reachcast {
namespace {

constexpr double kFailed = std::numeric_limits<double>::infinity();

/// Schemes that order motions alike share one search: the neighbours of a smaller k come first among those of a larger.
struct Selections {
  std::vector<Scheme> schemes;  ///< each with the largest k
  std::vector<std::size_t> of;  ///< by number of the scheme

  explicit Selections(std::span<const Scheme> all) {
    std::vector<Scheme> keys;
    for (const Scheme& scheme : all) {
      Scheme key = scheme;
      key.k = 1;
      key.sets = scheme.effective_sets();
      key.smoother = Scheme{}.smoother;
      key.bandwidth = Scheme{}.bandwidth;
      key.ridge = Scheme{}.ridge;
      key.paths = Scheme{}.paths;
      key.postures = Scheme{}.postures;
      const auto found = std::find(keys.begin(), keys.end(), key);
      of.push_back(static_cast<std::size_t>(found - keys.begin()));
      if (found == keys.end()) {
        keys.push_back(key);
        schemes.push_back(scheme);
      }
      schemes[of.back()].k = std::max(schemes[of.back()].k, scheme.k);
    }
  }
};

/// The sets of neighbours for both ends; where there is one set for all, the second is empty.
using BothEnds = std::array<std::vector<std::uint32_t>, 2>;
using BothShares = std::array<std::vector<Share>, 2>;

bool is_same(const BothShares& a, const BothShares& b) {
  const auto same = [](const Share& x, const Share& y) { return x.at == y.at && x.weight == y.weight; };
  return std::equal(a[0].begin(), a[0].end(), b[0].begin(), b[0].end(), same) &&
         std::equal(a[1].begin(), a[1].end(), b[1].begin(), b[1].end(), same);
}

BothEnds nearest_of(Search& search, const Scheme& selection, Sets sets) {
  if (sets == Sets::one) return {search.nearest(selection, End::both), {}};
  return {search.nearest(selection, End::home), search.nearest(selection, End::target)};
}

BothShares shares_of(Search& search, const Scheme& scheme, const BothEnds& nearest) {
  const auto first = [&](const std::vector<std::uint32_t>& all) {
    return std::span(all).first(std::min(all.size(), static_cast<std::size_t>(scheme.k)));
  };
  if (scheme.effective_sets() == Sets::one) return {search.shares(scheme, End::both, first(nearest[0])), {}};
  return {search.shares(scheme, End::home, first(nearest[0])), search.shares(scheme, End::target, first(nearest[1]))};
}

/// Every scheme's prediction of one left-out motion.
class Prediction {
 public:
  Prediction(const Recorded& recorded, std::uint32_t at, const Replay& replay, const ReplayPostures& truth)
      : recorded_(recorded), query_(recorded.query(at)), replay_(replay), truth_(truth) {}

  /// Error of a blend of these; blends that have been are not made again.
  [[nodiscard]] double error_of(const BothShares& shares, PathForm form, Average postures) {
    for (std::size_t i = 0; i < known_.size(); ++i) {
      if (manners_[i] == std::pair(form, postures) && is_same(known_[i], shares)) return errors_[i];
    }
    const std::vector<WeightedCode> at_home = codes_of(shares[0]), at_target = codes_of(shares[1]);
    blend_codes(at_home, at_target, query_, postures, blend_);
    known_.push_back(shares);
    manners_.emplace_back(form, postures);
    errors_.push_back(replay_.perform(blend_, form, guess_) ? mean_distance(truth_, guess_) : kFailed);
    return errors_.back();
  }

 private:
  [[nodiscard]] std::vector<WeightedCode> codes_of(const std::vector<Share>& shares) const {
    std::vector<WeightedCode> codes;
    for (const Share& share : shares) codes.push_back({&recorded_.codes[share.at].code, share.weight});
    return codes;
  }

  const Recorded& recorded_;
  Query query_;
  const Replay& replay_;
  const ReplayPostures& truth_;
  std::vector<BothShares> known_;
  std::vector<std::pair<PathForm, Average>> manners_;
  std::vector<double> errors_;
  Blend blend_;
  ReplayPostures guess_;
};

/// Errors by scheme; none where the motion itself cannot be performed.
std::vector<double> errors_of(const Recorded& recorded, std::uint32_t at, std::span<const Scheme> schemes,
                              const Selections& selections, LeaveOut leave_out) {
  const MotionSummary& motion = recorded.motion(at);
  Search search(
      *recorded.table, recorded.query(at),
      leave_out == LeaveOut::motion ? recorded.of_origin.at(motion.origin) : recorded.of_subject.at(motion.subject_id));
  const std::optional<Replay> replay = Replay::of(motion);
  ReplayPostures truth;
  if (!replay || !replay->perform(recorded.codes[at].code, PathForm::deviation, truth)) return {};
  std::vector<BothEnds> nearest(selections.schemes.size());
  Prediction prediction(recorded, at, *replay, truth);
  std::vector<double> errors;
  for (std::size_t s = 0; s < schemes.size(); ++s) {
    BothEnds& found = nearest[selections.of[s]];
    if (found[0].empty()) found = nearest_of(search, selections.schemes[selections.of[s]], schemes[s].effective_sets());
    errors.push_back(prediction.error_of(shares_of(search, schemes[s], found), schemes[s].paths, schemes[s].postures));
  }
  return errors;
}

/// Errors of each left-out motion by scheme.
using Errors = std::vector<std::vector<double>>;

Errors all_errors(const Recorded& recorded, std::span<const Scheme> schemes, const CrossValidation& options) {
  for (const Scheme& scheme : schemes) check(scheme);
  const Selections selections(schemes);
  Errors errors(recorded.originals.size());
  for_each_number(errors.size(), options.threads, [&](std::size_t i) {
    errors[i] = errors_of(recorded, recorded.originals[i], schemes, selections, options.leave_out);
  });
  return errors;
}

/// Motions that could not be performed are so under every scheme: all rows have the same groups.
Groups groups_of(const Recorded& recorded, const Errors& errors, const CrossValidation& options) {
  std::vector<std::int64_t> keys;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (errors[i].empty()) continue;
    const MotionSummary& motion = recorded.motion(recorded.originals[i]);
    keys.push_back(options.leave_out == LeaveOut::subject ? motion.subject_id : motion.id);
  }
  if (keys.empty()) {
    throw std::invalid_argument("no transfer of the corpus can be held on a body of its subject's stature");
  }
  return {keys, options.seed};
}

SchemeError row_of(const Scheme& scheme, std::size_t number, const Errors& errors, const Groups& groups,
                   std::vector<double>& medians) {
  std::vector<double> of_scheme;
  for (const std::vector<double>& of_motion : errors) {
    if (!of_motion.empty()) of_scheme.push_back(of_motion[number]);
  }
  return {.scheme = scheme,
          .motions = of_scheme.size(),
          .out_of_reach = errors.size() - of_scheme.size(),
          .failed = static_cast<std::size_t>(std::count(of_scheme.begin(), of_scheme.end(), kFailed)),
          .error = summary_of(of_scheme, groups, medians),
          .behind_best_m = {}};
}

/// Two medians of failed predictions are alike.
double difference(double a, double b) {
  return a == b ? 0.0 : a - b;
}

/// `medians`: of each row's resamples.
void compare_with_best(std::vector<SchemeError>& rows, const std::vector<std::vector<double>>& medians) {
  const auto has_smaller_median = [](const SchemeError& a, const SchemeError& b) {
    return a.error.median_m < b.error.median_m;
  };
  const auto best = std::min_element(rows.begin(), rows.end(), has_smaller_median);
  best->is_best = true;
  const std::vector<double>& least = medians[static_cast<std::size_t>(best - rows.begin())];
  for (std::size_t s = 0; s < rows.size(); ++s) {
    std::vector<double> behind;
    for (std::size_t i = 0; i < least.size(); ++i) behind.push_back(difference(medians[s][i], least[i]));
    rows[s].behind_best_m = percentile_interval(std::move(behind));
  }
}

}  // namespace

std::vector<SchemeError> cross_validate(const Corpus& corpus, std::span<const Scheme> schemes,
                                        const CrossValidation& options) {
  if (schemes.empty()) throw std::invalid_argument("schemes is empty; at least one is needed");
  const Recorded recorded(corpus);
  const Errors errors = all_errors(recorded, schemes, options);
  const Groups groups = groups_of(recorded, errors, options);
  std::vector<SchemeError> rows(schemes.size());
  std::vector<std::vector<double>> medians(schemes.size());
  for_each_number(rows.size(), options.threads,
                  [&](std::size_t s) { rows[s] = row_of(schemes[s], s, errors, groups, medians[s]); });
  compare_with_best(rows, medians);
  return rows;
}

std::vector<LeftOutError> left_out_errors(const Corpus& corpus, const Scheme& scheme, const CrossValidation& options) {
  const Recorded recorded(corpus);
  const Errors errors = all_errors(recorded, std::span(&scheme, 1), options);
  std::vector<LeftOutError> found;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!errors[i].empty()) found.push_back({recorded.motion(recorded.originals[i]).id, errors[i].front()});
  }
  std::sort(found.begin(), found.end(),
            [](const LeftOutError& a, const LeftOutError& b) { return a.motion_id < b.motion_id; });
  return found;
}

}  // namespace reachcast
