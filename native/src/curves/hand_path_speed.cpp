// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/hand_path_speed.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace reachcast {

namespace {

void require_range(const char* name, double value, double high) {
  if (value >= 0.0 && value <= high) return;
  throw std::invalid_argument(std::string(name) + " is " + std::to_string(value) + ", expected a number in [0, " +
                              std::to_string(high) + "]");
}

void require_profile(const SpeedProfile& profile, double t) {
  require_range("alpha", profile.alpha, SpeedProfile::kMaxExponent);
  require_range("beta", profile.beta, SpeedProfile::kMaxExponent);
  require_range("t", t, 1.0);
}

double log_beta(double a, double b) {
  return std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b);
}

/// 1 + d_1/(1 + d_2/(1 + ...)), DLMF 8.17.22 and 8.17.23, from the front (Lentz): each step multiplies by the ratio of
/// two neighbouring convergents. Converges fast for x < (a + 1)/(a + b + 2).
double continued_fraction(double a, double b, double x) {
  constexpr int kMaxTerms = 2000;
  constexpr double kTiny = 1e-300;  // stands in for a zero denominator
  const auto away_from_zero = [](double v) { return std::abs(v) < kTiny ? kTiny : v; };
  double value = 1.0, above = 1.0, below = 0.0;
  for (int term = 1; term <= kMaxTerms; ++term) {
    const int pair = term / 2;
    const double m = pair;
    const double d = term % 2 == 0 ? m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m))
                                   : -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    below = 1.0 / away_from_zero(1.0 + d * below);
    above = away_from_zero(1.0 + d / above);
    value *= above * below;
    if (std::abs(above * below - 1.0) < std::numeric_limits<double>::epsilon()) break;
  }
  return value;
}

}  // namespace

double regularised_incomplete_beta(double a, double b, double x) {
  if (x <= 0.0) return 0.0;
  if (x >= 1.0) return 1.0;
  // I_x(a, b) = 1 - I_{1-x}(b, a) (DLMF 8.17.4) brings x to the side where the fraction converges.
  if (x > (a + 1.0) / (a + b + 2.0)) return 1.0 - regularised_incomplete_beta(b, a, 1.0 - x);
  const double front = std::exp(a * std::log(x) + b * std::log1p(-x) - log_beta(a, b)) / a;
  return front / continued_fraction(a, b, x);
}

double SpeedProfile::progress(double t) const {
  require_profile(*this, t);
  return regularised_incomplete_beta(alpha + 1.0, beta + 1.0, t);
}

double SpeedProfile::speed(double t) const {
  require_profile(*this, t);
  return std::pow(t, alpha) * std::pow(1.0 - t, beta) * std::exp(-log_beta(alpha + 1.0, beta + 1.0));
}

}  // namespace reachcast
