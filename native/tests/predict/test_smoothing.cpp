// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/smoothing.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <numeric>
#include <random>

namespace reachcast {
namespace {

constexpr double kRounding = 1e-12;
constexpr double kSolved = 1e-9;  // normal equations against QR

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(Smoothing, KernelOfFarMotionsLeavesTheNearest) {
  const std::vector<double> far{1e8, 1.1e8, 2e8};
  const std::vector<double> weights = kernel_weights(far, 0.5);
  EXPECT_EQ(weights[0], 1.0);
  EXPECT_EQ(weights[1], 0.0);
}

TEST(Smoothing, AWideKernelIsTheMean) {
  const std::vector<double> squares{0.1, 0.5, 2.0, 9.0};
  for (const double w : kernel_weights(squares, 1e6)) EXPECT_NEAR(w, 0.25, 1e-9);
}

struct Fit {
  std::vector<double> weights;
  Eigen::MatrixXd offsets;
  Eigen::VectorXd values;
};

Fit random_fit(std::mt19937_64& random, Eigen::Index motions, Eigen::Index covariates) {
  std::normal_distribution<> normal;
  Fit fit{std::vector<double>(static_cast<std::size_t>(motions)), Eigen::MatrixXd(motions, covariates),
          Eigen::VectorXd(motions)};
  for (double& w : fit.weights) w = std::exp(normal(random));
  const double all = sum(fit.weights);
  for (double& w : fit.weights) w /= all;
  for (double& x : fit.offsets.reshaped()) x = normal(random);
  for (double& y : fit.values) y = normal(random);
  return fit;
}

double applied(const std::vector<double>& weights, const Eigen::VectorXd& values) {
  return Eigen::Map<const Eigen::VectorXd>(weights.data(), values.size()).dot(values);
}

/// Ridge regression the other way: least squares with the pull on the slopes as more rows.
TEST(Smoothing, LocalLineIsTheInterceptOfARidgeRegression) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const auto motions = static_cast<Eigen::Index>(1 + random() % 30);
    const double ridge = std::pow(10.0, static_cast<double>(random() % 5) - 3.0);
    const Fit fit = random_fit(random, motions, 7);
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(motions + 7, 8);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(motions + 7);
    for (Eigen::Index i = 0; i < motions; ++i) {
      const double root = std::sqrt(fit.weights[static_cast<std::size_t>(i)]);
      rows(i, 0) = root;
      rows.row(i).tail(7) = root * fit.offsets.row(i);
      right(i) = root * fit.values(i);
    }
    rows.bottomRightCorner(7, 7).diagonal().setConstant(std::sqrt(ridge));
    const double expected = rows.colPivHouseholderQr().solve(right)(0);
    const std::vector<double> weights = local_line_weights(fit.weights, fit.offsets, ridge);
    EXPECT_NEAR(applied(weights, fit.values), expected, kSolved) << trial;
    EXPECT_NEAR(sum(weights), 1.0, kSolved) << trial;
  }
}

TEST(Smoothing, LocalLineFollowsAPlaneThatAMeanCutsOff) {
  std::mt19937_64 random(2);
  Fit fit = random_fit(random, 25, 3);
  fit.offsets.array() += 1.5;  // all motions on one side of the wanted one
  fit.values = (2.0 + (fit.offsets * Eigen::Vector3d(0.5, 1.0, 0.25)).array()).matrix();
  EXPECT_NEAR(applied(local_line_weights(fit.weights, fit.offsets, 1e-9), fit.values), 2.0, 1e-6);
  EXPECT_GT(std::abs(applied(fit.weights, fit.values) - 2.0), 0.1);
}

TEST(Smoothing, AGreatRidgeLeavesTheKernel) {
  std::mt19937_64 random(3);
  const Fit fit = random_fit(random, 12, 7);
  const std::vector<double> weights = local_line_weights(fit.weights, fit.offsets, 1e9);
  for (std::size_t i = 0; i < weights.size(); ++i) EXPECT_NEAR(weights[i], fit.weights[i], 1e-6);
}

TEST(Smoothing, OneMotionIsTakenAsItIs) {
  EXPECT_NEAR(local_line_weights(std::vector<double>{1.0}, Eigen::RowVector3d(0.4, -2.0, 1.0), 0.1)[0], 1.0, kRounding);
}

}  // namespace
}  // namespace reachcast
