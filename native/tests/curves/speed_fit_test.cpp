// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include "reachcast/curves/bezier.hpp"
#include "reachcast/curves/hand_path_speed.hpp"

namespace reachcast {
namespace {

double log_likelihood(const SpeedProfile& profile, const std::vector<double>& sample,
                      const std::vector<double>& weights) {
  double sum = 0.0;
  for (std::size_t i = 0; i < sample.size(); ++i) sum += weights[i] * std::log(profile.speed(sample[i]));
  return sum;
}

/// Positions along a line at even times, moved along by a profile.
Points timed_line(const SpeedProfile& profile, std::size_t count) {
  Points points;
  for (const double t : even_times(count)) points.push_back(Vec3(0.3, 0.4, 0.0) * profile.progress(t));
  return points;
}

TEST(SpeedFit, RecoversTheProfileOfAPath) {
  for (const double alpha : {0.2, 1.63, 2.0, 7.0}) {
    for (const double beta : {0.5, 1.75, 4.0}) {
      const SpeedProfile fitted = fit_speed_profile(timed_line({alpha, beta}, 4001));
      EXPECT_NEAR(fitted.alpha, alpha, 1e-3 * (1.0 + alpha)) << "middles of short steps stand for all of their time";
      EXPECT_NEAR(fitted.beta, beta, 1e-3 * (1.0 + beta));
    }
  }
}

TEST(SpeedFit, NoOtherProfileIsMoreLikely) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0.05, 0.95);
  for (int round = 0; round < 20; ++round) {
    std::vector<double> sample(15), weights(15);
    for (double& value : sample) value = uniform(random);
    for (double& value : weights) value = uniform(random);
    const SpeedProfile best = fit_speed_sample(sample, weights);
    const double most = log_likelihood(best, sample, weights);
    for (const double step : {-0.5, -0.01, 0.01, 0.5}) {
      const SpeedProfile others[] = {{best.alpha + step, best.beta},
                                     {best.alpha, best.beta + step},
                                     {best.alpha + step, best.beta + step},
                                     {best.alpha + step, best.beta - step}};
      for (const SpeedProfile& other : others) {
        if (other.alpha < 0.0 || other.beta < 0.0) continue;
        EXPECT_LE(log_likelihood(other, sample, weights), most + 1e-12);
      }
    }
  }
}

TEST(SpeedFit, AWeightCountsLikeARepetition) {
  const std::vector<double> sample{0.2, 0.5, 0.7}, weights{1.0, 3.0, 2.0}, repeated{0.2, 0.5, 0.5, 0.5, 0.7, 0.7};
  const SpeedProfile one = fit_speed_sample(sample, weights), other = fit_speed_sample(repeated);
  EXPECT_NEAR(one.alpha, other.alpha, 1e-10);
  EXPECT_NEAR(one.beta, other.beta, 1e-10);
}

TEST(SpeedFit, TheEdgeIsTheAnswerWhereTheLikelihoodStillRises) {
  const SpeedProfile bathtub = fit_speed_sample(std::vector<double>{0.01, 0.02, 0.98, 0.99});
  EXPECT_EQ(bathtub.alpha, 0.0);
  EXPECT_EQ(bathtub.beta, 0.0);
  const SpeedProfile peak = fit_speed_sample(std::vector<double>{0.5 - 1e-6, 0.5 + 1e-6});
  EXPECT_EQ(peak.alpha, SpeedProfile::kMaxExponent);
}

TEST(SpeedFit, GivenTimesNeedNotBeEvenNorStartAtZero) {
  const SpeedProfile profile{1.5, 2.5};
  Points points;
  std::vector<double> clock;
  for (int i = 0; i <= 3000; ++i) {
    const double t = std::pow(i / 3000.0, 1.3);
    clock.push_back(7.0 + 2.5 * t);
    points.push_back(Vec3(0.0, profile.progress(t), 0.0));
  }
  const SpeedProfile fitted = fit_speed_profile(points, clock);
  EXPECT_NEAR(fitted.alpha, 1.5, 5e-3);
  EXPECT_NEAR(fitted.beta, 2.5, 5e-3);
}

// 30 t^2 (1-t)^2 integrates to 10 t^3 - 15 t^4 + 6 t^5 (Flash and Hogan 1985).
TEST(SpeedFit, FlashHoganIsLeastJerk) {
  const SpeedProfile profile = SpeedProfile::flash_hogan();
  for (const double t : {0.0, 0.1, 0.5, 0.77, 1.0}) {
    EXPECT_NEAR(profile.progress(t), t * t * t * (10.0 + t * (-15.0 + 6.0 * t)), 1e-14);
    EXPECT_NEAR(profile.speed(t), 30.0 * t * t * (1.0 - t) * (1.0 - t), 1e-12);
  }
}

TEST(SpeedFit, TheMedianIsTakenOfEachExponent) {
  const std::vector<SpeedProfile> profiles{{1.0, 9.0}, {5.0, 2.0}, {2.0, 3.0}};
  EXPECT_EQ(median_profile(profiles).alpha, 2.0);
  EXPECT_EQ(median_profile(profiles).beta, 3.0);
  EXPECT_EQ(median_profile(std::vector<SpeedProfile>{{1.0, 2.0}, {2.0, 4.0}}).beta, 3.0);
}

std::string message_of(const auto& action) {
  try {
    (void)action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(SpeedFit, NamesWhatHasNoProfile) {
  const auto fit = [](const Points& points, const std::vector<double>& times = {}) {
    return message_of([&] { return fit_speed_profile(points, times); });
  };
  const Points line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  EXPECT_EQ(fit({line[0], line[1]}), "points has 2 points, expected at least 3");
  EXPECT_EQ(fit(Points(9, line[0])), "points move in 0 of their steps, expected at least 2");
  EXPECT_EQ(fit({line[0], line[0], line[1], line[1]}), "points move in 1 of their steps, expected at least 2");
  EXPECT_EQ(fit(line, {0.0, 1.0}), "times has 2 values, expected 3, one per point");
  EXPECT_EQ(fit(line, {0.0, 1.0, 1.0}), "times[2] is 1.000000, expected a finite number over the one before it");
  EXPECT_EQ(fit({line[0], Vec3(kMissing), line[2]}), "points[1] is not finite");
  EXPECT_EQ(message_of([] {
              return fit_speed_sample(std::vector<double>{0.5, 1.0});
            }),
            "sample[1] is 1.000000, expected a number between 0 and 1");
  EXPECT_EQ(message_of([] {
              return fit_speed_sample(std::vector<double>{0.5, 0.5});
            }),
            "sample has fewer than 2 different values with a weight over 0");
  EXPECT_EQ(message_of([] {
              return fit_speed_sample(std::vector<double>{0.5, 0.6}, std::vector<double>{1.0, -1.0});
            }),
            "weights[1] is -1.000000, expected a finite number >= 0");
  EXPECT_EQ(message_of([] { return median_profile({}); }), "profiles is empty, expected at least 1 profile");
}

}  // namespace
}  // namespace reachcast
