// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/neighbours.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>

namespace reachcast {
namespace {

constexpr double kOtherEnd = 0.25;  // what the header says of the far end's distance
constexpr double kRounding = 1e-12;

std::vector<MotionSummary> random_motions(std::mt19937_64& random, int count) {
  // Coarse values, so that equal distances and statures are common; eighths, so that they are equal in double too.
  const auto coarse = [&](double step, int most) {
    return step * static_cast<double>(random() % static_cast<unsigned>(most));
  };
  std::vector<MotionSummary> motions;
  for (int i = 0; i < count; ++i) {
    MotionSummary m;
    m.id = 3 * i + 7;
    m.origin = "motion " + std::to_string(i);
    m.is_mirrored = random() % 2 == 1;
    m.phase = random() % 4 == 0 ? Phase::reach : Phase::transfer;
    m.subject.stature_m = 1.5 + coarse(0.0625, 8);
    m.home = {coarse(0.125, 3), 0.375, coarse(0.25, 4)};
    m.target = {coarse(0.25, 4), 0.375, coarse(0.375, 5)};
    motions.push_back(m);
  }
  return motions;
}

double task_distance(const MotionSummary& m, const Query& q, End end) {
  const Vec3 home = m.home - q.home, target = m.target - q.target;
  const Vec3 near = end == End::target ? target : home, far = end == End::target ? home : target;
  return glm::dot(near, near) + kOtherEnd * kOtherEnd * glm::dot(far, far);  // its square
}

/// Ids of the k motions with the smallest rank sums, by the definition: a rank is the number of motions that are
/// nearer.
std::vector<std::int64_t> nearest_by_counting(const std::vector<MotionSummary>& motions, const Query& q, End end,
                                              int k) {
  std::vector<std::pair<int, std::int64_t>> scores;
  for (const MotionSummary& m : motions) {
    if (m.phase != q.phase) continue;
    int nearer = 0;
    for (const MotionSummary& other : motions) {
      if (other.phase != q.phase) continue;
      if (task_distance(other, q, end) < task_distance(m, q, end)) ++nearer;
      if (std::abs(other.subject.stature_m - q.stature_m) < std::abs(m.subject.stature_m - q.stature_m)) ++nearer;
    }
    scores.emplace_back(nearer, m.id);
  }
  std::sort(scores.begin(), scores.end());
  std::vector<std::int64_t> ids;
  for (std::size_t i = 0; i < scores.size() && i < static_cast<std::size_t>(k); ++i) ids.push_back(scores[i].second);
  return ids;
}

TEST(Neighbours, AreThoseOfARankSumByCounting) {
  std::mt19937_64 random(549);
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<MotionSummary> motions =
        random_motions(random, 2 + static_cast<int>(random() % (trial % 10 == 0 ? 600 : 60)));
    motions.front().phase = Phase::transfer;
    const Query query{
        Phase::transfer, {0.125, 0.375, 0.5}, {0.25, 0.375, 0.875}, 1.5 + 0.03125 * static_cast<double>(random() % 16)};
    const int k = 1 + static_cast<int>(random() % 12);
    const MotionTable table(motions);
    for (const End end : {End::home, End::target}) {
      std::vector<std::int64_t> ids;
      for (const Neighbour& n : nearest_motions(table, query, end, k)) ids.push_back(n.id);
      ASSERT_EQ(ids, nearest_by_counting(motions, query, end, k)) << trial;
    }
  }
}

TEST(Neighbours, LeavingOutIsAsIfTheyWereNotThere) {
  std::mt19937_64 random(8);
  for (int trial = 0; trial < 50; ++trial) {
    const std::vector<MotionSummary> motions = random_motions(random, 80);
    std::vector<MotionSummary> rest;
    const auto out = [](const MotionSummary& m) { return m.id % 5 == 0; };
    std::copy_if(motions.begin(), motions.end(), std::back_inserter(rest), [&](const auto& m) { return !out(m); });
    const Query query{Phase::transfer, {}, {0.25, 0.375, 0.875}, 1.7};
    const auto a = nearest_motions(MotionTable(motions), query, End::home, 7, out);
    const auto b = nearest_motions(MotionTable(rest), query, End::home, 7);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].id, b[i].id) << trial;
  }
}

TEST(Neighbours, WeightsAreTriangular) {
  std::mt19937_64 random(5);
  const MotionTable table(random_motions(random, 40));
  for (const int k : {1, 2, 5, 12}) {
    const auto nearest = nearest_motions(table, {Phase::transfer, {}, {0, 0.4, 1}, 1.7}, End::target, k);
    ASSERT_EQ(nearest.size(), static_cast<std::size_t>(k));
    for (int i = 0; i < k; ++i)
      EXPECT_NEAR(nearest[static_cast<std::size_t>(i)].weight, (k - i) / (0.5 * k * (k + 1)), kRounding);
  }
}

TEST(Neighbours, EqualMotionsComeInTheOrderOfTheirIdsHoweverTheyAreListed) {
  MotionSummary m;
  m.subject.stature_m = 1.7;
  std::vector<MotionSummary> motions;
  for (const int id : {9, 2, 31, 4}) {
    m.id = id;
    motions.push_back(m);
  }
  const auto nearest = nearest_motions(MotionTable(motions), {Phase::transfer, {}, {}, 1.7}, End::home, 3);
  ASSERT_EQ(nearest.size(), 3u);
  EXPECT_EQ(nearest[0].id, 2);
  EXPECT_EQ(nearest[1].id, 4);
  EXPECT_EQ(nearest[2].id, 9);
}

TEST(Neighbours, FewerMotionsThanAskedForAreAllTaken) {
  MotionSummary m;
  m.subject.stature_m = 1.7;
  const auto nearest = nearest_motions(MotionTable({m}), {Phase::transfer, {}, {}, 1.7}, End::target, 5);
  ASSERT_EQ(nearest.size(), 1u);
  EXPECT_EQ(nearest[0].weight, 1.0);
}

TEST(Neighbours, RefusesNoNeighboursAndNoMotions) {
  MotionSummary m;
  m.phase = Phase::reach;
  EXPECT_THROW((void)nearest_motions(MotionTable({m}), {Phase::reach, {}, {}, 1.7}, End::target, 0),
               std::invalid_argument);
  EXPECT_THROW((void)nearest_motions(MotionTable({m}), {Phase::transfer, {}, {}, 1.7}, End::target, 3),
               std::invalid_argument);
  EXPECT_THROW((void)nearest_motions(MotionTable({}), {Phase::transfer, {}, {}, 1.7}, End::target, 3),
               std::invalid_argument);
}

}  // namespace
}  // namespace reachcast
