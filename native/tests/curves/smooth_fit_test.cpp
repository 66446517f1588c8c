// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/smooth_fit.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

namespace reachcast {
namespace {

constexpr double kRounding = 1e-9;

struct Data {
  Eigen::MatrixXd x, y;
  Eigen::VectorXd lengths;
};

Data random_data(std::uint64_t seed, Eigen::Index count) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto matrix = [&](Eigen::Index rows, Eigen::Index columns) -> Eigen::MatrixXd {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
  };
  Data data{matrix(count, 3), 0.2 * matrix(count, 4), Eigen::Vector3d(0.8, 1.5, 2.0)};
  data.y.col(0) += data.x.col(0).array().sin().matrix();
  return data;
}

double kernel(const Data& data, const Eigen::RowVectorXd& a, const Eigen::RowVectorXd& b) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < a.size(); ++i) sum += std::pow((a[i] - b[i]) / data.lengths[i], 2);
  return std::exp(-0.5 * sum);
}

/// K + ridge I, entry by entry.
Eigen::MatrixXd system_of(const Data& data, double ridge) {
  const Eigen::Index n = data.x.rows();
  Eigen::MatrixXd k(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) k(i, j) = kernel(data, data.x.row(i), data.x.row(j)) + (i == j ? ridge : 0.0);
  }
  return k;
}

TEST(SmoothFit, MeanAndLeverageAgreeWithTheirDefinitions) {
  const Data data = random_data(1, 30), asked = random_data(2, 10);
  for (const double ridge : {0.05, 0.3, 4.0}) {
    const SmoothFit fit(data.x, data.y, data.lengths, ridge);
    const Eigen::MatrixXd inverse = system_of(data, ridge).inverse();
    const Eigen::RowVectorXd centre = data.y.colwise().mean();
    for (Eigen::Index i = 0; i < 10; ++i) {
      Eigen::RowVectorXd k(30);
      for (Eigen::Index j = 0; j < 30; ++j) k[j] = kernel(data, asked.x.row(i), data.x.row(j));
      const Eigen::RowVectorXd mean = centre + k * inverse * (data.y.rowwise() - centre);
      EXPECT_LT((fit.mean(asked.x.row(i)).transpose() - mean).norm(), kRounding);
      EXPECT_NEAR(fit.leverage(asked.x.row(i)), (1.0 - k * inverse * k.transpose()) / ridge + 1.0 / 30, kRounding);
    }
    const double trace = (Eigen::MatrixXd::Identity(30, 30) - ridge * inverse).trace();
    EXPECT_NEAR(fit.residuals().freedom, 29.0 - trace, kRounding);
  }
}

TEST(SmoothFit, ResidualsAreObservedLessFitted) {
  const Data data = random_data(3, 25);
  const SmoothFit fit(data.x, data.y, data.lengths, 0.3);
  for (Eigen::Index i = 0; i < 25; ++i) {
    const Eigen::VectorXd miss = data.y.row(i).transpose() - fit.mean(data.x.row(i));
    EXPECT_LT((fit.residuals().rows.row(i).transpose() - miss).norm(), kRounding);
  }
}

TEST(SmoothFit, FarFromTheDataItIsTheirMean) {
  const Data data = random_data(4, 25);
  const SmoothFit fit(data.x, data.y, data.lengths, 0.3);
  EXPECT_EQ(fit.mean(Eigen::RowVector3d(100.0, -300.0, 80.0)), fit.centre());
  EXPECT_LT((fit.centre() - data.y.colwise().mean().transpose()).norm(), kRounding);
}

TEST(SmoothFit, NoPredictionLeavesTheReach) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-6.0, 6.0);
  const Data data = random_data(6, 40);
  for (const double ridge : {0.01, 0.3}) {
    const SmoothFit fit(data.x, data.y, data.lengths, ridge);
    for (int i = 0; i < 3000; ++i) {
      const Eigen::RowVector3d at(uniform(random), uniform(random), uniform(random));
      const Eigen::VectorXd deviation = (fit.mean(at) - fit.centre()).cwiseAbs();
      EXPECT_TRUE((deviation.array() <= fit.reach().array() + kRounding).all());
    }
  }
}

TEST(SmoothFit, TheRidgeGoesFromTheDataToTheirMean) {
  const Data data = random_data(7, 15);
  const SmoothFit close(data.x, data.y, data.lengths, 1e-8), far(data.x, data.y, data.lengths, 1e8);
  EXPECT_LT(close.residuals().rows.cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_LT((far.mean(data.x.row(3)) - far.centre()).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_NEAR(far.residuals().freedom, 14.0, 1e-6);
  EXPECT_FALSE(close.residuals().covariance) << "nothing is left to estimate it from";
}

TEST(SmoothFit, LeftOutResidualsAreThoseOfASurfaceWithoutTheGroup) {
  const Data data = random_data(8, 20);
  const SmoothFit fit(data.x, data.y, data.lengths, 0.3);
  const Members groups{{0, 1, 2, 7}, {3, 4, 5, 6, 8, 9, 10}, {11, 12, 13, 14, 15, 16, 17, 18, 19}};
  const Eigen::MatrixXd found = fit.left_out_residuals(groups);
  const Eigen::MatrixXd deviations = data.y.rowwise() - fit.centre().transpose();
  const Eigen::MatrixXd system = system_of(data, 0.3);
  for (const auto& group : groups) {
    std::vector<Eigen::Index> others;
    for (Eigen::Index i = 0; i < 20; ++i) {
      if (std::find(group.begin(), group.end(), i) == group.end()) others.push_back(i);
    }
    const Eigen::MatrixXd inner = system(others, others), cross = system(group, others);
    const Eigen::MatrixXd weights = inner.inverse() * deviations(others, every_column(deviations));
    const Eigen::MatrixXd expected = deviations(group, every_column(deviations)) - cross * weights;
    EXPECT_LT((found(group, every_column(found)) - expected).norm(), kRounding);
  }
}

TEST(SmoothFit, RepeatedReachesAndOneReachAreNoTrouble) {
  Data data = random_data(9, 10);
  data.x.rowwise() = data.x.row(0).eval();
  const SmoothFit same(data.x, data.y, data.lengths, 0.3);
  EXPECT_TRUE(same.mean(data.x.row(0)).allFinite());
  const SmoothFit one(data.x.topRows(1), data.y.topRows(1), data.lengths, 0.3);
  EXPECT_LT((one.mean(data.x.row(0)).transpose() - data.y.row(0)).norm(), kRounding);
  EXPECT_FALSE(one.residuals().covariance);
}

TEST(SmoothFit, NamesTheNumberOutOfRange) {
  const Data data = random_data(10, 5);
  const auto message = [&](const Eigen::VectorXd& lengths, double ridge) -> std::string {
    try {
      const SmoothFit fit(data.x, data.y, lengths, ridge);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message(data.lengths, 0.0), "ridge is 0.000000, expected a finite number > 0");
  EXPECT_EQ(message(Eigen::Vector3d(1.0, -2.0, 1.0), 0.3), "lengths[1] is -2.000000, expected a finite number > 0");
}

}  // namespace
}  // namespace reachcast
