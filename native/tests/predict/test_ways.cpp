// SPDX-License-Identifier: GPL-3.0-or-later
/// Whose way the hands go: learned in either form, given, from a wanted side, published, or drawn from a seed.
#include <gtest/gtest.h>

#include "predict/predict_cases.hpp"
#include "reachcast/curves/bezier.hpp"
#include "reachcast/predict/performance.hpp"

namespace reachcast {
namespace {

using enum Phase;
using namespace tests;

constexpr double kExact_m = 1e-6;

const Task kTask = task({0.05, 0.42, 0.1}, {-0.15, 0.40, 0.95});
const Body kBody = Body::from_stature(1.72);

Motion predicted(const PredictOptions& how, const Corpus& corpus = made_corpus()) {
  return predict(corpus, subject(1.72), kTask, kBody, how);
}

Vec3 hold_of(const Motion& motion, std::size_t frame) {
  const Posture& p = motion.postures[frame];
  return 0.5 * (p[index(Joint::left_grip)] + p[index(Joint::right_grip)]);
}

double distance_to_curve(const Points& control, const Vec3& point) {
  double nearest = 10.0;
  for (int k = 0; k <= 2000; ++k)
    nearest = std::min(nearest, glm::distance(point, eval_bezier(control, std::array{k / 2000.0}).front()));
  return nearest;
}

TEST(Ways, HandsFollowTheCurveThatIsGiven) {
  for (const Phase phase : {transfer, reach}) {
    PredictOptions how = options(48.0);
    how.phases = {phase};
    const HandEnds ends = hand_ends(plan_phases(how.phases, std::array{1.0}, 48.0).stages[0], kTask, kBody);
    const Vec3 start = hold_point(ends.first), end = hold_point(ends.last);
    for (const Vec3& side : {Vec3(0.2, 0.0, 0.1), Vec3(-0.1, -0.05, 0.2), Vec3(0.0)}) {
      const InnerPoints inner{start + Vec3(0, 0, 0.2) + side, end + Vec3(0, 0, 0.1) - 0.5 * side};
      how.hand_paths = {{0, inner}};
      const Motion motion = predicted(how);
      EXPECT_EQ(motion.ways, std::vector{WayForm::given});
      const Points control{start, inner[0], inner[1], end};
      for (std::size_t f = motion.plan.stages[0].first; f <= motion.plan.stages[0].last; ++f)
        ASSERT_LT(distance_to_curve(control, hold_of(motion, f)), 1e-3) << phase_name(phase) << " frame " << f;
      EXPECT_LT(worst_link(kBody, motion), kExact_m);
    }
  }
}

TEST(Ways, OnlyTheStageThatIsNamedTakesTheGivenCurve) {
  PredictOptions how = options(24.0);
  how.phases = {reach, transfer, return_};
  const Motion learned = predicted(how);
  how.hand_paths = {{1, {Vec3(0.05, 0.3, 0.5), Vec3(-0.15, 0.3, 1.2)}}};
  const Motion motion = predicted(how);
  EXPECT_EQ(motion.ways, (std::vector{WayForm::deviation, WayForm::given, WayForm::deviation}));
  for (std::size_t f = 0; f <= motion.plan.stages[0].last; ++f)
    EXPECT_LT(glm::distance(hold_of(motion, f), hold_of(learned, f)), kExact_m);
}

TEST(Ways, ComeToTheTargetFromTheSideThatIsAskedFor) {
  const Vec3 target = kTask.target + kUp, person = glm::normalize(Vec3(-target.x, -target.y, 0.0));
  for (const auto& [approach, expected] :
       {std::pair{Approach::above, Vec3(0, 0, 1)}, {Approach::front, person}, {Approach::side, Vec3(0)}}) {
    PredictOptions how = options(200.0);
    how.approach = approach;
    const Motion motion = predicted(how);
    const std::size_t last = motion.plan.stages[0].last;
    Vec3 from = glm::normalize(hold_of(motion, last - 12) - hold_of(motion, last));
    if (approach == Approach::side) {
      EXPECT_LT(std::abs(glm::dot(from, person)), 0.2);
      EXPECT_LT(std::abs(from.z), 0.2);
      EXPECT_GT(from.x, 0.9) << "home lies to the right of the target";
    } else {
      EXPECT_GT(glm::dot(from, expected), 0.97);
    }
    EXPECT_LT(glm::distance(hold_of(motion, last), target), kExact_m);
  }
}

TEST(Ways, BezierPathsAreNearThoseOfTheOtherForm) {
  PredictOptions how = options(24.0);
  const Motion deviation = predicted(how);
  how.scheme.paths = PathForm::bezier;
  const Motion bezier = predicted(how);
  EXPECT_EQ(bezier.ways, std::vector{WayForm::bezier});
  double most = 0.0;
  for (std::size_t f = 0; f < bezier.postures.size(); ++f)
    most = std::max(most, glm::distance(hold_of(deviation, f), hold_of(bezier, f)));
  EXPECT_LT(most, 0.08);
  EXPECT_GT(most, 1e-4);
}

TEST(Ways, ArePublishedOnesWhereThePhaseWasNotRecorded) {
  TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "retrieves.sqlite");
  corpus.add(std::vector{encode_reach(reversed(made_lift(1.72, {0, 0.42, 0.15}, {0, 0.42, 1.0})))});
  const Motion motion = predicted(options(24.0), corpus);
  EXPECT_EQ(motion.ways, std::vector{WayForm::published});
  ASSERT_FALSE(motion.outside_data.empty());
  expect_contains(motion.outside_data.front(), "no transfer was recorded");
  EXPECT_LT(glm::distance(hold_of(motion, motion.plan.stages[0].last), kTask.target + kUp), kExact_m);
  EXPECT_LT(worst_link(kBody, motion), kExact_m);
}

TEST(Ways, TheSameSeedDrawsTheSameMotionAndAnotherSeedAnother) {
  PredictOptions how = options(24.0);
  const Motion mean = predicted(how);
  how.variation = Variation{7, 1.0};
  const Motion first = predicted(how), again = predicted(how);
  EXPECT_EQ(first.postures, again.postures);
  how.variation->seed = 8;
  const Motion other = predicted(how);
  EXPECT_NE(first.postures, other.postures);
  how.variation->amount = 0.0;
  EXPECT_EQ(predicted(how).postures, mean.postures);
  for (const Motion* drawn : {&first, &other}) {
    EXPECT_LT(worst_link(kBody, *drawn), kExact_m);
    EXPECT_LT(glm::distance(hold_of(*drawn, drawn->plan.stages[0].last), kTask.target + kUp), kExact_m);
  }
}

/// Unit draws, one for each motion: the sum of the outer products of what they change is the covariance itself.
TEST(Ways, VaryWithTheCovarianceOfTheMotions) {
  std::vector<std::shared_ptr<const MotionCode>> codes;
  const Vec3 home(0.03, 0.42, 0.2), target(0.1, 0.4, 1.0);
  for (const double stature : {1.6, 1.7, 1.75, 1.8, 1.9})
    codes.push_back(std::make_shared<MotionCode>(encode_reach(made_lift(stature, home, target))));
  const Query query{transfer, codes[0]->home, codes[0]->target, subject(1.7), {}};
  const auto n = static_cast<Eigen::Index>(codes.size());
  const Eigen::Index tail = 500;  // posture coordinates
  Eigen::MatrixXd values(tail, n), changes(tail, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    values.col(i) = codes[static_cast<std::size_t>(i)]->coefficients.tail(tail);
    Blend blend{*codes[0], *codes[0], *codes[0], {}};
    std::vector<double> unit(codes.size(), 0.0);
    unit[static_cast<std::size_t>(i)] = 1.0;
    vary(codes, unit, query, blend);
    changes.col(i) = blend.from.coefficients.tail(tail) - codes[0]->coefficients.tail(tail);
  }
  const Eigen::MatrixXd centred = values.colwise() - values.rowwise().mean();
  const Eigen::MatrixXd covariance = centred * centred.transpose() / static_cast<double>(n - 1);
  EXPECT_LT((changes * changes.transpose() - covariance).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Ways, RefuseCurvesAndDrawsThatMakeNoSense) {
  const auto said = [&](const PredictOptions& how) {
    return message_of<std::invalid_argument>([&] { (void)predicted(how); });
  };
  PredictOptions how = options(24.0);
  how.hand_paths = {{3, {Vec3(0), Vec3(0)}}};
  expect_contains(said(how), "phase number 3, but there are 1");
  how.hand_paths = {{0, {Vec3(0, 0.4, 9.0), Vec3(0)}}};
  expect_contains(said(how), "control point 1 is (0, 0.4, 9) m");
  how.hand_paths = {{0, {Vec3(0, 0.4, 0.5), Vec3(kMissing)}}};
  expect_contains(said(how), "control point 2");
  how.hand_paths = {};
  how.variation = Variation{1, 2.5};
  expect_contains(said(how), "amount of the variation is 2.5");
}

}  // namespace
}  // namespace reachcast
