// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/regression.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>
#include <stdexcept>

#include "reachcast/conventions.hpp"
#include "reachcast/curves/distributions.hpp"

namespace reachcast {

namespace {

// Part of a column that the others leave unexplained, below which they determine it.
constexpr double kRankTolerance = 1e-9;

Eigen::MatrixXd with_intercept(const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd all(columns.rows(), columns.cols() + 1);
  all << Eigen::VectorXd::Ones(columns.rows()), columns;
  return all;
}

/// Wilks' lambda and its p value (Rao 1951; Johnson and Wichern 2002, section 7.7).
void add_wilks(TermTest& test, const Eigen::MatrixXd& error, const Eigen::MatrixXd& hypothesis) {
  const auto q = static_cast<double>(error.rows());
  const double h = test.numerator_freedom, v = test.denominator_freedom;
  const double whole = (error + hypothesis).determinant();
  test.wilks = test.wilks_p_value = kMissing;
  if (v < q || !(whole > 0.0)) return;
  test.wilks = error.determinant() / whole;
  const double squares = q * q + h * h - 5.0;
  const double root = squares > 0.0 ? std::sqrt((q * q * h * h - 4.0) / squares) : 1.0;
  const double numerator = q * h;
  const double denominator = root * (v + h - 0.5 * (q + h + 1.0)) - 0.5 * (q * h - 2.0);
  const double part = std::pow(test.wilks, 1.0 / root);
  test.wilks_p_value = fisher_f_p_value((1.0 - part) / part * denominator / numerator, numerator, denominator);
}

}  // namespace

Residuals residuals_with(Eigen::MatrixXd rows, double freedom) {
  Residuals residuals{std::move(rows), freedom, {}};
  if (freedom >= 1.0) residuals.covariance = residuals.rows.transpose() * residuals.rows / freedom;
  return residuals;
}

LinearFit::LinearFit(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& responses,
                     std::span<const std::string> names) {
  const Eigen::MatrixXd x = with_intercept(columns);
  if (x.rows() < x.cols()) {
    throw std::invalid_argument(std::to_string(x.rows()) + " reaches cannot determine " + std::to_string(x.cols()) +
                                " coefficients, expected at least as many reaches");
  }
  // Columns of size one, so that the rank does not depend on their units.
  Eigen::VectorXd size = x.colwise().norm().transpose();
  for (double& value : size) value = value > 0.0 ? value : 1.0;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  qr.setThreshold(kRankTolerance);
  qr.compute(x * size.cwiseInverse().asDiagonal());
  if (qr.rank() < x.cols()) {
    const Eigen::Index lost = qr.colsPermutation().indices()[qr.rank()];
    throw std::invalid_argument("covariates: the column '" +
                                (lost == 0 ? "intercept" : names[static_cast<std::size_t>(lost) - 1]) +
                                "' follows from the others");
  }
  const Eigen::VectorXd back = size.cwiseInverse();
  coefficients_ = Eigen::MatrixXd::Zero(x.cols(), responses.cols());
  if (responses.cols() > 0) coefficients_ = back.asDiagonal() * qr.solve(responses);
  const Eigen::MatrixXd root = qr.matrixR().topRows(x.cols()).triangularView<Eigen::Upper>().solve(
      Eigen::MatrixXd::Identity(x.cols(), x.cols()));
  const Eigen::MatrixXd spread = back.asDiagonal() * (qr.colsPermutation() * root);
  inverse_ = spread * spread.transpose();
  basis_ = x * spread;
  residuals_ = residuals_with(responses - x * coefficients_, static_cast<double>(x.rows() - x.cols()));
}

LinearFit::LinearFit(const Eigen::VectorXd& mean)
    : coefficients_(mean.transpose()), inverse_(Eigen::MatrixXd::Zero(1, 1)) {
  residuals_.rows.resize(0, mean.size());
}

Eigen::VectorXd LinearFit::mean(const Eigen::RowVectorXd& row) const {
  return (coefficients_.row(0) + row * coefficients_.bottomRows(row.size())).transpose();
}

double LinearFit::leverage(const Eigen::RowVectorXd& row) const {
  Eigen::RowVectorXd x(row.size() + 1);
  x << 1.0, row;
  return x * inverse_ * x.transpose();
}

// For the rows b of a group and the hat matrix H, the residuals without the group are (I - H_bb)^-1 r_b.
Eigen::MatrixXd LinearFit::left_out_residuals(const Members& groups) const {
  Eigen::MatrixXd rows = residuals_.rows;
  for (const std::vector<Eigen::Index>& group : groups) {
    const auto size = static_cast<Eigen::Index>(group.size());
    const Eigen::MatrixXd basis = basis_(group, every_column(basis_));
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
    qr.setThreshold(kRankTolerance);
    qr.compute(Eigen::MatrixXd::Identity(size, size) - basis * basis.transpose());
    if (qr.rank() < size) {
      throw std::invalid_argument("people: without the person of path " + std::to_string(group.front()) +
                                  " the others leave a coefficient open");
    }
    const Eigen::MatrixXd inside = residuals_.rows(group, every_column(residuals_.rows));
    if (inside.cols() == 0) continue;  // a straight line has no offsets to learn
    const Eigen::MatrixXd outside = qr.solve(inside);
    rows(group, every_column(rows)) = outside;
  }
  return rows;
}

Eigen::MatrixXd LinearFit::standard_errors() const {
  if (!residuals_.covariance) {
    return Eigen::MatrixXd::Constant(coefficients_.rows(), coefficients_.cols(), kMissing);
  }
  return (inverse_.diagonal() * residuals_.covariance->diagonal().transpose()).cwiseSqrt();
}

Eigen::MatrixXd LinearFit::p_values() const {
  const Eigen::MatrixXd errors = standard_errors();
  return coefficients_.binaryExpr(errors, [&](double value, double error) {
    const double t = value / error;
    return std::isnan(t) ? kMissing : student_t_p_value(t, residuals_.freedom);
  });
}

// With B the coefficients of the columns, the sum of squares that they add is H = B^T [(X^T X)^-1 of them]^-1 B.
TermTest LinearFit::test(Eigen::Index first, Eigen::Index count) const {
  if (!residuals_.covariance) throw std::invalid_argument("the fit has no degrees of freedom left to test with");
  const Eigen::MatrixXd error = residuals_.rows.transpose() * residuals_.rows;
  const Eigen::MatrixXd b = coefficients_.middleRows(first + 1, count);
  const Eigen::MatrixXd hypothesis = b.transpose() * inverse_.block(first + 1, first + 1, count, count).inverse() * b;
  TermTest test;
  test.numerator_freedom = static_cast<double>(count);
  test.denominator_freedom = residuals_.freedom;
  test.f = hypothesis.diagonal().cwiseQuotient(error.diagonal()) * residuals_.freedom / test.numerator_freedom;
  test.p_value = test.f.unaryExpr([&](double f) {
    return std::isnan(f) ? kMissing : fisher_f_p_value(f, test.numerator_freedom, test.denominator_freedom);
  });
  add_wilks(test, error, hypothesis);
  return test;
}

}  // namespace reachcast
