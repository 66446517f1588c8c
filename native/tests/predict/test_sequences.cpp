// SPDX-License-Identifier: GPL-3.0-or-later
/// Several phases as one motion.
#include <gtest/gtest.h>

#include "predict/predict_cases.hpp"
#include "reachcast/predict/performance.hpp"

namespace reachcast {
namespace {

using enum Phase;
using namespace tests;

constexpr double kExact_m = 1e-6;

const std::vector<std::vector<Phase>> kSequences{{reach},
                                                 {return_},
                                                 {retrieve},
                                                 {reach, transfer},
                                                 {transfer, return_},
                                                 {transfer, retrieve},
                                                 {reach, return_},
                                                 {return_, reach, retrieve, return_},
                                                 {reach, transfer, return_, reach, retrieve, return_}};

PredictOptions of(const std::vector<Phase>& phases, double rate) {
  PredictOptions how = options(rate);
  how.phases = phases;
  return how;
}

const Task kTask = task({0.05, 0.42, 0.1}, {-0.15, 0.40, 0.95});

TEST(Sequences, KeepLinksFeetAndGrips) {
  for (const double stature : {1.55, 1.8}) {
    const Body body = Body::from_stature(stature);
    for (const auto& phases : kSequences) {
      const Motion motion = predict(made_corpus(), subject(stature), kTask, body, of(phases, 24.0));
      ASSERT_EQ(motion.postures.size(), motion.plan.end + 1);
      EXPECT_LT(worst_link(body, motion), kExact_m);
      for (const Stage& stage : motion.plan.stages) {
        const Posture &first = motion.postures[stage.first], &last = motion.postures[stage.last];
        const HandEnds ends = hand_ends(stage, kTask, body);
        const auto off = [](const Posture& p, const Grips& grips) {
          return std::max(glm::distance(p[index(Joint::left_grip)], grips[0]),
                          glm::distance(p[index(Joint::right_grip)], grips[1]));
        };
        EXPECT_LT(off(first, ends.first), kExact_m) << phase_name(stage.phase);
        EXPECT_LT(off(last, ends.last), kExact_m) << phase_name(stage.phase);
        if (!is_loaded(stage.phase)) continue;
        for (std::size_t f = stage.first; f <= stage.last; ++f) {
          EXPECT_LT(off(motion.postures[f], {grip_of(kBox, motion.box[f], true), grip_of(kBox, motion.box[f], false)}),
                    kExact_m);
        }
      }
      for (const Posture& p : motion.postures) {
        for (const Joint j : {Joint::left_ball, Joint::left_ankle, Joint::right_ball, Joint::right_ankle})
          ASSERT_LT(glm::distance(p[index(j)], body.at(j)), kExact_m);
      }
    }
  }
}

/// At ten times the frame rate every step is a tenth as long and every change of velocity a tenth as large, unless
/// there is a jump.
TEST(Sequences, HaveNoJumpInPlaceOrSpeedWherePhasesMeet) {
  const Body body = Body::from_stature(1.72);
  for (const auto& phases : kSequences) {
    const auto worst = [&](double rate, int order) {
      const Motion motion = predict(made_corpus(), subject(1.72), kTask, body, of(phases, rate));
      double most = 0.0;
      for (std::size_t f = 2; f < motion.postures.size(); ++f) {
        for (std::size_t j = 0; j < kJointCount; ++j) {
          const auto at = [&](std::size_t frame) { return motion.postures[frame][j]; };
          const Vec3 change = order == 1 ? at(f) - at(f - 1) : (at(f) - 2.0 * at(f - 1) + at(f - 2)) * rate;
          most = std::max(most, glm::length(change));
        }
      }
      return most;
    };
    EXPECT_LT(worst(1000.0, 1), 0.2 * worst(100.0, 1));
    EXPECT_LT(worst(1000.0, 2), 0.25 * worst(100.0, 2));
  }
}

TEST(Sequences, ObjectStaysWhereItStandsWhileTheHandsAreAway) {
  const Body body = Body::from_stature(1.72);
  const Motion motion = predict(made_corpus(), subject(1.72), kTask, body, of(kSequences.back(), 24.0));
  for (std::size_t f = 0; f <= *motion.plan.frame_of("lift_off"); ++f) EXPECT_EQ(motion.box[f].position, kTask.home);
  for (std::size_t f = *motion.plan.frame_of("placed"); f <= *motion.plan.frame_of("lift_off_2"); ++f)
    EXPECT_EQ(motion.box[f].position, kTask.target);
  for (std::size_t f = *motion.plan.frame_of("placed_2"); f <= motion.plan.end; ++f)
    EXPECT_EQ(motion.box[f].position, kTask.home);
  ASSERT_EQ(motion.neighbours.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(motion.neighbours[i].phase, kSequences.back()[i]);
}

TEST(Sequences, BoxTurnsFromItsTurnAtHomeToItsTurnAtTheTarget) {
  Task turned = kTask;
  turned.home_yaw_rad = 0.4;
  turned.target_yaw_rad = -0.7;
  const Motion motion =
      predict(made_corpus(), subject(1.72), turned, Body::from_stature(1.72), of({transfer, retrieve}, 24.0));
  const auto yaw = [&](const char* event) { return motion.box[frame(motion, event)].yaw_rad; };
  EXPECT_NEAR(std::remainder(yaw("lift_off") - 0.4, 2.0 * kPi), 0.0, 1e-12);
  EXPECT_NEAR(std::remainder(yaw("placed") + 0.7, 2.0 * kPi), 0.0, 1e-12);
  EXPECT_NEAR(std::remainder(yaw("placed_2") - 0.4, 2.0 * kPi), 0.0, 1e-12);
}

}  // namespace
}  // namespace reachcast
