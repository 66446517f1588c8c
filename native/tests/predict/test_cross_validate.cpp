// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/cross_validate.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "predict/predict_cases.hpp"
#include "reachcast/posture/hold.hpp"
#include "reachcast/posture/linkage.hpp"
#include "reachcast/predict/blend.hpp"

namespace reachcast {
namespace {

using namespace tests;
constexpr double kSame_m = 1e-9;  // sums in another order

const std::vector<Scheme> kSchemes{
    {.k = 1},
    {.k = 5},
    {.k = 8, .smoother = Smoother::uniform},
    {.k = 3, .mirrored = false},
    {.k = 3, .sets = Sets::one},
    {.k = 4, .traits = {true, false, false, false, true}},
    {.k = 20, .measure = Measure::distances, .smoother = Smoother::kernel, .bandwidth = 0.5},
    {.k = 20, .measure = Measure::distances, .smoother = Smoother::linear, .bandwidth = 1.0, .ridge = 0.1}};

TEST(CrossValidate, GivesOneRowASchemeOverEveryMotionThatIsNoMirrorImage) {
  const auto rows = cross_validate(made_corpus(), kSchemes);
  ASSERT_EQ(rows.size(), kSchemes.size());
  std::size_t best = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const SchemeError& row = rows[i];
    EXPECT_EQ(row.scheme, kSchemes[i]);
    EXPECT_EQ(row.motions + row.out_of_reach, made_corpus().table()->of(Phase::transfer).size() / 2);
    EXPECT_GT(row.error.median_m, 0.0);
    EXPECT_LE(row.error.lower_quartile_m, row.error.median_m);
    EXPECT_LE(row.error.median_m, row.error.upper_quartile_m);
    EXPECT_LE(row.error.median_interval_m.low, row.error.median_m);
    EXPECT_LE(row.error.median_m, row.error.median_interval_m.high);
    EXPECT_EQ(row.error.groups, row.motions);
    EXPECT_TRUE(!row.is_best || (row.behind_best_m.low == 0.0 && row.behind_best_m.high == 0.0));
    EXPECT_LE(row.behind_best_m.low, row.behind_best_m.high);
    EXPECT_GE(row.behind_best_m.high, 0.0);
    if (row.error.median_m < rows[best].error.median_m) best = i;
  }
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(rows[i].is_best, i == best);
  EXPECT_EQ(cross_validate(made_corpus(), kSchemes, {.leave_out = LeaveOut::subject}).front().error.groups, 3u);
}

/// A motion of the corpus as its neighbours or its own code have it, by the functions that predict uses; nothing where
/// it cannot be held.
template <class Code>
std::optional<std::vector<Posture>> performed(const MotionSummary& m, const Code& code, const MotionCode& path_code) {
  const Body body = Body::from_stature(m.subject.stature_m, m.subject.sex);
  const BodyLinkage linkage(two_handed_linkage(), body);
  const Holder holder(two_handed_linkage(), body, usual_mass_kg(m.subject.stature_m));
  std::vector<Posture> postures;
  for (int i = 0; i <= 10; ++i) {
    const double t = 0.1 * i;
    const Vec3 hold = point_at(path_of(path_code), m.home, m.target, t), half(0.5 * m.grip_distance_m, 0.0, 0.0);
    Anchors anchors = anchors_of(body.posture());
    anchors.grip = {hold - half, hold + half};
    HoldReport report;
    postures.push_back(holder.hold(linkage.decode(coordinates_at(code, t), anchors), anchors, {hold, 0.0}, report));
    if (report.shortfall_m > 0.0) return std::nullopt;
  }
  return postures;
}

/// By the trapezoidal rule.
double mean_distance_of(const std::vector<Posture>& a, const std::vector<Posture>& b) {
  double sum = 0.0;
  for (std::size_t f = 0; f < a.size(); ++f) {
    for (std::size_t j = 0; j < 23; ++j) sum += glm::distance(a[f][j], b[f][j]) * (f == 0 || f == 10 ? 0.05 : 0.1);
  }
  return sum / 23.0;
}

double median_step_by_step(const Corpus& corpus, const Scheme& scheme, LeaveOut leave_out) {
  const auto table = corpus.table();
  const CodeOf code_of = [&](std::int64_t id) { return corpus.code(id); };
  std::vector<double> errors;
  for (const MotionSummary& m : table->motions()) {
    if (m.phase != Phase::transfer || m.is_mirrored) continue;
    const LeftOut out = [&](const MotionSummary& other) {
      return leave_out == LeaveOut::motion ? other.origin == m.origin : other.subject_id == m.subject_id;
    };
    const auto own = code_of(m.id);
    const Blend blend =
        blend_neighbours(*table, {Phase::transfer, m.home, m.target, m.subject, m.duration_s}, scheme, code_of, out);
    const auto truth = performed(m, *own, *own), guess = performed(m, blend, blend.whole);
    if (truth) errors.push_back(guess ? mean_distance_of(*truth, *guess) : 1e9);
  }
  std::sort(errors.begin(), errors.end());
  return 0.5 * (errors[(errors.size() - 1) / 2] + errors[errors.size() / 2]);
}

TEST(CrossValidate, IsWhatPredictingOneMotionAfterTheOtherGives) {
  for (const LeaveOut leave_out : {LeaveOut::motion, LeaveOut::subject}) {
    const auto rows = cross_validate(made_corpus(), kSchemes, {.leave_out = leave_out});
    for (std::size_t i = 0; i < rows.size(); ++i) {
      EXPECT_NEAR(rows[i].error.median_m, median_step_by_step(made_corpus(), kSchemes[i], leave_out), kSame_m)
          << describe(kSchemes[i]);
    }
  }
}

TEST(CrossValidate, TakesTheMedianOfTheErrorsOfSingleMotions) {
  for (const LeaveOut leave_out : {LeaveOut::motion, LeaveOut::subject}) {
    const SchemeError row = cross_validate(made_corpus(), kSchemes, {.leave_out = leave_out})[1];
    const std::vector<LeftOutError> found = left_out_errors(made_corpus(), kSchemes[1], {.leave_out = leave_out});
    ASSERT_EQ(found.size(), row.motions);
    std::vector<double> errors;
    for (std::size_t i = 0; i < found.size(); ++i) {
      errors.push_back(found[i].error_m);
      EXPECT_TRUE(i == 0 || found[i - 1].motion_id < found[i].motion_id);
    }
    std::sort(errors.begin(), errors.end());
    EXPECT_EQ(row.error.median_m, 0.5 * (errors[(errors.size() - 1) / 2] + errors[errors.size() / 2]));
  }
}

TEST(CrossValidate, DoesNotDependOnTheNumberOfThreads) {
  const auto one = cross_validate(made_corpus(), kSchemes, {.threads = 1});
  for (const unsigned threads : {2u, 5u}) {
    const auto many = cross_validate(made_corpus(), kSchemes, {.threads = threads});
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_EQ(one[i].error.median_m, many[i].error.median_m);
      EXPECT_EQ(one[i].error.upper_quartile_m, many[i].error.upper_quartile_m);
      EXPECT_EQ(one[i].error.median_interval_m.low, many[i].error.median_interval_m.low);
      EXPECT_EQ(one[i].error.median_interval_m.high, many[i].error.median_interval_m.high);
      EXPECT_EQ(one[i].is_best, many[i].is_best);
    }
  }
}

