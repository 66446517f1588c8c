// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/smooth_fit.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace reachcast {

namespace {

void require_positive(const std::string& name, double value) {
  if (value > 0.0 && std::isfinite(value)) return;
  throw std::invalid_argument(name + " is " + std::to_string(value) + ", expected a finite number > 0");
}

}  // namespace

SmoothFit::SmoothFit(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& responses, const Eigen::VectorXd& lengths,
                     double ridge)
    : ridge_(ridge), lengths_(lengths) {
  require_positive("ridge", ridge);
  for (Eigen::Index i = 0; i < lengths.size(); ++i) require_positive("lengths[" + std::to_string(i) + "]", lengths[i]);
  const Eigen::Index n = columns.rows();
  places_ = columns * lengths.cwiseInverse().asDiagonal();
  Eigen::MatrixXd kernels(n, n);
  for (Eigen::Index i = 0; i < n; ++i) kernels.col(i) = kernel(columns.row(i));
  factor_.compute(kernels + ridge * Eigen::MatrixXd::Identity(n, n));
  centre_ = responses.colwise().mean().transpose();
  const Eigen::MatrixXd deviations = responses.rowwise() - centre_.transpose();
  weights_ = Eigen::MatrixXd::Zero(n, deviations.cols());
  if (deviations.cols() > 0) weights_ = factor_.solve(deviations);  // a straight line has no offsets to learn
  reach_ = weights_.cwiseProduct(kernels * weights_).colwise().sum().cwiseMax(0.0).cwiseSqrt().transpose();
  // Residuals are y - K w = ridge w; the trace of K (K + ridge I)^-1 is n less ridge times that of the inverse.
  const Eigen::MatrixXd inverse_root = factor_.matrixL().solve(Eigen::MatrixXd::Identity(n, n));
  residuals_ = residuals_with(ridge * weights_, ridge * inverse_root.squaredNorm() - 1.0);
}

// For the rows b of a group and A = (K + ridge I)^-1, the residuals without the group are A_bb^-1 w_b (Rasmussen and
// Williams 2006, section 5.4.2, for groups). With L the factor of K + ridge I, A_bb = (L^-1)_b^T (L^-1)_b.
Eigen::MatrixXd SmoothFit::left_out_residuals(const Members& groups) const {
  Eigen::MatrixXd rows(weights_.rows(), weights_.cols());
  const Eigen::MatrixXd root = factor_.matrixL().solve(Eigen::MatrixXd::Identity(rows.rows(), rows.rows()));
  for (const std::vector<Eigen::Index>& group : groups) {
    const Eigen::MatrixXd columns = root(every_column(root), group);
    const Eigen::MatrixXd weights = weights_(group, every_column(weights_));
    if (weights.cols() == 0) continue;
    const Eigen::MatrixXd outside = (columns.transpose() * columns).llt().solve(weights);
    rows(group, every_column(rows)) = outside;
  }
  return rows;
}

Eigen::VectorXd SmoothFit::kernel(const Eigen::RowVectorXd& row) const {
  const Eigen::RowVectorXd place = row.cwiseQuotient(lengths_.transpose());
  return (places_.rowwise() - place).rowwise().squaredNorm().unaryExpr([](double d) { return std::exp(-0.5 * d); });
}

Eigen::VectorXd SmoothFit::mean(const Eigen::RowVectorXd& row) const {
  return centre_ + weights_.transpose() * kernel(row);
}

double SmoothFit::leverage(const Eigen::RowVectorXd& row) const {
  const double known = factor_.matrixL().solve(kernel(row)).squaredNorm();
  return std::max(0.0, 1.0 - known) / ridge_ + 1.0 / static_cast<double>(places_.rows());
}

}  // namespace reachcast
