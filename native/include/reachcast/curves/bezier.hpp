// SPDX-License-Identifier: GPL-3.0-or-later
/// Bezier curves through given end points (Faraway, Reed, Wang 2007, sections 3.1 and 3.2).
///
/// A curve of degree d is its d + 1 control points; the parameter s runs from 0 at the first to 1 at the last, which
/// the curve meets exactly. Points may live in any frame and unit: the representation is affinely invariant.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "reachcast/conventions.hpp"

namespace reachcast {

inline constexpr int kMaxBezierDegree = 10;  ///< beyond it the Bernstein basis no longer tells the control points apart

/// Relative arc length up to each point: s_i = sum of the first i distances over the sum of all (2007, section 3.2).
/// Starts at 0, ends at 1, never falls. At a standstill (all distances zero) evenly spaced instead.
/// Throws std::invalid_argument for fewer than 2 points, a point that is not finite, or a length that overflows.
[[nodiscard]] std::vector<double> arc_length_times(std::span<const Vec3> points);

/// 0, 1/(n-1), ..., 1: for points that are evenly spaced along the curve. Throws std::invalid_argument for count < 2.
[[nodiscard]] std::vector<double> even_times(std::size_t count);

/// Least squares over the inner control points with the ends kept at the first and the last point; relative times from
/// the arc length, or given: as many as points, each in [0, 1]; those of the ends are not used.
///
/// What the points leave open (two points, fewer inner points than inner control points, repeated points) is settled by
/// the smallest offsets from the axis points A_i = P_0 + i/d (P_d - P_0): two points give a straight line, a standstill
/// gives d + 1 equal control points. A path that ends where it began is legal.
/// Throws std::invalid_argument for a degree outside [1, kMaxBezierDegree] and for what `arc_length_times` refuses.
[[nodiscard]] Points fit_bezier(std::span<const Vec3> points, int degree = 3);
[[nodiscard]] Points fit_bezier(std::span<const Vec3> points, std::span<const double> times, int degree = 3);

/// Bernstein polynomials B_0 ... B_d at s: B_i = binomial(d, i) s^i (1-s)^(d-i) (2007, section 3.1). Throws
/// std::invalid_argument for a degree outside [1, kMaxBezierDegree] and for s outside [0, 1].
[[nodiscard]] Eigen::RowVectorXd bernstein(double s, int degree);

/// A point of the curve, by repeated interpolation (de Casteljau). Throws std::invalid_argument unless there are
/// 2 to kMaxBezierDegree + 1 finite control points and s is in [0, 1].
[[nodiscard]] Vec3 eval_bezier(std::span<const Vec3> control, double s);
[[nodiscard]] Points eval_bezier(std::span<const Vec3> control, std::span<const double> s);

/// max_i |Z_i - C(s_i)|, how far the points lie from the curve (2007, section 4, before Table 1); one time per point.
[[nodiscard]] double maximum_error(std::span<const Vec3> points, std::span<const double> times,
                                   std::span<const Vec3> control);

/// A_0 ... A_d, evenly spaced from start to end (2007, section 3.3, Fig. 5); d >= 1.
[[nodiscard]] Points axis_points(const Vec3& start, const Vec3& end, int degree);

}  // namespace reachcast
