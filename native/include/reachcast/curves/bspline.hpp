// SPDX-License-Identifier: GPL-3.0-or-later
/// Curves over scaled time [0, 1] as eight cubic B-splines (Faraway 2004, section 3.1), clamped, uniform knots.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace reachcast {

inline constexpr Eigen::Index kBasisCount = 8;
using BasisRow = Eigen::Matrix<double, 1, kBasisCount>;

/// The four basis functions that are not zero at t (clamped into [0, 1]), and the number of the first of them.
struct LocalBasis {
  Eigen::Index first = 0;
  std::array<double, 4> values{};
};
[[nodiscard]] LocalBasis bspline_local(double t);

/// All basis functions at t (clamped into [0, 1]); they are >= 0 and sum to 1. Only the first is non-zero at 0, only
/// the last at 1.
[[nodiscard]] BasisRow bspline_row(double t);

/// Integrals of the basis functions from 0 to t.
[[nodiscard]] BasisRow bspline_integral_row(double t);

/// rows: times evenly spaced over [0, 1], count >= 2.
[[nodiscard]] Eigen::MatrixXd bspline_matrix(Eigen::Index count);

/// Least squares. values: (F, C), rows evenly spaced in time, F >= 4 -> coefficients (8, C). With F < 8 the smoothest
/// of the fits. Throws std::invalid_argument for too few rows or values that are not finite.
[[nodiscard]] Eigen::MatrixXd fit_bspline(const Eigen::Ref<const Eigen::MatrixXd>& values);

/// min |A x - b|^2 with a vanishing pull towards equal neighbours that settles what the data leave open.
[[nodiscard]] Eigen::MatrixXd solve_smooth(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

}  // namespace reachcast
