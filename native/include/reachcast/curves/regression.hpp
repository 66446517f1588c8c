// SPDX-License-Identifier: GPL-3.0-or-later
/// Multivariate linear regression by least squares: many responses on one set of columns (Johnson and Wichern 2002,
/// chapter 7, which Faraway, Reed, Wang 2007, section 3.3, refer to).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace reachcast {

/// What a regression leaves unexplained.
struct Residuals {
  Eigen::MatrixXd rows;  ///< observed minus fitted, one row per observation
  double freedom = 0.0;  ///< observations minus what the fit used up
  /// rows^T rows / freedom; empty when less than one degree of freedom is left.
  std::optional<Eigen::MatrixXd> covariance;
};

using Members = std::vector<std::vector<Eigen::Index>>;  ///< rows of each group

/// As an index into a matrix: all its columns. Eigen 3.4 and 5 have no other name for them in common.
[[nodiscard]] inline auto every_column(const Eigen::MatrixXd& matrix) {
  return Eigen::seqN(Eigen::Index{0}, matrix.cols());
}

[[nodiscard]] Residuals residuals_with(Eigen::MatrixXd rows, double freedom);

/// Whether a group of columns explains anything beyond the other columns.
struct TermTest {
  double numerator_freedom = 0.0, denominator_freedom = 0.0;  ///< of the F of each response
  Eigen::VectorXd f, p_value;                                 ///< one per response
  double wilks = 1.0;  ///< Wilks' lambda over all responses, |E| / |E + H|; NaN when E is singular or too few are left
  double wilks_p_value = 1.0;  ///< by Rao's F, exact when columns or responses are one or two; NaN like `wilks`
};

class LinearFit {
 public:
  /// columns n x p without the intercept, which is added in front; responses n x q; names of the p columns, for
  /// messages. Throws std::invalid_argument when there are fewer observations than coefficients, and for a column that
  /// the others determine.
  LinearFit(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& responses, std::span<const std::string> names);
  /// A mean that is known from elsewhere, without residuals.
  explicit LinearFit(const Eigen::VectorXd& mean);

  [[nodiscard]] Eigen::VectorXd mean(const Eigen::RowVectorXd& row) const;
  /// x^T (X^T X)^-1 x: the mean's covariance at this row is that times the residual covariance.
  [[nodiscard]] double leverage(const Eigen::RowVectorXd& row) const;
  /// Tests columns first ... first + count - 1. Throws std::invalid_argument without degrees of freedom.
  [[nodiscard]] TermTest test(Eigen::Index first, Eigen::Index count) const;

  /// (p + 1) x q, the first row is the intercept. Standard errors are NaN without degrees of freedom.
  [[nodiscard]] const Eigen::MatrixXd& coefficients() const { return coefficients_; }
  [[nodiscard]] Eigen::MatrixXd standard_errors() const;
  /// Two-sided, of Student's t for each coefficient alone; NaN where there is no standard error.
  [[nodiscard]] Eigen::MatrixXd p_values() const;
  [[nodiscard]] const Residuals& residuals() const { return residuals_; }
  /// Residuals of each group when the fit is made without it. Throws std::invalid_argument when the others leave a
  /// coefficient open.
  [[nodiscard]] Eigen::MatrixXd left_out_residuals(const Members& groups) const;

 private:
  Eigen::MatrixXd basis_;  ///< n x (p + 1), orthonormal: the fitted values are basis basis^T responses
  Eigen::MatrixXd coefficients_;
  Eigen::MatrixXd inverse_;  ///< (X^T X)^-1 with the intercept's column in front
  Residuals residuals_;
};

}  // namespace reachcast
