// SPDX-License-Identifier: GPL-3.0-or-later
/// How much recorded paths vary by nature, which no prediction can undercut (Faraway, Reed, Wang 2007, section 4).
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "reachcast/conventions.hpp"

namespace reachcast {

/// What is taken out of two paths before they are compared.
enum class Alignment {
  none,   ///< nothing: positions as recorded
  start,  ///< moved to start at the same point, as the paper draws its Figs 1 and 2
  ends,   ///< each is its deviation from its own straight line: start and end are known, only the shape varies
};

/// Positions at `count` >= 2 evenly spaced relative arc lengths, the first and the last exactly the path's ends; linear
/// between recorded points. Throws std::invalid_argument for what `arc_length_times` refuses.
[[nodiscard]] Points resampled(std::span<const Vec3> path, std::size_t count);

/// Largest distance over relative arc length between the two paths of every pair in a group: pass replicates (one
/// person, one task) for the variation within subjects. Pairs in order of the paths. Throws std::invalid_argument
/// unless there is one group per path.
[[nodiscard]] std::vector<double> variation_within(std::span<const Points> paths, std::span<const std::string> groups,
                                                   Alignment alignment = Alignment::ends);

/// Largest distance over relative arc length from the median path of its group, coordinate by coordinate: pass tasks as
/// groups for the variation between subjects. One value per path, in order; paths alone in their group are left out.
[[nodiscard]] std::vector<double> variation_about_median(std::span<const Points> paths,
                                                         std::span<const std::string> groups,
                                                         Alignment alignment = Alignment::ends);

/// Directions in which numbers vary together.
struct PrincipalComponents {
  Eigen::VectorXd variances;   ///< falling, >= 0
  Eigen::MatrixXd directions;  ///< orthonormal columns; the largest entry of each is positive
};
[[nodiscard]] PrincipalComponents principal_components(const Eigen::MatrixXd& covariance);

}  // namespace reachcast
