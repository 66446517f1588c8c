// SPDX-License-Identifier: GPL-3.0-or-later
/// Regression that follows whatever shape the data have and falls back to their mean away from them: kernel ridge
/// regression, the mean of a Gaussian process (Rasmussen and Williams 2006, sections 2.2 and 2.7).
///
/// With K_ij = exp(-|z_i - z_j|^2 / 2) for columns z divided by their lengths, the responses less their mean m are
/// smoothed by (K + ridge I)^-1. Unlike a polynomial it cannot run away: see `reach`.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "reachcast/curves/regression.hpp"

namespace reachcast {

class SmoothFit {
 public:
  /// columns n x p, responses n x q, lengths p, each > 0: how far apart in a column reaches are no longer alike;
  /// ridge > 0: how much a reach varies about the surface, relative to the surface's own variance.
  /// Throws std::invalid_argument for a length or ridge out of range.
  SmoothFit(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& responses, const Eigen::VectorXd& lengths,
            double ridge);

  [[nodiscard]] Eigen::VectorXd mean(const Eigen::RowVectorXd& row) const;
  /// Posterior variance of the surface as a multiple of the residual variance, plus that of the mean, 1/n.
  [[nodiscard]] double leverage(const Eigen::RowVectorXd& row) const;
  /// The mean of each response, which predictions tend to away from the data.
  [[nodiscard]] const Eigen::VectorXd& centre() const { return centre_; }
  /// No prediction of a response, wherever it is asked for, is farther from the centre than this: by Cauchy and
  /// Schwarz |k^T w| <= sqrt(w^T K w), as k(z, z) = 1.
  [[nodiscard]] const Eigen::VectorXd& reach() const { return reach_; }
  /// Degrees of freedom are n - 1 less the trace of K (K + ridge I)^-1.
  [[nodiscard]] const Residuals& residuals() const { return residuals_; }
  /// Residuals of each group when the surface is made without it; the centre stays that of all.
  [[nodiscard]] Eigen::MatrixXd left_out_residuals(const Members& groups) const;

 private:
  [[nodiscard]] Eigen::VectorXd kernel(const Eigen::RowVectorXd& row) const;

  double ridge_;
  Eigen::VectorXd lengths_;
  Eigen::MatrixXd places_;  ///< n x p, columns divided by their lengths
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::VectorXd centre_, reach_;
  Eigen::MatrixXd weights_;  ///< n x q
  Residuals residuals_;
};

}  // namespace reachcast
