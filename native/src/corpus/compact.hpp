// SPDX-License-Identifier: GPL-3.0-or-later
/// Coefficients in few bytes: multiples of kCompactStep, and of those the differences. Private to this folder.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace reachcast::compact {

/// What comes back differs by at most half a step.
inline constexpr double kLargest = 1e6;  ///< no coefficient may be larger

/// Each as the difference from the one before it, of zeros how many there are; `base`, if it is not empty, is
/// subtracted first, and the differences from it are kept as they are: for a motion of which most follows from another.
/// Both have been through `rounded`.
[[nodiscard]] std::vector<std::byte> pack(const Eigen::VectorXd& coefficients, const Eigen::VectorXd& base);

/// The other way round. Throws std::runtime_error, a sentence without its subject, when the bytes are no `count`
/// values.
[[nodiscard]] Eigen::VectorXd unpack(std::span<const std::byte> bytes, Eigen::Index count, const Eigen::VectorXd& base);

/// The nearest multiples of kCompactStep.
[[nodiscard]] Eigen::VectorXd rounded(const Eigen::VectorXd& coefficients);

}  // namespace reachcast::compact
