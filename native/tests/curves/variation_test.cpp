// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/variation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

namespace reachcast {
namespace {

constexpr double kRounding = 1e-12;

/// From `from` along x to x = 1, with a triangle of this height in the middle.
Points tent(const Vec3& from, double height) {
  return {from, from + Vec3(0.5, 0.0, height), from + Vec3(1.0, 0.0, 0.0)};
}

TEST(Variation, ResampledPointsAreEvenAlongThePath) {
  const Points corner{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 3, 0}};
  const Points found = resampled(corner, 9), expected{{0, 0, 0},   {0.5, 0, 0}, {1, 0, 0},   {1, 0.5, 0}, {1, 1, 0},
                                                      {1, 1.5, 0}, {1, 2, 0},   {1, 2.5, 0}, {1, 3, 0}};
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_LT(glm::length(found[i] - expected[i]), kRounding);
  EXPECT_EQ(resampled(Points(4, Vec3(1.0)), 3), Points(3, Vec3(1.0))) << "a standstill";
}

TEST(Variation, PairsOfReplicatesAreCompared) {
  const std::vector<Points> paths{tent(Vec3(0.0), 0.2), tent(Vec3(0.0), 0.5), tent(Vec3(0.0), 0.0),
                                  tent(Vec3(0.0), 0.9), tent(Vec3(0.0), 0.3)};
  const std::vector<std::string> groups{"a", "b", "a", "alone", "b"};
  const std::vector<double> found = variation_within(paths, groups);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(found[0], 0.2, kRounding);
  EXPECT_NEAR(found[1], 0.2, kRounding);
}

TEST(Variation, DistancesFromTheMedianPath) {
  std::vector<Points> paths;
  for (const double height : {0.1, 0.4, 0.2}) paths.push_back(tent(Vec3(0.0), height));
  paths.push_back(tent(Vec3(0.0), 7.0));
  const std::vector<double> found = variation_about_median(paths, std::vector<std::string>{"t", "t", "t", "alone"});
  ASSERT_EQ(found.size(), 3u);
  EXPECT_NEAR(found[0], 0.1, kRounding);
  EXPECT_NEAR(found[1], 0.2, kRounding);
  EXPECT_NEAR(found[2], 0.0, kRounding);
}

TEST(Variation, AlignmentTakesOutWhatIsKnown) {
  const Points low = tent(Vec3(0.0), 0.3), moved = tent(Vec3(0.0, 0.0, 2.0), 0.3);
  Points tilted = low;
  for (Vec3& point : tilted) point.y += point.x;
  const std::vector<std::string> same{"g", "g"};
  const auto distance = [&](const Points& other, Alignment alignment) {
    return variation_within(std::vector<Points>{low, other}, same, alignment).at(0);
  };
  EXPECT_NEAR(distance(moved, Alignment::none), 2.0, kRounding);
  EXPECT_NEAR(distance(moved, Alignment::start), 0.0, kRounding);
  EXPECT_NEAR(distance(moved, Alignment::ends), 0.0, kRounding);
  EXPECT_NEAR(distance(tilted, Alignment::start), 1.0, kRounding);
  EXPECT_NEAR(distance(tilted, Alignment::ends), 0.0, kRounding);
}

TEST(Variation, PrincipalComponentsRebuildTheCovariance) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd half = Eigen::MatrixXd::NullaryExpr(6, 4, [&] { return normal(random); });
  const Eigen::MatrixXd covariance = half * half.transpose();
  const PrincipalComponents found = principal_components(covariance);
  EXPECT_LT((found.directions * found.variances.asDiagonal() * found.directions.transpose() - covariance)
                .cwiseAbs()
                .maxCoeff(),
            1e-10);
  EXPECT_LT((found.directions.transpose() * found.directions - Eigen::MatrixXd::Identity(6, 6)).norm(), 1e-10);
  for (Eigen::Index i = 1; i < 6; ++i) EXPECT_LE(found.variances[i], found.variances[i - 1]);
  EXPECT_NEAR(found.variances.sum(), covariance.trace(), 1e-10);
  for (Eigen::Index i = 0; i < 6; ++i) {
    EXPECT_EQ(found.directions.col(i).maxCoeff(), found.directions.col(i).cwiseAbs().maxCoeff());
  }
}

TEST(Variation, NamesThePathThatIsWrong) {
  const std::vector<Points> paths{tent(Vec3(0.0), 0.1), Points(1, Vec3(0.0))};
  const auto message = [&](const std::vector<std::string>& groups) -> std::string {
    try {
      (void)variation_within(paths, groups);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message({"a"}), "groups has 1 values, expected 2, one per path");
  EXPECT_EQ(message({"a", "a"}), "paths[1]: points has 1 points, expected at least 2");
}

}  // namespace
}  // namespace reachcast
