// SPDX-License-Identifier: GPL-3.0-or-later
/// How well motions are predicted that were not learned from (Faraway 2004, section 5).
#pragma once

#include <span>
#include <vector>

#include "reachcast/corpus/corpus.hpp"

namespace reachcast {

enum class LeaveOut {
  motion,   ///< the motion and its mirror image
  subject,  ///< everything of its subject
};

/// A way of predicting that is put to the test.
struct Scheme {
  int neighbours = 5;  ///< k
};

struct SchemeError {
  Scheme scheme;
  std::size_t motions = 0;       ///< predicted
  std::size_t out_of_reach = 0;  ///< not predicted: a body of that stature cannot hold the box there, or has no
                                 ///< published proportions
  double median_m = 0.0;         ///< over motions, of the mean over time and the paper's 23 joints of the distance
  double lower_quartile_m = 0.0, upper_quartile_m = 0.0;
};

/// Predicts every transfer of the corpus that is not a mirror image from the others, on the proportions of its
/// subject's stature as a user would have them, and compares with the motion that its own code gives on that body (p.
/// 549: "the motion derived from the parameters of the left out motion"). One row per scheme. Throws
/// std::invalid_argument when nothing is left to learn from.
[[nodiscard]] std::vector<SchemeError> cross_validate(const Corpus& corpus, std::span<const Scheme> schemes,
                                                      LeaveOut leave_out);

}  // namespace reachcast
