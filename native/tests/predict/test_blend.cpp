// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/blend.hpp"

#include <gtest/gtest.h>

#include "predict/predict_cases.hpp"
#include "reachcast/posture/whole_body.hpp"

namespace reachcast {
namespace {

using namespace tests;
constexpr double kRounding = 1e-12;

Blend blended(const Query& query, const Scheme& scheme) {
  const auto table = made_corpus().table();
  return blend_neighbours(*table, query, scheme, [](std::int64_t id) { return made_corpus().code(id); });
}

const Query kQuery{Phase::transfer, {0.0, 0.41, 0.3}, {0.1, 0.40, 1.05}, subject(1.68), 1.2};

/// p. 546: the motion of one person on another body and to another target.
TEST(Blend, OneNeighbourIsARecordedMotionAsItIs) {
  const Blend blend = blended(kQuery, {.k = 1});
  ASSERT_EQ(blend.neighbours.size(), 1u);
  EXPECT_EQ(blend.neighbours.front().weight, 1.0);
  const auto own = made_corpus().code(blend.neighbours.front().id);
  for (const double t : {0.0, 0.3, 0.7, 1.0}) {
    EXPECT_LT((coordinates_at(blend, t) - coordinates_at(*own, t)).norm(), kRounding) << t;
    EXPECT_NEAR(progress(path_of(blend.whole), t), progress(path_of(*own), t), kRounding) << t;
  }
  EXPECT_EQ(blend.whole.duration_s, own->duration_s);
}

TEST(Blend, NeighboursAreTheMeanOfBothSets) {
  const auto table = made_corpus().table();
  const Scheme scheme{.k = 5};
  std::map<std::int64_t, double> weights;
  for (const End end : {End::home, End::target}) {
    for (const Neighbour& n : nearest_motions(*table, kQuery, end, scheme)) weights[n.id] += 0.5 * n.weight;
  }
  const Blend blend = blended(kQuery, scheme);
  ASSERT_EQ(blend.neighbours.size(), weights.size());
  double last = 1.0;
  for (const Neighbour& n : blend.neighbours) {
    EXPECT_NEAR(n.weight, weights.at(n.id), kRounding);
    EXPECT_LE(n.weight, last);
    last = n.weight;
  }
}

/// Seconds of the made lifts are those of their frames: a line through them must not leave what was recorded.
TEST(Blend, ALocalLineKeepsToRecordedDurations) {
  Query far = kQuery;
  far.target.z = 2.5;
  const Scheme line{.k = 12, .smoother = Smoother::linear, .bandwidth = 2.0, .ridge = 1e-3};
  const Blend blend = blended(far, line);
  double shortest = 1e9, longest = 0.0, least = 0.0, sum = 0.0;
  for (const Neighbour& n : blend.neighbours) {
    const double seconds = made_corpus().code(n.id)->duration_s;
    shortest = std::min(shortest, seconds);
    longest = std::max(longest, seconds);
    least = std::min(least, n.weight);
    sum += n.weight;
  }
  EXPECT_LT(least, 0.0) << "the case is one in which weights are negative";
  EXPECT_NEAR(sum, 1.0, 1e-9);
  EXPECT_GE(blend.whole.duration_s, shortest);
  EXPECT_LE(blend.whole.duration_s, longest);
}

}  // namespace
}  // namespace reachcast
