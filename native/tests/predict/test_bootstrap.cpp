// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/bootstrap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace reachcast {
namespace {

TEST(Bootstrap, QuantilesAreThoseOfTheTextbook) {
  const std::vector<double> values{1.0, 2.0, 3.0, 4.0};
  EXPECT_EQ(quantile(values, 0.0), 1.0);
  EXPECT_EQ(quantile(values, 0.25), 1.75);
  EXPECT_EQ(quantile(values, 0.5), 2.5);
  EXPECT_EQ(quantile(values, 1.0), 4.0);
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(quantile(std::vector{1.0, 2.0, infinite}, 0.5), 2.0);
  EXPECT_EQ(quantile(std::vector{1.0, infinite, infinite}, 0.75), infinite);
}

/// Of three groups drawn three times, the middle of the ordered draws is the first group in 7 of 27 cases, the second
/// in 13, the third in 7.
TEST(Bootstrap, EveryGroupIsDrawnAlike) {
  const Resamples resamples(3, 27'000, 2004);
  std::array<int, 3> middle{};
  for (std::size_t time = 0; time < resamples.times(); ++time) {
    const auto counts = resamples.counts(time);
    ASSERT_EQ(counts[0] + counts[1] + counts[2], 3u);
    ++middle[counts[0] >= 2 ? 0 : counts[2] >= 2 ? 2 : 1];
  }
  const double four_sigma = 4.0 * std::sqrt(27'000.0 * 0.25);
  EXPECT_NEAR(middle[0], 7'000, four_sigma);
  EXPECT_NEAR(middle[1], 13'000, four_sigma);
  EXPECT_NEAR(middle[2], 7'000, four_sigma);
}

TEST(Bootstrap, TheSeedDecides) {
  const Resamples a(50, 10, 7), b(50, 10, 7), c(50, 10, 8);
  bool differs = false;
  for (std::size_t time = 0; time < 10; ++time) {
    EXPECT_TRUE(std::equal(a.counts(time).begin(), a.counts(time).end(), b.counts(time).begin()));
    differs |= !std::equal(a.counts(time).begin(), a.counts(time).end(), c.counts(time).begin());
  }
  EXPECT_TRUE(differs);
}

/// The same by writing every resample out and sorting it.
TEST(Bootstrap, MediansAreThoseOfResamplesWrittenOut) {
  std::mt19937_64 random(4);
  for (int trial = 0; trial < 50; ++trial) {
    const std::size_t groups = 1 + random() % 6, values = groups + random() % 20;
    std::vector<double> errors;
    std::vector<std::uint32_t> group_of;
    for (std::size_t i = 0; i < values; ++i) {
      errors.push_back(static_cast<double>(random() % 10));
      group_of.push_back(static_cast<std::uint32_t>(i < groups ? i : random() % groups));
    }
    const Resamples resamples(groups, 200, 1);
    std::vector<double> medians;
    for (std::size_t time = 0; time < 200; ++time) {
      std::vector<double> drawn;
      for (std::size_t i = 0; i < values; ++i)
        drawn.insert(drawn.end(), resamples.counts(time)[group_of[i]], errors[i]);
      std::sort(drawn.begin(), drawn.end());
      medians.push_back(quantile(drawn, 0.5));
    }
    EXPECT_EQ(resampled_medians(errors, group_of, resamples), medians) << trial;
  }
}

TEST(Bootstrap, IntervalLeavesOutTwoAndAHalfPercentAtEitherEnd) {
  std::vector<double> values;
  for (int i = 200; i >= 0; --i) values.push_back(i);
  EXPECT_EQ(percentile_interval(values).low, 5.0);
  EXPECT_EQ(percentile_interval(values).high, 195.0);
}

}  // namespace
}  // namespace reachcast
