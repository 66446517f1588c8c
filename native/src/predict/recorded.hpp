// SPDX-License-Identifier: GPL-3.0-or-later
/// All transfers of a corpus with their codes in memory, and what belongs together among them.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "reachcast/corpus/corpus.hpp"
#include "reachcast/predict/cross_validate.hpp"
#include "reachcast/predict/similarity.hpp"

namespace reachcast {

struct Recorded {
  std::shared_ptr<const MotionTable> table;
  std::vector<StoredMotion> codes;       ///< by position in the columns of the phase
  std::vector<std::uint32_t> originals;  ///< positions of those that are no mirror images
  std::map<std::int64_t, std::vector<std::uint32_t>> of_subject;
  std::map<std::string, std::vector<std::uint32_t>> of_origin;  ///< a motion and its mirror image

  /// Throws std::invalid_argument where the codes are of another version, or there are none.
  explicit Recorded(const Corpus& corpus);

  [[nodiscard]] const PhaseColumns& columns() const { return table->of(Phase::transfer); }
  [[nodiscard]] const MotionSummary& motion(std::uint32_t at) const { return table->motions()[columns().rows[at]]; }
  [[nodiscard]] Query query(std::uint32_t at) const;
};

/// What is drawn together in a bootstrap, and the draws, the same for all that is summed up with it.
struct Groups {
  std::size_t count;
  std::vector<std::uint32_t> of;  ///< by number of the error
  Resamples resamples;

  /// Errors with equal keys are one group. At least one key.
  Groups(const std::vector<std::int64_t>& keys, std::uint64_t seed);
};

/// Median, quartiles and bootstrap of the errors, one for each key of the groups. `medians`: those of the resamples.
[[nodiscard]] ErrorSummary summary_of(const std::vector<double>& errors, const Groups& groups,
                                      std::vector<double>& medians);

}  // namespace reachcast
