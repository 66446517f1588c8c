// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/pose_mean.hpp"

#include <gtest/gtest.h>

#include "predict/predict_cases.hpp"
#include "reachcast/posture/linkage.hpp"

namespace reachcast {
namespace {

using namespace tests;

constexpr double kRounding = 1e-12;
constexpr double kExact_m = 1e-6;

const Query kQuery{Phase::transfer, {0.0, 0.41, 0.3}, {0.1, 0.40, 1.05}, subject(1.68), 1.2};
const Scheme kPoses{.k = 5, .postures = Average::poses};

Blend blended(const Scheme& scheme) {
  const auto table = made_corpus().table();
  return blend_neighbours(*table, kQuery, scheme, [](std::int64_t id) { return made_corpus().code(id); });
}

/// A body, and hands where the query has them half way.
struct Stand {
  Body body = Body::from_stature(1.68);
  BodyLinkage linkage{two_handed_linkage(), body};
  Anchors anchors = anchors_of(body.posture());
  Stand() { anchors.grip = {Vec3(-0.15, 0.4, 0.7), Vec3(0.25, 0.4, 0.7)}; }
};

PredictOptions with_poses(std::vector<Phase> phases, double rate) {
  PredictOptions how = options(rate);
  how.scheme.postures = Average::poses;
  how.phases = std::move(phases);
  return how;
}

TEST(PoseMean, IsThereWhereSeveralNeighboursAreAveragedAsPosesOnly) {
  EXPECT_TRUE(PoseMean(blended(kPoses)).exists());
  EXPECT_FALSE(PoseMean(blended({.k = 5})).exists());
  EXPECT_FALSE(PoseMean(blended({.k = 1, .postures = Average::poses})).exists());
}

/// Each neighbour decoded by itself with the weights that the neighbours report, where both ends count alike.
TEST(PoseMean, PutsThePelvisWhereTheNeighboursHaveItInTheMean) {
  const Stand stand;
  const Blend blend = blended(kPoses);
  const PoseMean poses(blend);
  Vec3 waist(0.0);
  for (const Neighbour& near : blend.neighbours) {
    const auto code = made_corpus().code(near.id);
    waist += near.weight * stand.linkage.decode(coordinates_at(*code, 0.5), stand.anchors).trunk[index(Joint::l5s1)];
  }
  const TrunkPose pose = poses.at(0.5, stand.anchors, two_handed_linkage(), stand.linkage, stand.body);
  EXPECT_LT(glm::distance(pose.waist, waist), kRounding);
}

TEST(PoseMean, OfNeighboursThatAreAlikeIsTheirPose) {
  const Stand stand;
  Blend blend = blended(kPoses);
  for (PosturePart& part : blend.parts) part.curves = blend.parts.front().curves;
  const Decoded mean =
      decoded_of(two_handed_linkage(), stand.body,
                 PoseMean(blend).at(0.3, stand.anchors, two_handed_linkage(), stand.linkage, stand.body));
  MotionCode code = blend.whole;
  code.coefficients.tail(blend.parts.front().curves.size()) = blend.parts.front().curves.transpose().reshaped();
  const Decoded own = stand.linkage.decode(coordinates_at(code, 0.3), stand.anchors);
  for (const Joint j : {Joint::l5s1, Joint::c7t1, Joint::left_hip, Joint::right_shoulder, Joint::nasion})
    EXPECT_LT(glm::distance(mean.trunk[index(j)], own.trunk[index(j)]), 1e-9) << joint_name(j);
}

TEST(PoseMean, PlayedBackwardsIsTheSameTheOtherWayRound) {
  const Stand stand;
  const Blend blend = blended(kPoses);
  Blend back = blend;
  reverse(back);
  const auto waist = [&](const Blend& which, double t) {
    return PoseMean(which).at(t, stand.anchors, two_handed_linkage(), stand.linkage, stand.body).waist;
  };
  for (const double t : {0.0, 0.2, 0.9}) EXPECT_LT(glm::distance(waist(blend, t), waist(back, 1.0 - t)), 1e-9) << t;
}

TEST(PoseMean, KeepsLinksAndHandsInEveryPhase) {
  using enum Phase;
  const Body body = Body::from_stature(1.8);
  const Task errand = task({0.05, 0.42, 0.1}, {-0.15, 0.40, 0.95});
  const Motion motion = predict(made_corpus(), subject(1.8), errand, body,
                                with_poses({reach, transfer, return_, reach, retrieve, return_}, 24.0));
  EXPECT_LT(worst_link(body, motion), kExact_m);
  for (const Stage& stage : motion.plan.stages) {
    if (!is_loaded(stage.phase)) continue;
    for (std::size_t f = stage.first; f <= stage.last; ++f) {
      EXPECT_LT(glm::distance(motion.postures[f][index(Joint::left_grip)], grip_of(kBox, motion.box[f], true)),
                kExact_m);
    }
  }
}

/// At ten times the frame rate every step is a tenth as long and every change of velocity a tenth as large, unless
/// there is a jump.
TEST(PoseMean, HasNoJumpWherePhasesMeet) {
  using enum Phase;
  const Body body = Body::from_stature(1.72);
  const Task errand = task({0.05, 0.42, 0.1}, {-0.15, 0.40, 0.95});
  const auto worst = [&](double rate, int order) {
    const Motion motion =
        predict(made_corpus(), subject(1.72), errand, body, with_poses({reach, transfer, return_}, rate));
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

}  // namespace
}  // namespace reachcast