/// Three lifts of a person, each with a twin of another name.
void add_twins(Corpus& corpus) {
  std::vector<MotionCode> codes;
  for (const double z : {0.9, 1.1, 1.3}) {
    for (const char* name : {"a", "b"}) {
      Reach reach = made_lift(1.72, {0.0, 0.42, 0.2}, {0.1, 0.45, z});
      reach.origin = name + std::to_string(z);
      codes.push_back(encode_reach(reach));
    }
  }
  corpus.add(codes);
}

TEST(CrossValidate, ATwinOfEveryMotionLeavesNoError) {
  const TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "twins.sqlite");
  add_twins(corpus);
  const std::vector<Scheme> nearest{{.k = 1}};
  EXPECT_LT(cross_validate(corpus, nearest).front().error.median_m, kSame_m);
  EXPECT_THROW((void)cross_validate(corpus, nearest, {.leave_out = LeaveOut::subject}), std::invalid_argument);
  EXPECT_THROW((void)cross_validate(corpus, {}), std::invalid_argument);
  EXPECT_THROW((void)cross_validate(corpus, std::vector<Scheme>{{.k = 0}}), std::invalid_argument);
}

/// A path that swings out by metres can be held by nobody: neither as the motion itself nor as a prediction.
TEST(CrossValidate, APredictionThatCannotBeHeldIsInfinitelyWrong) {
  const TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "swing.sqlite");
  MotionCode swing = encode_reach(made_lift(1.72, {0.0, 0.42, 0.2}, {0.1, 0.45, 1.2}));
  EndpointPath path = path_of(swing);
  path.deviation.col(0).setConstant(5.0);
  set_path(swing, path);
  swing.origin = "swing";
  corpus.add(std::vector{encode_reach(made_lift(1.72, {0.0, 0.42, 0.2}, {0.1, 0.45, 1.1})), swing});
  const SchemeError row = cross_validate(corpus, std::vector<Scheme>{{.k = 1}}).front();
  EXPECT_EQ(row.motions, 1u);
  EXPECT_EQ(row.out_of_reach, 1u);
  EXPECT_EQ(row.failed, 1u);
  EXPECT_TRUE(std::isinf(row.error.median_m));
  EXPECT_EQ(row.behind_best_m.high, 0.0);
  EXPECT_EQ(natural_variation(corpus, 0.2).out_of_reach, 1u);
}

