// SPDX-License-Identifier: GPL-3.0-or-later
/// The bones of a rig's back share a bend evenly, and the chest comes out where the joints have it.
#include <gtest/gtest.h>

#include "reachcast/body/spine.hpp"
#include "reachcast/rig/retarget.hpp"
#include "rig/rig_cases.hpp"

namespace reachcast {
namespace {

using enum Joint;
using tests::difference;
using tests::kRounding;
using tests::made_motion;
using tests::made_rig;

constexpr std::array kHanging{
    c7t1,           suprasternale,   left_clavicle, right_clavicle, left_shoulder, right_shoulder,  left_elbow,
    right_elbow,    left_wrist,      right_wrist,   left_grip,      right_grip,    left_hand_front, right_hand_front,
    left_hand_back, right_hand_back, tragion,       nasion};

/// The postures with their backs bent: what is above c7t1 goes with it as one piece.
std::vector<Posture> bent(const RestRig& rest, const std::vector<Posture>& motion, std::span<const double> bends_rad) {
  std::vector<Posture> out = motion;
  const auto chest = [](const Posture& p) {
    return frame_towards(p[index(c7t1)] - p[index(l5s1)], p[index(right_clavicle)] - p[index(l5s1)]);
  };
  for (std::size_t f = 0; f < motion.size(); ++f) {
    const BentBack back = bent_back(rest.back_pieces(), rest.right(), bends_rad[f]);
    const Mat3 turn = chest(motion[f]) * glm::transpose(chest(rest.joints()));
    const Mat3 upper = turn * back.upper * glm::transpose(turn);
    const Vec3 neck = motion[f][index(l5s1)] + turn * back.end;
    for (const Joint j : kHanging) out[f][index(j)] = neck + upper * (motion[f][index(j)] - motion[f][index(c7t1)]);
  }
  return out;
}

std::vector<double> swelling_bends(std::size_t frames) {
  std::vector<double> bends;
  for (std::size_t f = 0; f < frames; ++f) bends.push_back(1.2 * static_cast<double>(f) / static_cast<double>(frames));
  return bends;
}

TEST(RigsBack, RunsFromTheSpineToTheChest) {
  const RestRig rest = made_rig().rig();
  EXPECT_EQ(rest.back(), (std::vector{2, 3, 4}));
  Vec3 whole(0.0);
  for (const Vec3& piece : rest.back_pieces()) whole += piece;
  EXPECT_LT(glm::distance(whole, rest.at(c7t1) - rest.at(l5s1)), kRounding);
}

TEST(RigsBack, EndsWhereAClavicleHangs) {
  tests::RigParts parts = made_rig();
  parts.bones.parents[static_cast<std::size_t>(parts.segments["clavicle.R"])] = 3;
  EXPECT_EQ(parts.rig().back(), (std::vector{2, 3}));
}

TEST(RigsBack, PosedJointsInvertTheRetargetingOfBentBacks) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    tests::RigParts parts = made_rig(seed);
    parts.bones.heads[3] += Vec3(0.01, 0.03, 0.0);  // a back that is not straight at rest
    const RestRig rest = parts.rig();
    const std::vector<double> bends = swelling_bends(20);
    const std::vector<Posture> motion = bent(rest, made_motion(parts, seed, 20), bends);
    const RigPose pose = retarget(rest, motion, bends);
    const std::vector<Posture> reached = posed_joints(rest, pose);
    for (std::size_t f = 0; f < motion.size(); ++f) {
      for (const Joint j : {l5s1, c7t1, suprasternale, left_clavicle, right_clavicle, left_shoulder, right_elbow,
                            left_wrist, right_grip, tragion, right_ankle})
        ASSERT_LT(glm::distance(reached[f][index(j)], motion[f][index(j)]), 1e-10) << joint_name(j) << " " << f;
    }
  }
}

TEST(RigsBack, ItsBonesTurnEvenlyAndComposeToTheTurns) {
  const tests::RigParts parts = made_rig();
  const RestRig rest = parts.rig();
  const std::vector<double> bends = swelling_bends(9);
  const RigPose pose = retarget(rest, bent(rest, made_motion(parts, 3, 9), bends), bends);
  double whole = 0.0;
  for (const Vec3& piece : rest.back_pieces()) whole += glm::length(piece);
  for (std::size_t i = 1; i < rest.back().size(); ++i) {
    const double share = 0.5 * (glm::length(rest.back_pieces()[i]) + glm::length(rest.back_pieces()[i - 1])) / whole;
    for (std::size_t f = 0; f < bends.size(); ++f) {
      const Mat3 local = local_rotations(rest, pose, rest.back()[i])[f];
      const double angle = std::acos(std::clamp(0.5 * (local[0][0] + local[1][1] + local[2][2] - 1.0), -1.0, 1.0));
      EXPECT_NEAR(angle, share * bends[f], 1e-7);
    }
  }
}

TEST(RigsBack, NoBendIsWhatItWasWithoutAny) {
  const tests::RigParts parts = made_rig();
  const RestRig rest = parts.rig();
  const std::vector<Posture> motion = made_motion(parts, 6, 10);
  const RigPose plain = retarget(rest, motion), none = retarget(rest, motion, std::vector<double>(10, 0.0));
  EXPECT_EQ(plain.turns, none.turns);
  EXPECT_EQ(plain.heads, none.heads);
}

TEST(RigsBack, RefusesBendsThatDoNotFit) {
  const RestRig rest = made_rig().rig();
  const std::vector<Posture> motion(2, rest.joints());
  for (const std::vector<double>& bends : {std::vector{0.1}, std::vector{0.1, -0.1}, std::vector{0.1, kMissing}})
    EXPECT_THROW((void)retarget(rest, motion, bends), std::invalid_argument);
}

}  // namespace
}  // namespace reachcast
