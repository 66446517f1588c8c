// SPDX-License-Identifier: GPL-3.0-or-later
/// Inner control points of a hand path as numbers to learn from (Faraway, Reed, Wang 2007, section 3.3, Fig. 5).
///
/// All points are in the body frame (x right, y forward, z up, metres); offsets are those of the right hand, the left
/// hand's are their mirror image (x changes sign).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "reachcast/conventions.hpp"

namespace reachcast {

enum class Hand { left, right };

/// Where an inner control point is measured from. A_i = P_0 + i/d (P_d - P_0) are the axis points; the first half of
/// the inner points (i <= d/2) belongs to the start, the rest to the end.
enum class OffsetOrigin {
  axis,        ///< all from A_i
  ends,        ///< the first half from the start P_0, the rest from the end P_d
  start_axis,  ///< the first half from the start, the rest from A_i
  axis_end,    ///< the first half from A_i, the rest from the end
};

/// What offsets are divided by. d_a is the distance from start to end: the scan of the paper says "between P_0 and
/// P_1", but its own figures (-0.025 x 56.7 cm = -1.4 cm) are for P_0 and P_d.
enum class OffsetScaling {
  none,           ///< offsets in metres
  distance,       ///< d_a; offsets are pure numbers
  distance_time,  ///< sqrt(t d_a) with the duration t; offsets in sqrt(m/s)
};

inline constexpr double kMinimumReach_m = 0.01;  ///< a shorter path has no distance to divide by

struct OffsetForm {
  int degree = 3;  ///< 1 to kMaxBezierDegree
  OffsetOrigin origin = OffsetOrigin::axis;
  OffsetScaling scaling = OffsetScaling::distance;

  /// 3 (degree - 1): x, y, z of P_1, then of P_2, ...
  [[nodiscard]] Eigen::Index size() const { return Eigen::Index{3} * (degree - 1); }
  /// Throws std::invalid_argument for a degree out of range.
  void require_valid() const;
};

/// What the offsets of a path from start to end are multiplied by. Throws std::invalid_argument for a missing or
/// impossible duration with distance_time.
[[nodiscard]] double offset_scale(const OffsetForm& form, double distance_m, std::optional<double> duration_s);

/// The origins of P_1 ... P_{d-1}.
[[nodiscard]] Points offset_origins(const OffsetForm& form, const Vec3& start, const Vec3& end);

/// Scaled offsets of degree + 1 control points. Throws std::invalid_argument for another number of them, for ends
/// nearer than kMinimumReach_m when something is divided by the distance, and for what `offset_scale` refuses.
[[nodiscard]] Eigen::VectorXd offsets_of(std::span<const Vec3> control, const OffsetForm& form, Hand hand,
                                         std::optional<double> duration_s);

/// The inverse: control points, the first and the last exactly start and end. Where these coincide and offsets are
/// scaled, all control points do.
[[nodiscard]] Points control_of(const Eigen::VectorXd& offsets, const OffsetForm& form, const Vec3& start,
                                const Vec3& end, Hand hand, std::optional<double> duration_s);

/// x changes sign for the left hand.
[[nodiscard]] inline Vec3 for_hand(const Vec3& right, Hand hand) {
  return hand == Hand::right ? right : Vec3(-right.x, right.y, right.z);
}

}  // namespace reachcast
