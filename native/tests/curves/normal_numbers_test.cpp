// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/normal_numbers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace reachcast {
namespace {

// Bit for bit: only operations that IEEE 754 rounds alike everywhere are used.
TEST(NormalNumbers, TheSameSeedGivesTheSameBitsEverywhere) {
  const Eigen::VectorXd numbers = normal_numbers(42, 5);
  const double expected[] = {0x1.4b37d0b4daa8fp+0, 0x1.68f438d8aec29p-1, 0x1.978762f4a05dcp-2, -0x1.25efc127557c4p-1,
                             0x1.1e599fb914973p+0};
  for (Eigen::Index i = 0; i < 5; ++i) EXPECT_EQ(numbers[i], expected[i]);
  EXPECT_EQ(normal_numbers(42, 3), numbers.head(3)) << "more numbers only follow";
  EXPECT_NE(normal_numbers(43, 5), numbers);
}

// The polar method with the C library's logarithm.
TEST(NormalNumbers, AgreeWithMarsagliasMethod) {
  for (const std::uint64_t seed : {0u, 1u, 77u, 123456u}) {
    const Eigen::VectorXd numbers = normal_numbers(seed, 200);
    std::mt19937_64 bits(seed);
    for (Eigen::Index i = 0; i < 200; i += 2) {
      double u = 0.0, v = 0.0, square = 0.0;
      do {
        u = std::ldexp(static_cast<double>(bits() >> 11), -52) - 1.0;
        v = std::ldexp(static_cast<double>(bits() >> 11), -52) - 1.0;
        square = u * u + v * v;
      } while (square >= 1.0 || square == 0.0);
      const double factor = std::sqrt(-2.0 * std::log(square) / square);
      EXPECT_NEAR(numbers[i], u * factor, 1e-14 * (1.0 + std::abs(u * factor)));
      EXPECT_NEAR(numbers[i + 1], v * factor, 1e-14 * (1.0 + std::abs(v * factor)));
    }
  }
}

TEST(NormalNumbers, HaveTheMomentsOfTheNormalDistribution) {
  constexpr Eigen::Index kCount = 200'000;
  const Eigen::ArrayXd z = normal_numbers(7, kCount).array();
  const double error = 1.0 / std::sqrt(static_cast<double>(kCount));
  EXPECT_NEAR(z.mean(), 0.0, 4.0 * error);
  EXPECT_NEAR(z.square().mean(), 1.0, 4.0 * std::sqrt(2.0) * error);
  EXPECT_NEAR(z.cube().mean(), 0.0, 4.0 * std::sqrt(15.0) * error);
  EXPECT_NEAR(z.pow(4).mean(), 3.0, 4.0 * std::sqrt(96.0) * error);
  EXPECT_NEAR((z < 1.0).cast<double>().mean(), 0.841345, 4.0 * 0.5 * error);
}

TEST(NormalNumbers, TheFactorTimesItsTransposeIsTheCovariance) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (const Eigen::Index rank : {0, 1, 3, 6}) {
    const Eigen::MatrixXd half = Eigen::MatrixXd::NullaryExpr(6, rank, [&] { return normal(random); });
    const Eigen::MatrixXd covariance = half * half.transpose(), factor = cholesky_factor(covariance);
    EXPECT_LT((factor * factor.transpose() - covariance).cwiseAbs().maxCoeff(), 1e-10);
    EXPECT_TRUE(factor.isLowerTriangular());
  }
}

}  // namespace
}  // namespace reachcast
