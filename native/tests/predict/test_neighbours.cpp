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

/// Coarse values, so that equal differences are common; eighths and their parts, so that they are equal in double too.
double coarse(std::mt19937_64& random, double step, unsigned most) {
  return step * static_cast<double>(random() % most);
}

Subject random_subject(std::mt19937_64& random) {
  Subject s{.stature_m = 1.5 + coarse(random, 0.0625, 8), .sex = {}, .age_years = {}, .mass_kg = {}};
  if (random() % 3) s.sex = random() % 2 ? Sex::female : Sex::male;
  if (random() % 3) s.age_years = 20.0 + coarse(random, 4.0, 10);
  if (random() % 3) s.mass_kg = 50.0 + coarse(random, 8.0, 5);
  return s;
}

std::vector<MotionSummary> random_motions(std::mt19937_64& random, int count) {
  std::vector<MotionSummary> motions;
  for (int i = 0; i < count; ++i) {
    MotionSummary m;
    m.id = 3 * i + 7;
    m.origin = "motion " + std::to_string(i);
    m.is_mirrored = random() % 2 == 1;
    m.phase = random() % 4 == 0 ? Phase::reach : Phase::transfer;
    m.subject = random_subject(random);
    m.duration_s = 0.5 + coarse(random, 0.25, 6);
    m.home = {coarse(random, 0.125, 3), 0.375, coarse(random, 0.25, 4)};
    m.target = {coarse(random, 0.25, 4), 0.375, coarse(random, 0.375, 5)};
    motions.push_back(m);
  }
  motions.front().phase = Phase::transfer;
  motions.front().is_mirrored = false;
  return motions;
}

Query random_query(std::mt19937_64& random) {
  return {Phase::transfer,
          {0.125, 0.375, 0.5},
          {0.25, 0.375, 0.875},
          random_subject(random),
          0.5 + coarse(random, 0.125, 12)};
}

/// Any traits, with scales that divide exactly.
Scheme random_scheme(std::mt19937_64& random) {
  Scheme s{.k = 1 + static_cast<int>(random() % 12)};
  s.measure = random() % 2 ? Measure::ranks : Measure::distances;
  s.task = random() % 4 != 0;
  for (bool& trait : s.traits) trait = random() % 2 == 0;
  s.traits[0] = s.traits[0] || !s.task;
  s.mirrored = random() % 3 != 0;
  s.task_scale_m = 0.5;
  s.trait_scales = {0.125, 8.0, 1.0, 4.0, 0.5};
  return s;
}

double squared_task(const MotionSummary& m, const Query& q, End end) {
  const Vec3 home = m.home - q.home, target = m.target - q.target;
  const double other = kOtherEnd * kOtherEnd;
  return (end == End::target ? other : 1.0) * glm::dot(home, home) +
         (end == End::home ? other : 1.0) * glm::dot(target, target);
}

/// By Trait.
std::array<std::optional<double>, kTraitCount> traits(const Subject& s, const std::optional<double>& duration_s) {
  const auto sex = s.sex ? std::optional(*s.sex == Sex::male ? 1.0 : 0.0) : std::nullopt;
  return {s.stature_m, s.age_years, sex, s.mass_kg, duration_s};
}

/// Rank sum or scaled distance by the definitions in scheme.hpp, by counting: a rank is the number of those nearer.
double score_by_counting(const std::vector<MotionSummary>& pool, const MotionSummary& m, const Query& q, End end,
                         const Scheme& scheme) {
  double score = 0.0;
  const auto count = [&](const auto& is_nearer) {
    return static_cast<double>(std::count_if(pool.begin(), pool.end(), is_nearer));
  };
  if (scheme.task && scheme.measure == Measure::ranks) {
    score += count([&](const auto& o) { return squared_task(o, q, end) < squared_task(m, q, end); });
  } else if (scheme.task) {
    score += squared_task(m, q, end) / (scheme.task_scale_m * scheme.task_scale_m);
  }
  const auto wanted = traits(q.subject, q.duration_s), own = traits(m.subject, m.duration_s);
  for (std::size_t t = 0; t < kTraitCount; ++t) {
    if (!scheme.traits[t] || !wanted[t]) continue;
    const auto value = [&](const MotionSummary& o) { return traits(o.subject, o.duration_s)[t]; };
    if (scheme.measure == Measure::distances) {
      const double away = own[t] ? (*own[t] - *wanted[t]) / scheme.trait_scales[t] : 1.0;
      score += away * away;
    } else if (own[t]) {
      score += count(
          [&](const auto& o) { return value(o) && std::abs(*value(o) - *wanted[t]) < std::abs(*own[t] - *wanted[t]); });
    } else {
      score += std::floor(0.5 * count([&](const auto& o) { return value(o).has_value(); }));
    }
  }
  return score;
}

