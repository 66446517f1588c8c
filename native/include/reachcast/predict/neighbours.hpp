// SPDX-License-Identifier: GPL-3.0-or-later
/// Which recorded motions are like the one wanted (Faraway 2004, sections 3.4 and 5).
#pragma once

#include <functional>
#include <vector>

#include "reachcast/corpus/corpus.hpp"

namespace reachcast {

/// What is wanted, in the terms in which motions are stored.
struct Query {
  Phase phase = Phase::transfer;
  Vec3 home{0.0};    ///< hold point at the start, body frame
  Vec3 target{0.0};  ///< hold point at the end, body frame
  double stature_m = 0.0;
};

struct Neighbour {
  std::int64_t id = 0;
  std::string origin;
  bool is_mirrored = false;
  double weight = 0.0;  ///< triangular: k, k-1, ..., 1 over their sum
  double target_distance_m = 0.0;
  double home_distance_m = 0.0;
  double stature_difference_m = 0.0;
};

/// Says of a motion that it must not take part.
using LeftOut = std::function<bool(const MotionSummary&)>;

/// Which end of the motion a set of neighbours is for.
enum class End { home, target };

/// The k motions of the wanted phase with the smallest rank sum: rank of the task's distance + rank of the stature's
/// difference (p. 549). The paper's boxes all start from one place; recordings of others do not, and a floor-to-waist
/// lift has nothing to say about a low shelf. So there is one set for each end: the task's distance counts that end
/// whole and the other end by a quarter. Where all homes are equal both sets are the paper's.
/// Equal values share the smallest rank; equal sums go by id. Fewer than k motions: all of them.
/// Motions for which `left_out` holds are as if they were not there.
/// Throws std::invalid_argument when k < 1 or the phase has no motion.
[[nodiscard]] std::vector<Neighbour> nearest_motions(const MotionTable& table, const Query& query, End end, int k,
                                                     const LeftOut& left_out = {});

}  // namespace reachcast
