// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/hand_path_speed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "reachcast/curves/distributions.hpp"

namespace reachcast {
namespace {

/// What the oracle's own steps leave; the binomial tail below is the sharper test.
constexpr double kSimpson = 1e-9;

/// Integral of t^alpha (1-t)^beta from 0 to x by Simpson's rule after t = sin^2(u), which smooths both ends.
long double integral(double alpha, double beta, double x) {
  constexpr int kIntervals = 3000;
  const long double upper = std::asin(std::sqrt(static_cast<long double>(x)));
  const auto integrand = [&](long double u) {
    return 2 * std::pow(std::sin(u), 2.0L * alpha + 1) * std::pow(std::max(std::cos(u), 0.0L), 2.0L * beta + 1);
  };
  const long double h = upper / kIntervals;
  long double sum = integrand(0) + integrand(upper);
  for (int i = 1; i < kIntervals; ++i) sum += (i % 2 ? 4 : 2) * integrand(i * h);
  return sum * h / 3;
}

TEST(SpeedProfile, ProgressIsTheIntegralOfSpeed) {
  for (const double alpha : {0.0, 1.63, 2.5, 60.0}) {
    for (const double beta : {0.0, 1.2, 1.75, 2.0, 12.0}) {
      const SpeedProfile profile{alpha, beta};
      const long double whole = integral(alpha, beta, 1.0);
      for (const double t : {1e-6, 0.01, 0.2, 0.37, 0.48, 0.5, 0.63, 0.8, 0.99, 1.0 - 1e-6}) {
        EXPECT_NEAR(profile.progress(t), static_cast<double>(integral(alpha, beta, t) / whole), kSimpson);
        const double speed = std::pow(t, alpha) * std::pow(1.0 - t, beta) / static_cast<double>(whole);
        EXPECT_NEAR(profile.speed(t), speed, kSimpson * (1.0 + speed));
      }
    }
  }
}

// For whole numbers I_x(a, b) is a binomial tail (DLMF 8.17.5).
TEST(SpeedProfile, AgreesWithTheBinomialTail) {
  for (const int a : {1, 2, 5, 40, 400}) {
    for (const int b : {1, 3, 40, 601}) {
      for (const double x : {0.001, 0.1, 0.4, 0.5, 0.9}) {
        long double tail = 0;
        for (int j = a; j < a + b; ++j) {
          tail +=
              std::exp(std::lgamma(static_cast<long double>(a + b)) - std::lgamma(j + 1.0L) -
                       std::lgamma(static_cast<long double>(a + b - j)) + j * std::log(static_cast<long double>(x)) +
                       (a + b - 1 - j) * std::log1p(-static_cast<long double>(x)));
        }
        EXPECT_NEAR(regularised_incomplete_beta(a, b, x), static_cast<double>(tail), 1e-12)
            << a << " " << b << " " << x;
      }
    }
  }
}

TEST(SpeedProfile, PeaksWhereThePaperSays) {
  const SpeedProfile published;
  double peak = 0.0;
  for (double t = 0.0; t <= 1.0; t += 0.001) {
    if (published.speed(t) > published.speed(peak)) peak = t;
  }
  EXPECT_NEAR(peak, 0.48, 0.005);
}

// Flash and Hogan's density 30 t^2 (1-t)^2 is what the paper calls alpha = beta = 2.
TEST(SpeedProfile, TwoAndTwoIsMinimumJerk) {
  const SpeedProfile minimum_jerk{2.0, 2.0};
  for (double t = 0.0; t <= 1.0; t += 0.125) {
    EXPECT_NEAR(minimum_jerk.speed(t), 30.0 * t * t * (1.0 - t) * (1.0 - t), 1e-13);
    EXPECT_NEAR(minimum_jerk.progress(t), t * t * t * (10.0 - 15.0 * t + 6.0 * t * t), 1e-14);
  }
}

TEST(SpeedProfile, ProgressRisesFromZeroToOne) {
  for (const SpeedProfile profile : {SpeedProfile{}, SpeedProfile{0.0, 0.0}, SpeedProfile{1000.0, 1000.0},
                                     SpeedProfile{0.0, 1000.0}, SpeedProfile{1000.0, 0.3}}) {
    EXPECT_EQ(profile.progress(0.0), 0.0);
    EXPECT_EQ(profile.progress(1.0), 1.0);
    double before = 0.0;
    for (int i = 1; i < 1000; ++i) {
      const double now = profile.progress(i / 1000.0);
      EXPECT_GE(now, before - 1e-13);
      EXPECT_LE(now, 1.0);
      before = now;
    }
  }
}

TEST(SpeedProfile, RefusesExponentsAndTimesOutOfRange) {
  EXPECT_THROW((void)(SpeedProfile{-0.1, 1.0}.progress(0.5)), std::invalid_argument);
  EXPECT_THROW((void)(SpeedProfile{1.0, 1001.0}.speed(0.5)), std::invalid_argument);
  EXPECT_THROW((void)(SpeedProfile{kMissing, 1.0}.speed(0.5)), std::invalid_argument);
  EXPECT_THROW((void)SpeedProfile{}.progress(-0.01), std::invalid_argument);
  EXPECT_THROW((void)SpeedProfile{}.progress(1.01), std::invalid_argument);
  EXPECT_THROW((void)SpeedProfile{}.speed(kMissing), std::invalid_argument);
}

}  // namespace
}  // namespace reachcast
