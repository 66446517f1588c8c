// SPDX-License-Identifier: GPL-3.0-or-later
/// What it means that a recorded motion is like the one wanted, and how the likest are made into one: all that a
/// cross-validation can choose (Faraway 2004, sections 3.4 and 5).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "reachcast/corpus/motion_table.hpp"

namespace reachcast {

/// Which part of a motion a set of neighbours is for, and so which end of the task counts whole; the other end counts
/// by a quarter of its distance, and for `both` each counts whole.
enum class End { home, target, both };

/// How differences of several kinds become one.
enum class Measure {
  ranks,      ///< sum of ranks among the motions that may take part (p. 549)
  distances,  ///< root of the sum of squares, each difference divided by its scale
};

/// What becomes of the k nearest.
enum class Smoother {
  uniform,     ///< their mean
  triangular,  ///< weights k, k-1, ..., 1 (p. 549)
  kernel,      ///< Gaussian of the distance over the bandwidth (Nadaraya-Watson)
  linear,      ///< the same kernel, a plane through it: local linear regression on places and stature
};

/// One set of neighbours for all of the motion, as in the paper, or one for each end.
enum class Sets { one, two };

/// Both representations of where an endpoint goes (DESIGN 3.3).
enum class PathForm {
  deviation,  ///< speed along the axis and deviation from it (2004 paper, section 3.2)
  bezier,     ///< inner control points of a cubic, and exponents of its speed (2007 paper)
};

/// What of the neighbours' postures is averaged.
enum class Average {
  coordinates,  ///< stretch-pivot coordinates, then decoded (2004 paper)
  poses,        ///< decoded one by one on this body, then where the trunk is and how it is turned (pose_mean.hpp)
};

/// A motion whose age, sex or mass is unknown lies in the middle: its rank is half the number of the known ones, its
/// difference one scale. A subject's unknown age, sex or mass does not count. A duration must be given.
struct Scheme {
  int k = 5;  ///< >= 1; fewer motions: all of them. 1 is retargeting (p. 546): one motion, so `sets` is `one`
  Measure measure = Measure::ranks;
  bool task = true;                            ///< where the motion begins and ends counts
  std::array<bool, kTraitCount> traits{true};  ///< by Trait: what else counts; stature by default
  bool mirrored = true;                        ///< mirror images may take part
  Sets sets = Sets::two;
  PathForm paths = PathForm::deviation;
  Average postures = Average::coordinates;
  Smoother smoother = Smoother::triangular;
  double bandwidth = 0.5;      ///< of kernel and linear, in scales; > 0. Far from all motions the nearest one is left
  double ridge = 0.1;          ///< of linear, pull on the slopes, in weights of all motions; > 0. Large: `kernel`
  double task_scale_m = 0.0;   ///< what counts as 1 in a distance; 0: the spread of the motions that may take part
  TraitValues trait_scales{};  ///< the same by Trait

  [[nodiscard]] bool uses(Trait trait) const { return traits[static_cast<std::size_t>(trait)]; }
  [[nodiscard]] Sets effective_sets() const { return k == 1 ? Sets::one : sets; }
  bool operator==(const Scheme&) const = default;
};

/// Throws std::invalid_argument naming the field, its value and the limit.
void check(const Scheme& scheme);

/// Such as "ranks of task + stature, 5 triangular".
[[nodiscard]] std::string describe(const Scheme& scheme);

/// The schemes that p. 549 names, as far as the corpus knows their values ("strength" is not recorded).
[[nodiscard]] std::vector<Scheme> paper_schemes();
/// 60 schemes: those, distances, one set of neighbours, Bezier paths, no mirror images, kernels and local lines.
[[nodiscard]] std::vector<Scheme> all_schemes();

}  // namespace reachcast
