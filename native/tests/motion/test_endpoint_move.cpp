// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/motion/endpoint_move.hpp"

#include <gtest/gtest.h>

#include "motion/made_lift.hpp"
#include "reachcast/motion/encode.hpp"

namespace reachcast {
namespace {

constexpr double kExact = 1e-12;
constexpr double kStature_m = 1.75;

/// A lift during which the right foot goes by `step`, lifted by `rise_m` midway.
Reach stepping(const Vec3& step, double rise_m) {
  Reach reach = tests::made_lift(kStature_m, {0.02, 0.42, 0.15}, {0.3, 0.45, 1.15});
  const auto last = static_cast<double>(reach.frames() - 1);
  for (std::size_t f = 0; f < reach.frames(); ++f) {
    const double t = static_cast<double>(f) / last, along = t * t * (3.0 - 2.0 * t);
    for (const Joint j : {Joint::right_ankle, Joint::right_ball})
      reach.postures[f][index(j)] += along * step + Vec3(0.0, 0.0, 4.0 * rise_m * along * (1.0 - along));
  }
  return reach;
}

TEST(EndpointMove, FeetThatStandAreZero) {
  for (const EndpointMove& move : foot_moves_of(encode_reach(stepping(Vec3(0.0), 0.0)))) {
    EXPECT_TRUE(move.stays());
    EXPECT_EQ(move.path.velocity.norm(), 0.0);
    EXPECT_EQ(glm::length(move.curve.offsets[0]), 0.0);
  }
  EXPECT_TRUE(foot_moves_of(stepping({0.9 * kLeastMove_m, 0.0, 0.0}, 0.0))[1].stays());
  EXPECT_FALSE(foot_moves_of(stepping({1.1 * kLeastMove_m, 0.0, 0.0}, 0.0))[1].stays());
}

TEST(EndpointMove, AStepComesBackFromItsCodeInBothForms) {
  const Vec3 step(0.3, 0.2, 0.0);
  const Reach reach = stepping(step, 0.1);
  const auto [left, right] = foot_moves_of(encode_reach(reach));
  EXPECT_TRUE(left.stays());
  EXPECT_LT(glm::distance(right.displacement * kStature_m, step), kExact);
  const Vec3 start = reach.postures.front()[index(Joint::right_ankle)], end = start + step;
  for (std::size_t f = 0; f < reach.frames(); ++f) {
    const double t = static_cast<double>(f) / static_cast<double>(reach.frames() - 1);
    const Vec3 ankle = reach.postures[f][index(Joint::right_ankle)];
    EXPECT_LT(glm::distance(point_at(right.path, start, end, t), ankle), 0.01) << f;
    EXPECT_LT(glm::distance(point_on(right.curve, start, end, progress(right.curve, t)), ankle), 0.03) << f;
  }
}

TEST(EndpointMove, ThePelvisGoesUpInALift) {
  const Reach reach = stepping(Vec3(0.0), 0.0);
  const EndpointMove pelvis = pelvis_move_of(encode_reach(reach));
  const auto waist = [&](std::size_t f) { return reach.postures[f][index(Joint::l5s1)]; };
  EXPECT_GT(pelvis.displacement.z, 0.05);
  for (std::size_t f = 0; f < reach.frames(); ++f) {
    const double t = static_cast<double>(f) / static_cast<double>(reach.frames() - 1);
    EXPECT_LT(glm::distance(point_at(pelvis.path, waist(0), waist(reach.frames() - 1), t), waist(f)), 0.02) << f;
  }
}

TEST(EndpointMove, AMoveIsPutIntoACodeAndTakenOut) {
  MotionCode code = encode_reach(stepping(Vec3(0.0), 0.0));
  const auto moves = foot_moves_of(stepping({-0.2, 0.3, 0.0}, 0.08));
  set_foot_moves(code, moves);
  const auto back = foot_moves_of(code);
  EXPECT_EQ(back[1].displacement, moves[1].displacement);
  EXPECT_EQ(back[1].path.deviation, moves[1].path.deviation);
  EXPECT_EQ(back[1].curve.offsets, moves[1].curve.offsets);
  EXPECT_TRUE(back[0].stays());
}

TEST(EndpointMove, BackwardsTwiceIsTheMove) {
  const EndpointMove move = foot_moves_of(stepping({-0.2, 0.3, 0.0}, 0.08))[1], back = reversed(move);
  EXPECT_EQ(back.displacement, -move.displacement);
  EXPECT_EQ(reversed(back).path.velocity, move.path.velocity);
  EXPECT_EQ(reversed(back).curve.offsets, move.curve.offsets);
}

}  // namespace
}  // namespace reachcast