std::vector<std::int64_t> nearest_by_counting(const std::vector<MotionSummary>& motions, const Query& q, End end,
                                              const Scheme& scheme, const LeftOut& left_out) {
  std::vector<MotionSummary> pool;
  std::copy_if(motions.begin(), motions.end(), std::back_inserter(pool), [&](const MotionSummary& m) {
    return m.phase == q.phase && (scheme.mirrored || !m.is_mirrored) && !left_out(m);
  });
  std::vector<std::pair<double, std::int64_t>> scores;
  for (const MotionSummary& m : pool) scores.emplace_back(score_by_counting(pool, m, q, end, scheme), m.id);
  std::sort(scores.begin(), scores.end());
  std::vector<std::int64_t> ids;
  for (std::size_t i = 0; i < scores.size() && i < static_cast<std::size_t>(scheme.k); ++i)
    ids.push_back(scores[i].second);
  return ids;
}

std::vector<std::int64_t> ids_of(const std::vector<Neighbour>& nearest) {
  std::vector<std::int64_t> ids;
  for (const Neighbour& n : nearest) ids.push_back(n.id);
  return ids;
}

TEST(Neighbours, AreThoseOfTheSchemeByCounting) {
  std::mt19937_64 random(549);
  for (int trial = 0; trial < 600; ++trial) {
    const std::vector<MotionSummary> motions =
        random_motions(random, 2 + static_cast<int>(random() % (trial % 20 == 0 ? 500 : 60)));
    const MotionTable table(motions);
    const Query query = random_query(random);
    const Scheme scheme = trial % 3 == 0 ? Scheme{.k = 1 + trial % 12} : random_scheme(random);
    const LeftOut left_out = [&](const MotionSummary& m) { return trial % 2 == 0 && m.id % 5 == 0; };
    for (const End end : {End::home, End::target, End::both}) {
      const auto expected = nearest_by_counting(motions, query, end, scheme, left_out);
      ASSERT_FALSE(expected.empty());
      ASSERT_EQ(ids_of(nearest_motions(table, query, end, scheme, left_out)), expected) << trial << describe(scheme);
    }
  }
}

TEST(Neighbours, OneSearchServesManySchemes) {
  std::mt19937_64 random(3);
  const std::vector<MotionSummary> motions = random_motions(random, 300);
  const MotionTable table(motions);
  const Query query = random_query(random);
  Search shared(table, query);
  for (int trial = 0; trial < 100; ++trial) {
    const Scheme scheme = random_scheme(random);
    const End end = static_cast<End>(random() % 3);
    Search alone(table, query);
    ASSERT_EQ(shared.nearest(scheme, end), alone.nearest(scheme, end)) << trial << describe(scheme);
  }
}

/// Root mean square distance from the mean, in two passes.
double spread_of(const std::vector<MotionSummary>& motions, Vec3 MotionSummary::*place) {
  Vec3 mean(0.0);
  for (const MotionSummary& m : motions) mean += m.*place / static_cast<double>(motions.size());
  double squares = 0.0;
  for (const MotionSummary& m : motions) squares += glm::dot(m.*place - mean, m.*place - mean);
  return std::sqrt(squares / static_cast<double>(motions.size()));
}

TEST(Neighbours, DistancesAreInSpreadsOfTheMotionsThatMayTakePart) {
  std::mt19937_64 random(17);
  for (int trial = 0; trial < 50; ++trial) {
    const std::vector<MotionSummary> motions = random_motions(random, 120);
    std::vector<MotionSummary> rest;
    const auto out = [](const MotionSummary& m) { return m.id % 4 == 0; };
    std::copy_if(motions.begin(), motions.end(), std::back_inserter(rest),
                 [&](const auto& m) { return !out(m) && m.phase == Phase::transfer; });
    Scheme scheme{.k = 9, .measure = Measure::distances};
    const Query query = random_query(random);
    const auto found = ids_of(nearest_motions(MotionTable(motions), query, End::home, scheme, out));
    const double home = spread_of(rest, &MotionSummary::home), target = spread_of(rest, &MotionSummary::target);
    scheme.task_scale_m = std::hypot(home, kOtherEnd * target);
    double mean = 0.0, squares = 0.0;
    for (const auto& m : rest) mean += m.subject.stature_m / static_cast<double>(rest.size());
    for (const auto& m : rest) squares += (m.subject.stature_m - mean) * (m.subject.stature_m - mean);
    scheme.trait_scales[0] = std::sqrt(squares / static_cast<double>(rest.size()));
    EXPECT_EQ(found, nearest_by_counting(rest, query, End::home, scheme, [](const auto&) { return false; })) << trial;
  }
}

