// SPDX-License-Identifier: GPL-3.0-or-later
/// Where an endpoint goes between a given start and a given end, as a cubic Bezier curve (Faraway, Reed, Wang 2007,
/// sections 3.3 and 4): what EndpointPath is for the 2004 paper.
#pragma once

#include <array>
#include <span>

#include "reachcast/curves/hand_path_speed.hpp"

namespace reachcast {

struct AxisCurve {
  /// P_i - A_i of the inner control points, metres, frame of the points; A_i = P_0 + i/3 (P_3 - P_0).
  std::array<Vec3, 2> offsets{Vec3(0.0), Vec3(0.0)};
  SpeedProfile speed;  ///< of the curve's parameter, which is relative arc length as nearly as a cubic allows
};

/// Exponents of what begins and ends at rest: below 1 the hand would start with a jerk.
inline constexpr double kLeastExponent = 1.0, kMostExponent = 8.0;

/// points: at least 4, evenly spaced in time, finite, not all equal. The exponents are brought within the limits above.
/// Throws std::invalid_argument.
[[nodiscard]] AxisCurve fit_axis_curve(std::span<const Vec3> points);

/// The published means (2007, section 4) for both hands on one object: between the right hand's offsets and their
/// mirror image. distance_m: from start to end.
[[nodiscard]] AxisCurve published_axis_curve(double distance_m);

/// The curve of a motion along `from` (end minus start) as it would be along `to`: scaled by distance (section 3.3) and
/// turned by the smallest rotation between the two.
[[nodiscard]] AxisCurve carried(const AxisCurve& curve, const Vec3& from, const Vec3& to);

/// The four control points between these ends, and the curve that has such inner ones.
[[nodiscard]] std::array<Vec3, 4> control_between(const AxisCurve& curve, const Vec3& start, const Vec3& end);
[[nodiscard]] AxisCurve curve_through(const std::array<Vec3, 4>& control, const SpeedProfile& speed);

/// Share of the way covered at scaled time t, clamped to [0, 1]; which is the curve's parameter.
[[nodiscard]] double progress(const AxisCurve& curve, double t);

/// Point where `progress` of the way is covered; exactly `start` at 0 and `end` at 1.
[[nodiscard]] Vec3 point_on(const AxisCurve& curve, const Vec3& start, const Vec3& end, double progress);

}  // namespace reachcast
