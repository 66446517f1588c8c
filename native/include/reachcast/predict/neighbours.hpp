// SPDX-License-Identifier: GPL-3.0-or-later
/// Which recorded motions are like the one wanted (Faraway 2004, sections 3.4 and 5), by name.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "reachcast/corpus/corpus.hpp"
#include "reachcast/predict/similarity.hpp"

namespace reachcast {

struct Neighbour {
  std::int64_t id = 0;
  std::string origin;
  bool is_mirrored = false;
  double weight = 0.0;  ///< by the scheme's smoother; all sum to 1
  double target_distance_m = 0.0;
  double home_distance_m = 0.0;
  double stature_difference_m = 0.0;
};

/// Says of a motion that it must not take part.
using LeftOut = std::function<bool(const MotionSummary&)>;

/// Positions of such motions in the columns that the query looks at, rising.
[[nodiscard]] std::vector<std::uint32_t> positions_of(const MotionTable& table, const Query& query,
                                                      const LeftOut& left_out);

[[nodiscard]] Neighbour named(const MotionTable& table, const Query& query, const Share& share);

/// The k motions of the wanted phase that are nearest under the scheme, best first, for one end of the motion. The
/// paper's boxes all start from one place; recordings of others do not, and a floor-to-waist lift has nothing to say
/// about a low shelf. So there is one set for each end; where all homes are equal both sets are the paper's.
/// Motions for which `left_out` holds are as if they were not there. Throws as Search does.
[[nodiscard]] std::vector<Neighbour> nearest_motions(const MotionTable& table, const Query& query, End end,
                                                     const Scheme& scheme, const LeftOut& left_out = {});

}  // namespace reachcast