TEST(NaturalVariation, OfTwinsIsNone) {
  const TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "twins.sqlite");
  add_twins(corpus);
  const NaturalVariation variation = natural_variation(corpus);
  EXPECT_EQ(variation.pairs, 3u);
  EXPECT_EQ(variation.error.groups, 1u);
  EXPECT_LT(variation.error.upper_quartile_m, kSame_m);
}

/// With targets 20 cm apart every lift has four partners up or down the row, two on each side but for the ends.
TEST(NaturalVariation, CountsPairsOfOnePersonWithinTheLimit) {
  const TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "twins.sqlite");
  add_twins(corpus);
  EXPECT_EQ(natural_variation(corpus, 0.25).pairs, 3u + 8u);
  EXPECT_EQ(natural_variation(corpus, 0.45).pairs, 15u);
  EXPECT_GT(natural_variation(corpus, 0.45).error.median_m, 1e-3);
  EXPECT_EQ(natural_variation(made_corpus(), 0.05).pairs, 0u);
  EXPECT_EQ(natural_variation(made_corpus(), 0.05).error.median_m, 0.0);
  EXPECT_THROW((void)natural_variation(corpus, -0.1), std::invalid_argument);
}

/// Leaving out one of two motions leaves the other: its error is that of a pair.
TEST(NaturalVariation, IsOnTheMeasureOfTheCrossValidation) {
  const TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "pair.sqlite");
  corpus.add(std::vector{encode_reach(made_lift(1.72, {0.0, 0.42, 0.2}, {0.1, 0.45, 1.2})),
                         encode_reach(made_lift(1.72, {0.03, 0.40, 0.25}, {0.12, 0.44, 1.17}))});
  const auto rows = cross_validate(corpus, std::vector<Scheme>{{.k = 1}});
  ASSERT_EQ(rows.front().motions, 2u);
  const NaturalVariation variation = natural_variation(corpus, 0.10);
  ASSERT_EQ(variation.pairs, 1u);
  EXPECT_GT(variation.error.median_m, 1e-3);
  EXPECT_NEAR(variation.error.median_m, rows.front().error.median_m, kSame_m);  // of two values: their mean
}

}  // namespace
}  // namespace reachcast
