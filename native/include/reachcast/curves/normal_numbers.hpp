// SPDX-License-Identifier: GPL-3.0-or-later
/// Random numbers that are the same on every machine.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace reachcast {

/// Independent standard normal numbers from std::mt19937_64, whose bits the C++ standard fixes, by Marsaglia's polar
/// method. Only +, -, *, / and sqrt are used, which IEEE 754 rounds alike everywhere: std::normal_distribution and the
/// logarithms of C libraries are not.
[[nodiscard]] Eigen::VectorXd normal_numbers(std::uint64_t seed, Eigen::Index count);

/// L with L L^T = covariance, which may have no full rank (few paths): a direction without variance gets none. Unlike
/// an eigenvector basis, L does not depend on how a machine rounds.
[[nodiscard]] Eigen::MatrixXd cholesky_factor(const Eigen::MatrixXd& covariance);

}  // namespace reachcast
