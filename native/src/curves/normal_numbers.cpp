// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/normal_numbers.hpp"

#include <cmath>
#include <random>

namespace reachcast {

namespace {

// A pivot smaller than this share of its variance is what rounding leaves of zero.
constexpr double kPivotTolerance = 1e-12;
constexpr double kLog2 = 0.69314718055994530942;

/// log x for x > 0: with x = m 2^e and m in [1/2, 1), log m = 2 artanh((m-1)/(m+1)) as a power series.
double portable_log(double x) {
  constexpr int kTerms = 18;  // |y| <= 1/3: the next term is below 1e-18
  int exponent = 0;
  const double mantissa = std::frexp(x, &exponent);
  const double y = (mantissa - 1.0) / (mantissa + 1.0);
  double sum = 0.0;
  for (int k = kTerms - 1; k >= 0; --k) sum = sum * y * y + 1.0 / (2 * k + 1);
  return 2.0 * y * sum + exponent * kLog2;
}

}  // namespace

Eigen::VectorXd normal_numbers(std::uint64_t seed, Eigen::Index count) {
  std::mt19937_64 bits(seed);
  const auto uniform = [&] { return static_cast<double>(bits() >> 11) * 0x1.0p-52 - 1.0; };  // [-1, 1)
  Eigen::VectorXd numbers(count);
  for (Eigen::Index i = 0; i < count;) {
    const double u = uniform();
    const double v = uniform();
    const double square = u * u + v * v;
    if (square >= 1.0 || square == 0.0) continue;
    const double factor = std::sqrt(-2.0 * portable_log(square) / square);
    numbers[i++] = u * factor;
    if (i < count) numbers[i++] = v * factor;
  }
  return numbers;
}

Eigen::MatrixXd cholesky_factor(const Eigen::MatrixXd& covariance) {
  const Eigen::Index n = covariance.rows();
  Eigen::MatrixXd factor = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    double pivot = covariance(j, j);
    for (Eigen::Index k = 0; k < j; ++k) pivot -= factor(j, k) * factor(j, k);
    if (pivot <= kPivotTolerance * covariance(j, j)) continue;
    factor(j, j) = std::sqrt(pivot);
    for (Eigen::Index i = j + 1; i < n; ++i) {
      double rest = covariance(i, j);
      for (Eigen::Index k = 0; k < j; ++k) rest -= factor(i, k) * factor(j, k);
      factor(i, j) = rest / factor(j, j);
    }
  }
  return factor;
}

}  // namespace reachcast
