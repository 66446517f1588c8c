// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/distributions.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace reachcast {
namespace {

constexpr double kTable = 5e-4;  // tables of the t and F distributions print three decimals
constexpr double kRounding = 1e-12;

TEST(Distributions, AgreeWithPrintedTables) {
  EXPECT_NEAR(student_t_quantile(0.975, 1), 12.706, kTable);
  EXPECT_NEAR(student_t_quantile(0.975, 10), 2.228, kTable);
  EXPECT_NEAR(student_t_quantile(0.95, 30), 1.697, kTable);
  EXPECT_NEAR(fisher_f_p_value(4.965, 1, 10), 0.05, 1e-5);
  EXPECT_NEAR(fisher_f_p_value(2.71, 5, 20), 0.05, 1e-4);
}

TEST(Distributions, QuantileAndPValueAreInverse) {
  for (const double freedom : {1.0, 2.5, 17.0, 400.0}) {
    for (const double p : {0.6, 0.9, 0.975, 0.9999}) {
      EXPECT_NEAR(student_t_p_value(student_t_quantile(p, freedom), freedom), 2.0 * (1.0 - p), kRounding);
    }
  }
}

TEST(Distributions, TheSquareOfStudentsTIsFishersF) {
  for (const double freedom : {1.0, 4.0, 33.0}) {
    for (const double t : {0.0, 0.3, 2.0, 9.0}) {
      EXPECT_NEAR(student_t_p_value(t, freedom), fisher_f_p_value(t * t, 1.0, freedom), kRounding);
      EXPECT_EQ(student_t_p_value(t, freedom), student_t_p_value(-t, freedom));
    }
  }
  EXPECT_EQ(student_t_p_value(INFINITY, 3.0), 0.0);
  EXPECT_EQ(fisher_f_p_value(INFINITY, 3.0, 3.0), 0.0);
}

TEST(Distributions, DigammaIsTheSlopeOfLogGamma) {
  constexpr double kStep = 1e-5;
  for (const double x : {0.5, 1.0, 3.7, 40.0, 1000.0}) {
    EXPECT_NEAR(digamma(x), (std::lgamma(x + kStep) - std::lgamma(x - kStep)) / (2.0 * kStep), 1e-6);
    EXPECT_NEAR(digamma(x + 1.0), digamma(x) + 1.0 / x, kRounding);
  }
}

}  // namespace
}  // namespace reachcast
