// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/hand_path_speed.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "reachcast/curves/bezier.hpp"
#include "reachcast/curves/distributions.hpp"

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

/// Where a falling function crosses zero in [1, kMaxExponent + 1], or the edge nearer to that.
double falling_root(const auto& function) {
  double low = 1.0, high = SpeedProfile::kMaxExponent + 1.0;
  if (function(low) <= 0.0) return low;
  if (function(high) >= 0.0) return high;
  for (double middle = 0.5 * (low + high); middle > low && middle < high; middle = 0.5 * (low + high)) {
    (function(middle) > 0.0 ? low : high) = middle;
  }
  return low;
}

/// Weighted means of log t and log(1 - t): all that the likelihood knows of a sample.
struct MeanLogs {
  double t = 0.0, rest = 0.0;
};

MeanLogs mean_logs(std::span<const double> sample, std::span<const double> weights) {
  MeanLogs sums;
  double total = 0.0, least = 1.0, most = 0.0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    if (!(sample[i] > 0.0 && sample[i] < 1.0)) {
      throw std::invalid_argument("sample[" + std::to_string(i) + "] is " + std::to_string(sample[i]) +
                                  ", expected a number between 0 and 1");
    }
    const double weight = weights.empty() ? 1.0 : weights[i];
    if (!(weight >= 0.0 && std::isfinite(weight))) {
      throw std::invalid_argument("weights[" + std::to_string(i) + "] is " + std::to_string(weight) +
                                  ", expected a finite number >= 0");
    }
    if (weight == 0.0) continue;
    total += weight;
    sums.t += weight * std::log(sample[i]);
    sums.rest += weight * std::log1p(-sample[i]);
    least = std::min(least, sample[i]);
    most = std::max(most, sample[i]);
  }
  if (least >= most) throw std::invalid_argument("sample has fewer than 2 different values with a weight over 0");
  return {sums.t / total, sums.rest / total};
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace

double SpeedProfile::progress(double t) const {
  require_profile(*this, t);
  return regularised_incomplete_beta(alpha + 1.0, beta + 1.0, t);
}

double SpeedProfile::speed(double t) const {
  require_profile(*this, t);
  return std::pow(t, alpha) * std::pow(1.0 - t, beta) * std::exp(-log_beta(alpha + 1.0, beta + 1.0));
}

// With a = alpha + 1 and b = beta + 1 the mean log-likelihood (a-1) E[log t] + (b-1) E[log(1-t)] - log B(a, b) is
// concave. For each b the best a is where its derivative E[log t] - digamma(a) + digamma(a + b) falls through zero, and
// along those a the derivative by b falls too, so two nested searches find the maximum in the box.
SpeedProfile fit_speed_sample(std::span<const double> sample, std::span<const double> weights) {
  if (!weights.empty() && weights.size() != sample.size()) {
    throw std::invalid_argument("weights has " + std::to_string(weights.size()) + " values, expected " +
                                std::to_string(sample.size()) + ", one per value of sample");
  }
  const MeanLogs mean = mean_logs(sample, weights);
  const auto best_a = [&](double b) {
    return falling_root([&](double a) { return mean.t - digamma(a) + digamma(a + b); });
  };
  const double b = falling_root([&](double y) { return mean.rest - digamma(y) + digamma(best_a(y) + y); });
  return {best_a(b) - 1.0, b - 1.0};
}

SpeedProfile fit_speed_profile(std::span<const Vec3> points, std::span<const double> times) {
  if (points.size() < 3) {
    throw std::invalid_argument("points has " + std::to_string(points.size()) + " points, expected at least 3");
  }
  const std::vector<double> clock =
      times.empty() ? even_times(points.size()) : std::vector<double>(times.begin(), times.end());
  if (clock.size() != points.size()) {
    throw std::invalid_argument("times has " + std::to_string(clock.size()) + " values, expected " +
                                std::to_string(points.size()) + ", one per point");
  }
  const double begin = clock.front(), duration = clock.back() - clock.front();
  std::vector<double> middles, distances;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (!(clock[i] > clock[i - 1] && std::isfinite(duration))) {
      throw std::invalid_argument("times[" + std::to_string(i) + "] is " + std::to_string(clock[i]) +
                                  ", expected a finite number over the one before it");
    }
    const double distance = glm::length(points[i] - points[i - 1]);
    if (!std::isfinite(distance)) throw std::invalid_argument("points[" + std::to_string(i) + "] is not finite");
    if (distance == 0.0) continue;
    middles.push_back((0.5 * (clock[i] + clock[i - 1]) - begin) / duration);
    distances.push_back(distance);
  }
  if (middles.size() < 2) {
    throw std::invalid_argument("points move in " + std::to_string(middles.size()) +
                                " of their steps, expected at least 2");
  }
  return fit_speed_sample(middles, distances);
}

SpeedProfile median_profile(std::span<const SpeedProfile> profiles) {
  if (profiles.empty()) throw std::invalid_argument("profiles is empty, expected at least 1 profile");
  std::vector<double> alphas, betas;
  for (const SpeedProfile& profile : profiles) {
    alphas.push_back(profile.alpha);
    betas.push_back(profile.beta);
  }
  return {median(std::move(alphas)), median(std::move(betas))};
}

}  // namespace reachcast
