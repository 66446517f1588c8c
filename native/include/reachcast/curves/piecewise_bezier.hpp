// SPDX-License-Identifier: GPL-3.0-or-later
/// Bezier curves joined end to end, for paths with more turns than one curve of low degree can follow (Faraway, Reed,
/// Wang 2007, section 3.2, last paragraph).
#pragma once

#include <span>
#include <vector>

#include "reachcast/conventions.hpp"

namespace reachcast {

struct PiecewiseFit {
  int degree = 3;          ///< of every piece: 2 to kMaxBezierDegree
  double tolerance = 0.0;  ///< unit of the points, >= 0: pieces are split until none misses a point by more
  int max_pieces = 16;     ///< 1 to 64; with as many, or too few points to split on, the error stays what it is
};

/// Pieces that meet with a common tangent and a common speed dC/ds: the whole is continuously differentiable.
struct PiecewiseBezier {
  std::vector<double> breaks;  ///< pieces + 1 relative times, rising from 0 to 1
  std::vector<Points> pieces;  ///< control points, degree + 1 each; the last of one is the first of the next
  double error = 0.0;          ///< largest distance from a point to the curve at its relative time

  /// Positions at relative times of the whole path. Throws std::invalid_argument for times outside [0, 1].
  [[nodiscard]] Points positions(std::span<const double> s) const;
};

/// Least squares over all pieces at once, through the first and the last point. Starts from one piece; the piece with
/// the largest error is cut at the middle one of its points, as long as each half keeps degree - 1 of them inside.
/// Relative times from the arc length, or given: one per point, in [0, 1], never falling.
/// What the points leave open is settled by the smallest offsets from the straight line; two points give that line.
/// Throws std::invalid_argument for options out of range, falling times and what `fit_bezier` refuses.
[[nodiscard]] PiecewiseBezier fit_piecewise_bezier(std::span<const Vec3> points, const PiecewiseFit& options);
[[nodiscard]] PiecewiseBezier fit_piecewise_bezier(std::span<const Vec3> points, std::span<const double> times,
                                                   const PiecewiseFit& options);

}  // namespace reachcast
