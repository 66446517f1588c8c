// SPDX-License-Identifier: GPL-3.0-or-later
/// Where an endpoint goes between a given start and a given end (Faraway 2004, section 3.2).
///
/// The paper's (v, r, phi): relative axial velocity, radial deviation, and its angle about the axis from start to end,
/// zero at the projected vertical. That zero does not exist for a vertical axis, and a shelf straight above the home of
/// a box is common. So r cos(phi) and r sin(phi) are kept as what they are, the deviation as a vector orthogonal to the
/// axis; a small r then weighs little in a mean. A path is carried to another axis by the smallest rotation between the
/// two, which keeps the vertical vertical where the axes differ by a turn about it.
#pragma once

#include <Eigen/Core>
#include <span>

#include "reachcast/conventions.hpp"

namespace reachcast {

inline constexpr Eigen::Index kPathBasisCount =
    6;  ///< eight without the first and the last: v and r vanish at the ends

struct EndpointPath {
  Eigen::Matrix<double, kPathBasisCount, 1> velocity;   ///< v, in units of the axis length per scaled time
  Eigen::Matrix<double, kPathBasisCount, 3> deviation;  ///< metres, frame of the points, orthogonal to the axis
};

/// Scaled time of what begins and ends at rest: even but for its first and last tenth, where it gathers and loses pace.
/// A spline that vanishes at its ends still has a slope there; run in this time it has none, as hands have not that
/// wait on a box.
[[nodiscard]] double resting_time(double t);

/// points: at least 4, evenly spaced in time, finite. Start and end must be at least 1 cm apart (a path that ends where
/// it began has no axis). Throws std::invalid_argument.
[[nodiscard]] EndpointPath fit_endpoint_path(std::span<const Vec3> points);

/// The path of a motion along `from` (end minus start) as it would be along `to`. Deviations shrink with the length
/// of the axis and do not grow with it.
[[nodiscard]] EndpointPath carried(const EndpointPath& path, const Vec3& from, const Vec3& to);

/// Share of the axis covered at scaled time t: 0 at 0, 1 at 1.
[[nodiscard]] double progress(const EndpointPath& path, double t);

/// Point at scaled time t; exactly `start` at 0 and `end` at 1. Deviation along the axis is left out.
[[nodiscard]] Vec3 point_at(const EndpointPath& path, const Vec3& start, const Vec3& end, double t);

}  // namespace reachcast
