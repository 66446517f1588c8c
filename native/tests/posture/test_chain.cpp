// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/chain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "reachcast/posture/stretch.hpp"

namespace reachcast {
namespace {

constexpr double kTolerance_m = 1e-9;  // the accuracy that chain.hpp promises for chains that are not on the edge

using Random = std::mt19937_64;
double uniform(Random& random, double lo, double hi) {
  return std::uniform_real_distribution<>(lo, hi)(random);
}
Vec3 direction(Random& random) {
  std::normal_distribution<> normal;
  return glm::normalize(Vec3(normal(random), normal(random), normal(random)));
}

struct Case {
  std::vector<double> lengths;
  std::vector<std::size_t> pivots;
  Points points;
};

Case random_case(Random& random, std::size_t links) {
  Case c;
  c.points.push_back(direction(random));
  for (std::size_t i = 0; i < links; ++i) {
    c.lengths.push_back(uniform(random, 0.05, 0.6));
    c.points.push_back(c.points.back() + c.lengths.back() * direction(random));
  }
  c.pivots.resize(links - 1);
  std::iota(c.pivots.begin(), c.pivots.end(), 1);
  std::shuffle(c.pivots.begin(), c.pivots.end(), random);
  c.pivots.resize(random() % links);  // a partial order is completed by the chain
  return c;
}

double worst_link(const Chain& chain, const Points& points) {
  double worst = 0.0;
  for (std::size_t i = 0; i < chain.links(); ++i) {
    worst = std::max(worst, std::abs(glm::distance(points[i], points[i + 1]) - chain.lengths()[i]));
  }
  return worst;
}

double worst_point(const Points& a, const Points& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, glm::distance(a[i], b[i]));
  return worst;
}

TEST(Chain, DecodeInvertsEncodeOnRandomChains) {
  Random random(1);
  for (int trial = 0; trial < 6000; ++trial) {
    const Case c = random_case(random, 2 + trial % 11);
    const Chain chain(c.lengths, c.pivots);
    std::vector<double> coordinates(chain.coordinate_count());
    ASSERT_EQ(coordinates.size(), Chain::coordinate_count(chain.links())) << "trial " << trial;
    chain.encode(c.points, coordinates);
    Points back(c.points.size());
    chain.decode(c.points.front(), c.points.back(), coordinates, back);
    ASSERT_LT(worst_point(c.points, back), kTolerance_m) << "trial " << trial;
    ASSERT_LT(worst_link(chain, back), kTolerance_m) << "trial " << trial;
  }
}

TEST(Chain, AnyCoordinatesDecodeOntoAnyBodyWithExactLinks) {
  Random random(2);
  for (int trial = 0; trial < 6000; ++trial) {
    const Case c = random_case(random, 2 + trial % 11);
    const Chain chain(c.lengths, c.pivots);
    std::vector<double> coordinates(chain.coordinate_count());
    for (double& x : coordinates) x = uniform(random, -1, 1) * std::pow(10.0, uniform(random, -2, 2));
    const double across = uniform(random, chain.reach().lo, chain.reach().hi);
    const Vec3 start = direction(random), end = start + across * direction(random);
    Points points(c.points.size());
    chain.decode(start, end, coordinates, points);
    ASSERT_LT(worst_link(chain, points), kTolerance_m) << "trial " << trial;
    ASSERT_EQ(points.front(), start);
    ASSERT_EQ(points.back(), end);
  }
}

TEST(Chain, SomeStepsPlaceTheirJointsWhereAllStepsDo) {
  Random random(9);
  for (int trial = 0; trial < 2000; ++trial) {
    const Case c = random_case(random, 2 + trial % 11);
    const Chain chain(c.lengths, c.pivots);
    std::vector<double> coordinates(chain.coordinate_count());
    for (double& x : coordinates) x = uniform(random, -3, 3);
    Points whole(c.points.size()), some(c.points.size());
    chain.decode(c.points.front(), c.points.back(), coordinates, whole);
    const std::vector<std::size_t> joints{1 + random() % (chain.links() - 1), 1 + random() % (chain.links() - 1)};
    const std::vector<std::size_t> steps = chain.steps_to(joints);
    chain.decode(c.points.front(), c.points.back(), coordinates, steps, some);
    for (const std::size_t joint : joints) ASSERT_EQ(some[joint], whole[joint]) << trial;
    ASSERT_LE(steps.size(), chain.links() - 1);
  }
}

TEST(Chain, WeightedMeanOfCodesIsAChain) {
  Random random(3);
  for (int trial = 0; trial < 1000; ++trial) {
    const Case target = random_case(random, 10);
    const Chain chain(target.lengths, target.pivots);
    std::vector<double> mean(chain.coordinate_count(), 0.0), one(mean.size());
    for (int i = 0; i < 5; ++i) {
      const Case other = random_case(random, 10);
      Chain(other.lengths, target.pivots).encode(other.points, one);
      for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += one[k] * (5 - i) / 15.0;
    }
    Points points(11);
    chain.decode(target.points.front(), target.points.back(), mean, points);
    ASSERT_LT(worst_link(chain, points), kTolerance_m);
  }
}

TEST(Chain, StraightAndFoldedChainsSurvive) {
  Random random(4);
  for (int trial = 0; trial < 2000; ++trial) {
    Case c = random_case(random, 2 + trial % 9);
    const Vec3 along = direction(random);
    const bool folded = trial % 2 == 1;
    for (std::size_t i = 0; i < c.lengths.size(); ++i) {
      c.points[i + 1] = c.points[i] + along * c.lengths[i] * (folded && i % 2 == 1 ? -1.0 : 1.0);
    }
    const Chain chain(c.lengths, c.pivots);
    std::vector<double> coordinates(chain.coordinate_count());
    chain.encode(c.points, coordinates);
    Points back(c.points.size());
    chain.decode(c.points.front(), c.points.back(), coordinates, back);
    ASSERT_LT(worst_link(chain, back), kTolerance_m);
    ASSERT_LT(worst_point(c.points, back), kTolerance_m) << "trial " << trial;
  }
}

TEST(Chain, ClosedChainKeepsItsLinks) {
  const Chain chain({0.3, 0.3, 0.4, 0.5}, {2});
  std::vector<double> coordinates(chain.coordinate_count(), 0.3);
  Points points(5);
  chain.decode(Vec3(1.0), Vec3(1.0), coordinates, points);
  EXPECT_LT(worst_link(chain, points), kTolerance_m);
}

TEST(Chain, TwentyMinusThreeNumbersForThePapersPrimaryChain) {
  // left ball, ankle, knee, hip, l5s1, c7t1, suprasternale, shoulder, elbow, wrist, grip (p. 547-548)
  const std::vector<double> lengths{.13, .43, .43, .12, .45, .14, .16, .32, .25, .09};
  const Chain chain(lengths, {5, 3, 7, 8, 2});
  // 2l - 3 = 17 of the paper; a pivot angle is kept as the three numbers of its normal, and there are 9 pivots.
  EXPECT_EQ(chain.coordinate_count(), 17u + 2u * 9u);
}

TEST(Chain, HingeLimitsHoldByConstruction) {
  Random random(5);
  const FlexionLimit elbow{0.1, 2.4};
  const Chain arm({0.18, 0.32, 0.26, 0.09}, {1, 3, 2}, {{2, elbow}});
  for (int trial = 0; trial < 5000; ++trial) {
    std::vector<double> coordinates(arm.coordinate_count());
    for (double& x : coordinates) x = uniform(random, -6, 6);
    Points p(5);
    arm.decode(Vec3(0.0), direction(random) * uniform(random, arm.reach().lo, arm.reach().hi), coordinates, p);
    const double bend =
        std::acos(std::clamp(glm::dot(glm::normalize(p[2] - p[1]), glm::normalize(p[3] - p[2])), -1.0, 1.0));
    ASSERT_GT(bend, elbow.min_rad - 1e-6);
    ASSERT_LT(bend, elbow.max_rad + 1e-6);
  }
}

TEST(Chain, ReachIsWhatRandomPosturesReach) {
  Random random(6);
  for (int trial = 0; trial < 50; ++trial) {
    const std::size_t links = 2 + trial % 4;
    const Case c = random_case(random, links);
    const Interval reach = Chain(c.lengths, c.pivots).reach();
    const double sum = std::accumulate(c.lengths.begin(), c.lengths.end(), 0.0);
    const double longest = *std::max_element(c.lengths.begin(), c.lengths.end());
    EXPECT_NEAR(reach.hi, sum, 1e-12);
    EXPECT_NEAR(reach.lo, std::max(0.0, 2 * longest - sum), 1e-12);
  }
}

TEST(Chain, RefusesWhatIsNotAChain) {
  EXPECT_THROW(Chain({}, {}), std::invalid_argument);
  EXPECT_THROW(Chain({0.3, -0.1}, {1}), std::invalid_argument);
  EXPECT_THROW(Chain({0.3, std::nan("")}, {1}), std::invalid_argument);
  EXPECT_THROW(Chain({0.3, 0.2}, {2}), std::invalid_argument);
  EXPECT_THROW(Chain({0.3, 0.2, 0.2}, {1, 1}), std::invalid_argument);
  EXPECT_THROW(Chain({0.3, 0.2, 0.2}, {1}, {{1, {0.0, 2.0}}}), std::invalid_argument);
  const Chain chain({0.43, 0.26}, {1});
  std::vector<double> coordinates(chain.coordinate_count());
  Points points(3);
  EXPECT_THROW(chain.decode(Vec3(0.0), Vec3(0.16, 0, 0), coordinates, points), std::invalid_argument);
  EXPECT_THROW(chain.decode(Vec3(0.0), Vec3(0.70, 0, 0), coordinates, points), std::invalid_argument);
}

/// Brute force over (lp, ld): the ranges of the sum and of the difference at a given sum.
TEST(StretchDomain, RangesMatchAnExhaustiveSearch) {
  Random random(7);
  for (int trial = 0; trial < 300; ++trial) {
    const double p_hi = uniform(random, .1, 1), d_hi = uniform(random, .1, 1);
    const Interval p{trial % 3 ? uniform(random, 0, p_hi) : 0.0, p_hi},
        d{trial % 2 ? uniform(random, 0, d_hi) : 0.0, d_hi};
    const double c = uniform(random, std::max({0.0, p.lo - d.hi, d.lo - p.hi}), p.hi + d.hi);
    double s_min = 9, s_max = -9;
    const int n = 300;
    for (int i = 0; i <= n; ++i) {
      const double lp = p.lo + (p.hi - p.lo) * i / n;
      const double lo = std::max(d.lo, std::abs(c - lp)), hi = std::min(d.hi, c + lp);
      if (lo > hi) continue;
      s_min = std::min(s_min, lp / p.hi + lo / d.hi);
      s_max = std::max(s_max, lp / p.hi + hi / d.hi);
    }
    const StretchDomain domain(p, d, c);
    const auto sum_at = [&](double qs) {
      const auto [lp, ld] = domain.lengths(qs, 0.5);
      return lp / p.hi + ld / d.hi;
    };
    const double grid = 2.0 * ((p.hi - p.lo) / p.hi + 1.0 * (p.hi - p.lo) / d.hi) / n + 1e-9;
    if (s_min > 8) continue;  // the grid missed a domain narrower than its step
    ASSERT_LE(sum_at(0.0), s_min + 1e-9);
    ASSERT_GT(sum_at(0.0), s_min - grid);
    ASSERT_GE(sum_at(1.0), s_max - 1e-9);
    ASSERT_LT(sum_at(1.0), s_max + grid);
  }
}

TEST(StretchDomain, EveryFractionIsFeasibleAndInvertible) {
  Random random(8);
  for (int trial = 0; trial < 20000; ++trial) {
    const double p_hi = uniform(random, .1, 1), d_hi = uniform(random, .1, 1);
    const Interval p{uniform(random, 0, p_hi), p_hi}, d{uniform(random, 0, d_hi), d_hi};
    const double c = uniform(random, std::max({0.0, p.lo - d.hi, d.lo - p.hi}), p.hi + d.hi);
    const StretchDomain domain(p, d, c);
    const double qs = uniform(random, 0.001, .999), qd = uniform(random, 0.001, .999);
    const auto [lp, ld] = domain.lengths(qs, qd);
    ASSERT_LE(lp, p.hi + 1e-12);
    ASSERT_GE(lp, p.lo - 1e-12);
    ASSERT_LE(ld, d.hi + 1e-12);
    ASSERT_GE(ld, d.lo - 1e-12);
    ASSERT_LE(std::abs(lp - ld), c + 1e-9);
    ASSERT_GE(lp + ld, c - 1e-9);
    const auto [s2, d2] = domain.fractions(lp, ld);
    const auto [lp2, ld2] = domain.lengths(s2, d2);
    ASSERT_NEAR(lp, lp2, 1e-11);
    ASSERT_NEAR(ld, ld2, 1e-11);
  }
}

}  // namespace
}  // namespace reachcast
