// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/plan.hpp"

#include <gtest/gtest.h>

#include "predict/predict_cases.hpp"

namespace reachcast {
namespace {

using enum Phase;

std::vector<std::string> names(const Plan& plan) {
  std::vector<std::string> out;
  for (const Event& event : plan.events) out.push_back(event.name);
  return out;
}

TEST(Plan, AllFourPhasesNameEveryGraspAndRelease) {
  const std::vector<Phase> phases{reach, transfer, return_, reach, retrieve, return_};
  const Plan plan = plan_phases(phases, std::vector(6, 1.0), 24.0);
  EXPECT_EQ(names(plan), (std::vector<std::string>{"grasp", "lift_off", "placed", "release", "grasp_2", "lift_off_2",
                                                   "placed_2", "release_2", "end"}));
  for (std::size_t i = 1; i < plan.events.size(); ++i) EXPECT_LE(plan.events[i - 1].frame, plan.events[i].frame);
  for (std::size_t i = 0; i < plan.stages.size(); ++i) {
    const Stage& stage = plan.stages[i];
    EXPECT_EQ(stage.last - stage.first, 24u);
    EXPECT_LE(stage.body_first, stage.first);
    EXPECT_GE(stage.body_last, stage.last);
    if (i > 0) {
      EXPECT_EQ(stage.body_first, plan.stages[i - 1].body_last);
      EXPECT_GT(stage.first, plan.stages[i - 1].last) << "hands pause";
    }
  }
}

TEST(Plan, ObjectStandsWhereTheFirstLoadedPhaseTakesItFrom) {
  EXPECT_EQ(first_place(std::vector{reach, transfer}), Place::home);
  EXPECT_EQ(first_place(std::vector{return_, reach, retrieve}), Place::target);
  EXPECT_EQ(first_place(std::vector{return_, reach, transfer}), Place::home);
  EXPECT_EQ(first_place(std::vector{reach}), Place::target);
  EXPECT_EQ(first_place(std::vector{transfer, retrieve, transfer}), Place::home);
}

TEST(Plan, PostureTimeRunsFromRestToRestWithoutAStep) {
  const Plan plan = plan_phases(std::vector{reach, transfer, return_}, std::vector{0.8, 1.3, 0.6}, 50.0);
  for (const Stage& stage : plan.stages) {
    EXPECT_DOUBLE_EQ(posture_time(stage, stage.body_first), 0.0);
    EXPECT_DOUBLE_EQ(posture_time(stage, stage.body_last), 1.0);
    constexpr double kStep = 1e-3;
    const auto speed = [&](double at) {
      return (posture_time(stage, at + kStep) - posture_time(stage, at - kStep)) / (2 * kStep);
    };
    EXPECT_LT(speed(stage.body_first + kStep), 1e-4);
    EXPECT_LT(speed(stage.body_last - kStep), 1e-4);
    double before = 0.0;
    for (double at = stage.body_first + 0.05; at < stage.body_last; at += 0.05) {
      EXPECT_GE(speed(at), -1e-9);
      EXPECT_LT(std::abs(speed(at) - before), 0.02) << "the pace changes gradually";
      before = speed(at);
    }
  }
}

TEST(Plan, HandsCarryTheObjectFromLiftOffToPlacedAndNeverMoreThanItsWeight) {
  const Plan plan = plan_phases(std::vector{reach, transfer, retrieve, return_}, std::vector(4, 1.0), 30.0);
  for (double at = 0.0; at <= static_cast<double>(plan.end); at += 0.25) {
    const double share = load_share(plan, 30.0, at);
    EXPECT_GE(share, -1e-12);
    EXPECT_LE(share, 1.0 + 1e-12);
  }
  EXPECT_EQ(load_share(plan, 30.0, static_cast<double>(*plan.frame_of("grasp"))), 0.0);
  EXPECT_EQ(load_share(plan, 30.0, static_cast<double>(*plan.frame_of("lift_off"))), 1.0);
  EXPECT_EQ(load_share(plan, 30.0, static_cast<double>(*plan.frame_of("placed_2"))), 1.0);
  EXPECT_EQ(load_share(plan, 30.0, static_cast<double>(*plan.frame_of("release"))), 0.0);
}

}  // namespace
}  // namespace reachcast
