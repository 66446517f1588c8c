// SPDX-License-Identifier: GPL-3.0-or-later
/// How much each of the nearest motions counts. Every smoother here is linear in the motions, so that it is a set of
/// weights, found once for all coefficients ("many of the well-known ideas of nonparametric regression can be
/// employed", Faraway 2004, p. 546).
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace reachcast {

/// 1/n each.
[[nodiscard]] std::vector<double> uniform_weights(std::size_t n);

/// n, n-1, ..., 1 over their sum (p. 549).
[[nodiscard]] std::vector<double> triangular_weights(std::size_t n);

/// exp(-d^2 / 2 h^2) over their sum. Only differences from the smallest distance enter, so that far from all motions
/// the nearest is left and nothing is divided by zero. At least one distance; bandwidth > 0.
[[nodiscard]] std::vector<double> kernel_weights(std::span<const double> squared_distances, double bandwidth);

/// The value at 0 of the line (plane) a + b x fitted to values y_i at x_i by
///   min sum_i w_i (y_i - a - b x_i)^2 + ridge |b|^2
/// is a = sum_i l_i y_i: returns l. They sum to 1 and may be negative. w: sum 1. offsets: one row for each weight.
/// One motion has weight 1, and with a growing ridge l goes to w. ridge > 0.
[[nodiscard]] std::vector<double> local_line_weights(std::span<const double> w,
                                                     const Eigen::Ref<const Eigen::MatrixXd>& offsets, double ridge);

}  // namespace reachcast
