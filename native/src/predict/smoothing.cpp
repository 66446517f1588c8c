// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/smoothing.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace reachcast {

std::vector<double> uniform_weights(std::size_t n) {
  return std::vector<double>(n, 1.0 / static_cast<double>(n));
}

std::vector<double> triangular_weights(std::size_t n) {
  std::vector<double> weights(n);
  const auto all = static_cast<double>(n);
  for (std::size_t i = 0; i < n; ++i) weights[i] = static_cast<double>(n - i) / (0.5 * all * (all + 1.0));
  return weights;
}

std::vector<double> kernel_weights(std::span<const double> squared_distances, double bandwidth) {
  const double nearest = *std::min_element(squared_distances.begin(), squared_distances.end());
  std::vector<double> weights;
  weights.reserve(squared_distances.size());
  double sum = 0.0;
  for (const double d : squared_distances) {
    weights.push_back(std::exp(-0.5 * (d - nearest) / (bandwidth * bandwidth)));
    sum += weights.back();
  }
  for (double& w : weights) w /= sum;
  return weights;
}

std::vector<double> local_line_weights(std::span<const double> w, const Eigen::Ref<const Eigen::MatrixXd>& offsets,
                                       double ridge) {
  const Eigen::Index n = offsets.rows(), unknowns = offsets.cols() + 1;
  Eigen::MatrixXd x(n, unknowns);
  x.col(0).setOnes();
  x.rightCols(unknowns - 1) = offsets;
  const Eigen::Map<const Eigen::VectorXd> weights(w.data(), n);
  Eigen::MatrixXd normal = x.transpose() * weights.asDiagonal() * x;
  normal.diagonal().tail(unknowns - 1).array() += ridge;
  // a is the first entry of normal^-1 x' W y; so l = W x (normal^-1 e_1).
  const Eigen::VectorXd row = normal.ldlt().solve(Eigen::VectorXd::Unit(unknowns, 0));
  const Eigen::VectorXd l = weights.asDiagonal() * (x * row);
  return {l.data(), l.data() + n};
}

}  // namespace reachcast
