// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "simulate_cases.hpp"

namespace reachcast::simulate::tests {
namespace {

TEST(Effort, JacobianAgreesWithOneSidedDifferencesOfEveryTerm) {
  const Person& person = people()[12];
  const PoseModel model(person.body, *person.subject.mass_kg);
  const Effort effort(person, model);
  for (const Vec3& place : {kOnFloor, kAtWaist, kAtSide}) {
    const Holding holding = holding_at(model, place, 5.0);
    const auto residuals = [&](const Unknowns& x) { return effort.residuals(x, holding); };
    const Unknowns x = least_effort(effort, holding).x + Unknowns::Constant(0.01);  // off the kinks of the optimum
    const Jacobian central = jacobian_of(residuals, x);
    const Residuals here = residuals(x);
    for (Eigen::Index i = 0; i < kUnknowns; ++i) {
      Unknowns more = x;
      more[i] += 1e-6;
      const Residuals one_sided = (residuals(more) - here) / 1e-6;
      EXPECT_LT((one_sided - central.col(i)).cwiseAbs().maxCoeff(), 2e-2 * (1.0 + central.col(i).norm())) << i;
    }
  }
}

TEST(Effort, MomentsOfAnUprightStandAreThoseOfThePlumbLine) {
  const Person& person = people()[15];
  const double mass = *person.subject.mass_kg;
  Pose pose;
  pose.posture = person.body.posture();
  const PoseModel model(person.body, mass);
  Holding holding;
  holding.anchors = anchors_of(pose.posture);
  const JointMoments empty = joint_moments(pose, mass, holding);
  EXPECT_LT(std::abs(empty.back_forward), 25.0);
  EXPECT_NEAR(empty.back_sideways, 0.0, 1e-9);
  // 10 kg held 0.4 m ahead of l5s1 and, for the shoulders, 5 kg in each hand at its own lever.
  holding.load = {pose.posture[index(Joint::l5s1)] + Vec3(0.0, 0.4, 0.0), 10.0};
  const JointMoments loaded = joint_moments(pose, mass, holding);
  EXPECT_NEAR(loaded.back_forward - empty.back_forward, 9.81 * 10.0 * 0.4, 1e-9);
  holding.load.centre.x += 0.1;
  EXPECT_NEAR(joint_moments(pose, mass, holding).back_sideways, 9.81 * 10.0 * 0.1, 1e-9);
}

TEST(LeastSquares, FindsTheKnownMinimumOfALinearProblem) {
  std::mt19937_64 random(3);
  Jacobian slope;
  for (Eigen::Index i = 0; i < kUnknowns; ++i) {
    const Unknowns column = random_unknowns(random, 1.0);
    for (Eigen::Index j = 0; j < kResiduals; ++j) slope(j, i) = std::sin(1.0 + column[j % kUnknowns] * double(j + 1));
  }
  const Unknowns truth = random_unknowns(random, 2.0);
  const auto residuals = [&](const Unknowns& x) -> Residuals { return slope * (x - truth); };
  EXPECT_LT((least_squares(residuals, Unknowns::Zero(), 100).x - truth).norm(), 1e-3);
}

/// All other unknowns found anew for each of a grid of the two that decide between stoop and squat.
TEST(LeastEffort, NoStretchOfABruteForceGridIsCheaper) {
  for (const double liking : {-1.0, 0.1, 1.0}) {
    const Person& person = who_squats(liking);
    const PoseModel model(person.body, *person.subject.mass_kg);
    const Effort effort(person, model);
    const Holding holding = holding_at(model, kOnFloor, 8.0);
    const Solution best = least_effort(effort, holding);
    for (double sum = -4.0; sum <= 4.0; sum += 1.0) {
      for (double difference = -4.0; difference <= 4.0; difference += 1.0) {
        for (const double shoulder : {-1.0, 1.0, 3.0}) {
          Unknowns x = best.x;
          x[0] = sum, x[1] = difference, x[3] = shoulder;
          EXPECT_GT(effort.cost(x, holding), best.cost - 1e-6);
        }
      }
    }
  }
}

TEST(LeastEffort, NoSmallStepInAnyDirectionIsCheaper) {
  std::mt19937_64 random(5);
  for (const std::size_t who : {1u, 8u, 17u}) {
    const PoseModel model(people()[who].body, *people()[who].subject.mass_kg);
    const Effort effort(people()[who], model);
    for (const Vec3& place : {kOnFloor, kAtWaist, kAtEyes, kAtSide}) {
      const Holding holding = holding_at(model, place, 5.0);
      const Solution best = least_effort(effort, holding);
      double cheapest = best.cost;
      for (int i = 0; i < 300; ++i)
        cheapest = std::min(cheapest, effort.cost(best.x + random_unknowns(random, 0.03), holding));
      EXPECT_GT(cheapest, 0.99 * best.cost);
    }
  }
}

TEST(LeastEffort, StoopersSpareTheirKneesAndSquattersTheirBacks) {
  const auto floor_lift = [](const Person& person) {
    const PoseModel model(person.body, *person.subject.mass_kg);
    const Effort effort(person, model);
    const Holding holding = holding_at(model, kOnFloor, 8.0);
    return joint_angles(model.pose(least_effort(effort, holding).x, holding.anchors, holding.load));
  };
  const JointAngles stoop = floor_lift(who_squats(-1.0)), squat = floor_lift(who_squats(1.0));
  EXPECT_GT(squat.knee[0], stoop.knee[0] + 0.6);
  EXPECT_GT(stoop.back.x, squat.back.x + 0.3);
}

/// Raising the weight of a term lowers it at the optimum.
TEST(LeastEffort, WeakerPeopleChoosePosturesOfLesserMoments) {
  const Person& strong = who_squats(0.0);
  Person weak = strong;
  weak.strength *= 0.5;
  const PoseModel model(strong.body, *strong.subject.mass_kg);
  const EffortWeights weights = weights_of(strong);
  for (const Vec3& place : {kOnFloor, kAtWaist, kAtEyes}) {
    const Holding holding = holding_at(model, place, 8.0);
    const auto loaded = [&](const Person& person) {
      const Unknowns x = least_effort(Effort(person, model), holding).x;
      const JointMoments m = joint_moments(model.pose(x, holding.anchors, holding.load), model.body_mass_kg(), holding);
      double sum =
          std::pow(weights.back * m.back_forward / 240.0, 2) + std::pow(weights.back * m.back_sideways / 150.0, 2);
      for (const std::size_t side : {0u, 1u})
        sum += std::pow(weights.knees * m.knee[side] / 170.0, 2) +
               std::pow(weights.shoulders * m.shoulder[side] / 75.0, 2);
      return sum;
    };
    EXPECT_LT(loaded(weak), loaded(strong));
  }
}

TEST(LeastEffort, AHeavierBoxIsHeldInAnotherPosture) {
  const Person& person = who_squats(0.0);
  const PoseModel model(person.body, *person.subject.mass_kg);
  const Effort effort(person, model);
  const Holding light = holding_at(model, kOnFloor, 1.0), heavy = holding_at(model, kOnFloor, 20.0);
  const Unknowns one = least_effort(effort, light).x, other = least_effort(effort, heavy).x;
  EXPECT_LT(effort.cost(other, heavy), 0.99 * effort.cost(one, heavy));
  EXPECT_LT(effort.cost(one, light), effort.cost(other, light));
}

}  // namespace
}  // namespace reachcast::simulate::tests
