// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/bspline.hpp"

#include <Eigen/LU>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace reachcast {
namespace {

TEST(Bspline, PartitionOfUnityAndLocalSupport) {
  for (int i = 0; i <= 1000; ++i) {
    const BasisRow row = bspline_row(i / 1000.0);
    EXPECT_NEAR(row.sum(), 1.0, 1e-14);
    EXPECT_GE(row.minCoeff(), 0.0);
    EXPECT_LE((row.array() > 0.0).count(), 4);
  }
  EXPECT_EQ(bspline_row(0.0)(0), 1.0);
  EXPECT_EQ(bspline_row(1.0)(7), 1.0);
}

TEST(Bspline, IntegralMatchesSimpson) {
  const int n = 2000;
  BasisRow sum = BasisRow::Zero();
  for (int i = 0; i < n; ++i) {
    const double a = static_cast<double>(i) / n, b = static_cast<double>(i + 1) / n;
    sum += (bspline_row(a) + 4.0 * bspline_row(0.5 * (a + b)) + bspline_row(b)) / (6.0 * n);
    EXPECT_LT((sum - bspline_integral_row(b)).cwiseAbs().maxCoeff(), 1e-9) << b;
  }
}

TEST(Bspline, FitReproducesCubicsExactly) {
  for (const Eigen::Index frames : {8, 20, 121}) {
    Eigen::MatrixXd values(frames, 2);
    for (Eigen::Index f = 0; f < frames; ++f) {
      const double t = static_cast<double>(f) / static_cast<double>(frames - 1);
      values.row(f) << 1.0 + t - 3.0 * t * t + t * t * t, 0.2 * t;
    }
    const Eigen::MatrixXd back = bspline_matrix(frames) * fit_bspline(values);
    EXPECT_LT((back - values).cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST(Bspline, FitAgreesWithNormalEquations) {
  std::mt19937_64 random(1);
  std::normal_distribution<> normal;
  Eigen::MatrixXd values(60, 3);
  for (double& v : values.reshaped()) v = normal(random);
  const Eigen::MatrixXd b = bspline_matrix(60);
  const Eigen::MatrixXd oracle = (b.transpose() * b).inverse() * b.transpose() * values;
  EXPECT_LT((fit_bspline(values) - oracle).cwiseAbs().maxCoeff(), 1e-7);
}

TEST(Bspline, ShortCurvesStillFitAndTooShortOnesAreRefused) {
  Eigen::MatrixXd values(5, 1);
  values << 0.0, 0.2, 0.5, 0.7, 1.0;
  const Eigen::MatrixXd back = bspline_matrix(5) * fit_bspline(values);
  EXPECT_LT((back - values).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_THROW((void)fit_bspline(values.topRows(3)), std::invalid_argument);
  values(2) = std::nan("");
  EXPECT_THROW((void)fit_bspline(values), std::invalid_argument);
}

}  // namespace
}  // namespace reachcast
