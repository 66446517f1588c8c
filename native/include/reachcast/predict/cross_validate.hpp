// SPDX-License-Identifier: GPL-3.0-or-later
/// How well motions are predicted that were not learned from, and how much people vary (Faraway 2004, section 5).
///
/// The measure is the same for both: the mean over time and the paper's 23 joints of the distance between two motions
/// on one body, of the proportions of the subject's stature "as the practical user would have them", from the same home
/// to the same target (p. 549). Neither depends on the number of threads (0: as many as the machine has).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "reachcast/corpus/corpus.hpp"
#include "reachcast/predict/bootstrap.hpp"
#include "reachcast/predict/scheme.hpp"

namespace reachcast {

enum class LeaveOut {
  motion,   ///< the motion and its mirror image
  subject,  ///< everything of its subject
};

inline constexpr std::uint64_t kBootstrapSeed = 2004;
inline constexpr std::size_t kBootstrapTimes = 1000;

/// Of distances in metres.
struct ErrorSummary {
  double median_m = 0.0, lower_quartile_m = 0.0, upper_quartile_m = 0.0;
  Interval95 median_interval_m;  ///< 95 %, by bootstrap of `groups`
  std::size_t groups = 0;        ///< what was resampled: subjects, or motions where single motions were left out
};

struct SchemeError {
  Scheme scheme;
  std::size_t motions = 0;       ///< predicted
  std::size_t out_of_reach = 0;  ///< not predicted: what its own code gives cannot be held on a body of that stature,
                                 ///< or there are no published proportions for it
  std::size_t failed = 0;        ///< of `motions`: predictions that cannot be held; they count as infinitely wrong
  ErrorSummary error;
  bool is_best = false;  ///< smallest median, the first of equal ones
  /// Of how far its median lies above that of the best, 95 %, in the same resamples: where it begins at 0 or below, the
  /// recordings cannot tell the two apart.
  Interval95 behind_best_m;
};

struct CrossValidation {
  LeaveOut leave_out = LeaveOut::motion;
  std::uint64_t seed = kBootstrapSeed;
  unsigned threads = 0;
};

/// Predicts every transfer of the corpus that is not a mirror image from the others and compares with what its own code
/// gives ("the motion derived from the parameters of the left out motion"). A scheme that compares durations is given
/// the motion's own. One row per scheme, in their order. Throws std::invalid_argument for no schemes, when nothing is
/// left to learn from, and for a scheme that check() refuses.
[[nodiscard]] std::vector<SchemeError> cross_validate(const Corpus& corpus, std::span<const Scheme> schemes,
                                                      const CrossValidation& options = {});

/// How wrong the prediction of one motion is that was left out.
struct LeftOutError {
  std::int64_t motion_id = 0;
  double error_m = 0.0;  ///< infinite where the prediction cannot be held
};

/// What cross_validate takes the median of, for one scheme: motion by motion, ascending by id. Motions that are out of
/// reach are missing. Throws as cross_validate does.
[[nodiscard]] std::vector<LeftOutError> left_out_errors(const Corpus& corpus, const Scheme& scheme,
                                                        const CrossValidation& options = {});

/// How far replicates are from one another: one person's transfers whose homes, and whose targets, lie within
/// `within_m`. Each serves as the prediction of the other; a pair is the mean of the two distances.
struct NaturalVariation {
  std::size_t pairs = 0;
  std::size_t out_of_reach = 0;  ///< pairs of which neither way can be held
  ErrorSummary error;            ///< by bootstrap of subjects; zeros where there are no pairs
};
[[nodiscard]] NaturalVariation natural_variation(const Corpus& corpus, double within_m = 0.05,
                                                 std::uint64_t seed = kBootstrapSeed, unsigned threads = 0);

}  // namespace reachcast
