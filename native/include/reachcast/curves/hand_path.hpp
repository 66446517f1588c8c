// SPDX-License-Identifier: GPL-3.0-or-later
/// Where a hand goes between two given points, as a Bezier curve (Faraway, Reed, Wang 2007, sections 3.3 and 4).
///
/// Axis parameterisation: the inner control points are offsets from the axis points A_i = P_0 + i/d (P_d - P_0),
/// divided by a scale. All points are in the body frame (x right, y forward, z up, metres); offsets are kept for the
/// right hand, the left hand's are their mirror image (x changes sign).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "reachcast/conventions.hpp"
#include "reachcast/curves/hand_path_speed.hpp"

namespace reachcast {

enum class Hand { left, right };

/// What offsets are divided by. d_a is the distance from start to end: the scan of the paper says "between P_0 and
/// P_1", but its own figures (-0.025 x 56.7 cm = -1.4 cm) are for P_0 and P_d.
enum class OffsetScaling {
  distance,       ///< d_a; offsets are pure numbers
  distance_time,  ///< sqrt(t d_a) with the duration t; offsets in sqrt(m/s)
};

inline constexpr double kMinimumReach_m = 0.01;  ///< a shorter path has no axis to learn from

/// A path and the timing along it.
struct HandPath {
  Points control;  ///< first and last are exactly the start and the end asked for
  SpeedProfile speed;

  /// Positions at relative times in [0, 1]: the curve at the progress of each. Throws std::invalid_argument for others.
  [[nodiscard]] Points positions(std::span<const double> t) const;
};

struct HandPathFit {
  int degree = 3;           ///< 1 to kMaxBezierDegree
  Hand hand = Hand::right;  ///< the hand that made the paths
  OffsetScaling scaling = OffsetScaling::distance;
  std::vector<double> durations_s;  ///< one per path, > 0, for distance_time only
  SpeedProfile speed;               ///< taken over into predictions; not estimated
};

/// The paper's null model: a mean offset for each inner control point, and how they vary together.
class HandPathModel {
 public:
  /// The means of the paper's 2,031 reaches (section 4), scaled by distance; no covariance was published.
  [[nodiscard]] static HandPathModel published();

  /// Learns from paths of at least 2 points, whose ends are at least kMinimumReach_m apart. One path is enough for the
  /// mean, two for a covariance. Throws std::invalid_argument that names the path.
  [[nodiscard]] static HandPathModel fit(std::span<const Points> paths, const HandPathFit& options = {});

  /// The mean path. A path that ends where it starts has d_a = 0: all control points are equal to it.
  /// Throws std::invalid_argument for points that are not finite, and for a missing duration with distance_time.
  [[nodiscard]] HandPath predict(const Vec3& start, const Vec3& end, Hand hand = Hand::right,
                                 std::optional<double> duration_s = std::nullopt) const;

  /// One path drawn from the multivariate normal of the offsets (section 4, Fig. 8). The same seed gives the same path
  /// on every machine, up to the last digit of its log and cos. Throws also if the model has no covariance.
  [[nodiscard]] HandPath sample(const Vec3& start, const Vec3& end, std::uint64_t seed, Hand hand = Hand::right,
                                std::optional<double> duration_s = std::nullopt) const;

  [[nodiscard]] int degree() const { return static_cast<int>(offsets_.size()) / 3 + 1; }
  [[nodiscard]] OffsetScaling scaling() const { return scaling_; }
  [[nodiscard]] const SpeedProfile& speed() const { return speed_; }
  /// degree - 1 scaled offsets of the right hand, of P_1 ... P_{d-1}.
  [[nodiscard]] Points offsets() const;
  /// Of the scaled offsets stacked as x, y, z of P_1, then P_2, ...: 3 (degree - 1) square; divisor paths - 1.
  [[nodiscard]] const std::optional<Eigen::MatrixXd>& covariance() const { return covariance_; }

 private:
  HandPathModel() = default;
  [[nodiscard]] HandPath place(const Eigen::VectorXd& offsets, const Vec3& start, const Vec3& end, Hand hand,
                               std::optional<double> duration_s) const;

  OffsetScaling scaling_ = OffsetScaling::distance;
  SpeedProfile speed_;
  Eigen::VectorXd offsets_;
  std::optional<Eigen::MatrixXd> covariance_;
};

}  // namespace reachcast