TEST(Neighbours, LeavingOutIsAsIfTheyWereNotThere) {
  std::mt19937_64 random(8);
  for (int trial = 0; trial < 100; ++trial) {
    const std::vector<MotionSummary> motions = random_motions(random, 80);
    std::vector<MotionSummary> rest;
    const auto out = [](const MotionSummary& m) { return m.id % 5 == 0; };
    std::copy_if(motions.begin(), motions.end(), std::back_inserter(rest), [&](const auto& m) { return !out(m); });
    const Query query = random_query(random);
    Scheme scheme = random_scheme(random);
    scheme.smoother = static_cast<Smoother>(random() % 4);
    const auto a = nearest_motions(MotionTable(motions), query, End::home, scheme, out);
    const auto b = nearest_motions(MotionTable(rest), query, End::home, scheme);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].id, b[i].id) << trial;
      EXPECT_NEAR(a[i].weight, b[i].weight, 1e-9) << trial;  // spreads are sums in another order
    }
  }
}

TEST(Neighbours, WeightsAreTriangularUnlessTheSchemeSaysUniform) {
  std::mt19937_64 random(5);
  const MotionTable table(random_motions(random, 40));
  const Query query = random_query(random);
  for (const int k : {1, 2, 5, 12}) {
    const auto nearest = nearest_motions(table, query, End::target, {.k = k});
    const auto uniform = nearest_motions(table, query, End::target, {.k = k, .smoother = Smoother::uniform});
    ASSERT_EQ(nearest.size(), static_cast<std::size_t>(k));
    for (int i = 0; i < k; ++i) {
      EXPECT_NEAR(nearest[static_cast<std::size_t>(i)].weight, (k - i) / (0.5 * k * (k + 1)), kRounding);
      EXPECT_NEAR(uniform[static_cast<std::size_t>(i)].weight, 1.0 / k, kRounding);
    }
  }
}

TEST(Neighbours, KernelWeightsFallWithTheDistanceInScales) {
  std::mt19937_64 random(6);
  const std::vector<MotionSummary> motions = random_motions(random, 60);
  const Query query = random_query(random);
  Scheme scheme{.k = 20, .smoother = Smoother::kernel, .bandwidth = 0.75, .task_scale_m = 0.5};
  scheme.trait_scales[0] = 0.125;
  const auto nearest = nearest_motions(MotionTable(motions), query, End::target, scheme);
  double sum = 0.0;
  std::vector<double> expected;
  for (const Neighbour& n : nearest) {
    const double task = std::hypot(n.target_distance_m, kOtherEnd * n.home_distance_m) / 0.5;
    const double distance = std::hypot(task, n.stature_difference_m / 0.125) / 0.75;
    expected.push_back(std::exp(-0.5 * distance * distance));
    sum += expected.back();
  }
  for (std::size_t i = 0; i < nearest.size(); ++i) EXPECT_NEAR(nearest[i].weight, expected[i] / sum, kRounding) << i;
}

MotionSummary plain_motion() {
  MotionSummary m;
  m.subject.stature_m = 1.7;
  return m;
}

Query plain_query() {
  Query query;
  query.subject.stature_m = 1.7;
  return query;
}

TEST(Neighbours, EqualMotionsComeInTheOrderOfTheirIdsHoweverTheyAreListed) {
  MotionSummary m = plain_motion();
  std::vector<MotionSummary> motions;
  for (const int id : {9, 2, 31, 4}) {
    m.id = id;
    motions.push_back(m);
  }
  const auto nearest = nearest_motions(MotionTable(motions), plain_query(), End::home, {.k = 3});
  EXPECT_EQ(ids_of(nearest), (std::vector<std::int64_t>{2, 4, 9}));
}

TEST(Neighbours, FewerMotionsThanAskedForAreAllTaken) {
  for (const Smoother smoother : {Smoother::uniform, Smoother::triangular, Smoother::kernel, Smoother::linear}) {
    const auto nearest =
        nearest_motions(MotionTable({plain_motion()}), plain_query(), End::target, {.k = 5, .smoother = smoother});
    ASSERT_EQ(nearest.size(), 1u);
    EXPECT_NEAR(nearest[0].weight, 1.0, kRounding);
  }
}

TEST(Neighbours, RefusesWhatCannotBeCompared) {
  const MotionTable table({plain_motion()}), none({});
  MotionSummary image = plain_motion();
  image.is_mirrored = true;
  const auto refuses = [](const MotionTable& t, const Query& q, const Scheme& s) {
    EXPECT_THROW((void)nearest_motions(t, q, End::target, s), std::invalid_argument) << describe(s);
  };
  Query reach = plain_query();
  reach.phase = Phase::reach;
  refuses(table, plain_query(), {.k = 0});
  refuses(table, reach, {});
  refuses(none, plain_query(), {});
  refuses(table, plain_query(), {.traits = {false, false, false, false, true}});  // no duration is given
  refuses(table, plain_query(), {.task = false, .traits = {false, true}});        // nor an age
  refuses(MotionTable({image}), plain_query(), {.mirrored = false});
}

}  // namespace
}  // namespace reachcast
