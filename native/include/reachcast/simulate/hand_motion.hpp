// SPDX-License-Identifier: GPL-3.0-or-later
/// Where the hands go and how long it takes, by published figures.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "reachcast/curves/hand_path.hpp"
#include "reachcast/motion/reach.hpp"
#include "reachcast/simulate/person.hpp"

namespace reachcast::simulate {

/// Standard deviations of the inner control points' offsets, in distances from start to end. The 2007 paper gives no
/// covariance but says what it comes to (Table 2): at the median distance of 56.7 cm the median over pairs of
/// replicates of their largest distance is 6.7 cm, that of a path from the mean model 8.0 cm, of which 1.7 cm are not
/// the model's; and that correlations are mild and no component is negligible. So offsets vary alike in all directions,
/// with the spread that gives those medians.
inline constexpr double kWithinPeople = 0.0929;
inline constexpr double kBetweenPeople = 0.1207;

/// The hold point's path: the published mean of the 2007 paper with the person's habit and a draw of this motion, and
/// the published speed profile with a draw. Deterministic.
[[nodiscard]] HandPath draw_hand_path(const Person& person, const Vec3& start, const Vec3& end, std::uint64_t seed);

/// How far the path leaves the straight line at the most, in distances from start to end.
[[nodiscard]] double largest_deviation(const HandPath& path);

/// Seconds from the first to the last movement of the hands. MTM-1's times for Move and Reach, case B, by distance and
/// by the weight in either hand; where the trunk must bend or rise, or turn to the side, that time when it is longer;
/// times the person's tempo. load_kg in both hands together.
[[nodiscard]] double motion_seconds(const Person& person, Phase phase, const Vec3& start, const Vec3& end,
                                    double load_kg);

}  // namespace reachcast::simulate
