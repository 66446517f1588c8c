// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/regression.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "reachcast/curves/distributions.hpp"

namespace reachcast {
namespace {

constexpr double kRounding = 1e-9;

Eigen::MatrixXd random_matrix(std::mt19937_64& random, Eigen::Index rows, Eigen::Index columns) {
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
}

std::vector<std::string> names(Eigen::Index count) {
  std::vector<std::string> result;
  for (Eigen::Index i = 0; i < count; ++i) result.push_back(std::to_string(i));
  return result;
}

LinearFit fit(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y) {
  return {x, y, names(x.cols())};
}

/// Residual sums of squares and products without some columns, by the normal equations.
Eigen::MatrixXd error_without(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y, Eigen::Index first,
                              Eigen::Index count) {
  Eigen::MatrixXd kept(x.rows(), x.cols() - count + 1);
  kept << Eigen::VectorXd::Ones(x.rows()), x.leftCols(first), x.rightCols(x.cols() - first - count);
  const Eigen::MatrixXd b = (kept.transpose() * kept).inverse() * (kept.transpose() * y);
  const Eigen::MatrixXd rest = y - kept * b;
  return rest.transpose() * rest;
}

// Simple regression: b = Sxy / Sxx, se(b) = sqrt(s^2 / Sxx), se(a) = sqrt(s^2 (1/n + mean^2 / Sxx)).
TEST(LinearFit, AgreesWithTheFormulasOfSimpleRegression) {
  std::mt19937_64 random(1);
  const Eigen::VectorXd x = random_matrix(random, 20, 1) * 3.0, y = 0.7 * x + random_matrix(random, 20, 1);
  const double mx = x.mean(), my = y.mean();
  const double sxx = (x.array() - mx).square().sum(), sxy = ((x.array() - mx) * (y.array() - my)).sum();
  const double b = sxy / sxx, a = my - b * mx;
  const double variance = (y.array() - a - b * x.array()).square().sum() / 18.0;
  const LinearFit found = fit(x, y);
  EXPECT_NEAR(found.coefficients()(0, 0), a, kRounding);
  EXPECT_NEAR(found.coefficients()(1, 0), b, kRounding);
  EXPECT_NEAR(found.standard_errors()(0, 0), std::sqrt(variance * (1.0 / 20 + mx * mx / sxx)), kRounding);
  EXPECT_NEAR(found.standard_errors()(1, 0), std::sqrt(variance / sxx), kRounding);
  EXPECT_NEAR(found.p_values()(1, 0), student_t_p_value(b / std::sqrt(variance / sxx), 18.0), kRounding);
  EXPECT_EQ(found.residuals().freedom, 18.0);
  EXPECT_NEAR((*found.residuals().covariance)(0, 0), variance, kRounding);
  Eigen::RowVectorXd at(1);
  at << 2.5;
  EXPECT_NEAR(found.leverage(at), 1.0 / 20 + (2.5 - mx) * (2.5 - mx) / sxx, kRounding);
  EXPECT_NEAR(found.mean(at)[0], a + 2.5 * b, kRounding);
}

TEST(LinearFit, ManyResponsesAgreeWithTheNormalEquations) {
  std::mt19937_64 random(2);
  const Eigen::MatrixXd x = random_matrix(random, 40, 5), y = random_matrix(random, 40, 6);
  Eigen::MatrixXd all(40, 6);
  all << Eigen::VectorXd::Ones(40), x;
  const Eigen::MatrixXd inverse = (all.transpose() * all).inverse(), b = inverse * all.transpose() * y;
  const Eigen::MatrixXd rest = y - all * b, covariance = rest.transpose() * rest / 34.0;
  const LinearFit found = fit(x, y);
  EXPECT_LT((found.coefficients() - b).cwiseAbs().maxCoeff(), kRounding);
  EXPECT_LT((*found.residuals().covariance - covariance).cwiseAbs().maxCoeff(), kRounding);
  for (Eigen::Index i = 0; i < 6; ++i) {
    for (Eigen::Index j = 0; j < 6; ++j) {
      EXPECT_NEAR(found.standard_errors()(i, j), std::sqrt(inverse(i, i) * covariance(j, j)), kRounding);
    }
  }
}

TEST(LinearFit, TestsAgreeWithFittingOnceMoreWithoutTheColumns) {
  std::mt19937_64 random(3);
  const Eigen::MatrixXd x = random_matrix(random, 50, 6);
  Eigen::MatrixXd y = random_matrix(random, 50, 4);
  y.col(2) += 0.8 * x.col(3);
  const LinearFit found = fit(x, y);
  const Eigen::MatrixXd error = error_without(x, y, 0, 0);
  for (const auto& [first, count] : {std::pair<Eigen::Index, Eigen::Index>{0, 1}, {2, 3}, {0, 6}}) {
    const Eigen::MatrixXd without = error_without(x, y, first, count);
    const TermTest test = found.test(first, count);
    EXPECT_NEAR(test.wilks, error.determinant() / without.determinant(), kRounding);
    for (Eigen::Index j = 0; j < 4; ++j) {
      const double f = (without(j, j) - error(j, j)) / static_cast<double>(count) / (error(j, j) / 43.0);
      EXPECT_NEAR(test.f[j], f, 1e-8 * (1.0 + f));
      EXPECT_NEAR(test.p_value[j], fisher_f_p_value(f, static_cast<double>(count), 43.0), kRounding);
    }
  }
  EXPECT_LT(found.test(3, 1).wilks_p_value, 1e-3) << "the column that matters";
  EXPECT_GT(found.test(3, 1).p_value[0], 1e-3) << "but not for this response";
}

// For one response Wilks' test is the F test; for one column it is Hotelling's T^2, also an exact F.
TEST(LinearFit, WilksTestIsExactForOneResponseOrOneColumn) {
  std::mt19937_64 random(4);
  const Eigen::MatrixXd x = random_matrix(random, 30, 3), y = random_matrix(random, 30, 5);
  const TermTest single = fit(x, y.col(0)).test(1, 2);
  EXPECT_NEAR(single.wilks_p_value, single.p_value[0], kRounding);
  const TermTest column = fit(x, y).test(0, 1);
  const double f = (1.0 - column.wilks) / column.wilks * (26.0 - 5.0 + 1.0) / 5.0;
  EXPECT_NEAR(column.wilks_p_value, fisher_f_p_value(f, 5.0, 22.0), kRounding);
}

// p values of noise are uniform: about one in twenty is below 0.05.
TEST(LinearFit, TestsOfNoiseKeepTheirLevel) {
  std::mt19937_64 random(5);
  constexpr int kRounds = 2000;
  int rejected = 0;
  for (int round = 0; round < kRounds; ++round) {
    const TermTest test = fit(random_matrix(random, 25, 3), random_matrix(random, 25, 3)).test(1, 2);
    rejected += test.wilks_p_value < 0.05 ? 1 : 0;
  }
  EXPECT_NEAR(rejected, 0.05 * kRounds, 4.0 * std::sqrt(0.05 * 0.95 * kRounds));
}

TEST(LinearFit, LeftOutResidualsAreThoseOfAFitWithoutTheGroup) {
  std::mt19937_64 random(6);
  const Eigen::MatrixXd x = random_matrix(random, 24, 3), y = random_matrix(random, 24, 2);
  const Members groups{{0, 5, 9, 17}, {1, 2, 3}, {4, 6, 7, 8, 10, 11}, {12, 13, 14, 15, 16, 18, 19, 20, 21, 22, 23}};
  const Eigen::MatrixXd found = fit(x, y).left_out_residuals(groups);
  for (const auto& group : groups) {
    std::vector<Eigen::Index> others;
    for (Eigen::Index i = 0; i < 24; ++i) {
      if (std::find(group.begin(), group.end(), i) == group.end()) others.push_back(i);
    }
    const LinearFit without = fit(x(others, every_column(x)), y(others, every_column(y)));
    for (const Eigen::Index i : group) {
      EXPECT_LT((found.row(i).transpose() - (y.row(i).transpose() - without.mean(x.row(i)))).norm(), kRounding);
    }
  }
}

TEST(LinearFit, WithoutFreedomThereIsNoSpread) {
  const Eigen::MatrixXd x = Eigen::MatrixXd::Zero(1, 0), y = Eigen::MatrixXd::Constant(1, 2, 3.0);
  const LinearFit one = fit(x, y);
  EXPECT_FALSE(one.residuals().covariance);
  EXPECT_TRUE(std::isnan(one.standard_errors()(0, 0)));
  EXPECT_TRUE(std::isnan(one.p_values()(0, 0)));
  EXPECT_THROW((void)one.test(0, 0), std::invalid_argument);
}

std::string message_of(const auto& action) {
  try {
    (void)action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(LinearFit, NamesTheColumnThatTheOthersDetermine) {
  std::mt19937_64 random(7);
  Eigen::MatrixXd x = random_matrix(random, 20, 3);
  const Eigen::MatrixXd y = random_matrix(random, 20, 1);
  x.col(2) = 1e5 * (x.col(0) - 2.0 * x.col(1));
  EXPECT_NE(message_of([&] { return fit(x, y); }).find("follows from the others"), std::string::npos);
  x.col(2).setConstant(4.0);
  EXPECT_NE(message_of([&] { return fit(x, y); }).find("follows from the others"), std::string::npos);
  EXPECT_EQ(message_of([&] { return fit(x.topRows(3), y.topRows(3)); }),
            "3 reaches cannot determine 4 coefficients, expected at least as many reaches");
  x = random_matrix(random, 20, 1);
  x.bottomRows(18).setZero();
  EXPECT_NE(message_of([&] {
              return fit(x, y).left_out_residuals({{0, 1}});
            }).find("leave a coefficient open"),
            std::string::npos);
}

}  // namespace
}  // namespace reachcast
