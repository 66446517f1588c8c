// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/rig/retarget.hpp"

#include <gtest/gtest.h>

#include "rig/rig_cases.hpp"

namespace reachcast {
namespace {

using tests::difference;
using tests::kRounding;
using tests::made_motion;
using tests::made_rig;

Turns turns_of(const RestRig& rest, const RigPose& pose, Segment segment) {
  return pose.turns_of(rest.slot(rest.bone(segment)));
}

TEST(Retarget, PosedJointsInvertIt) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const tests::RigParts parts = made_rig(seed);
    const RestRig rest = parts.rig();
    const std::vector<Posture> motion = made_motion(parts, seed, 30);
    const std::vector<Posture> reached = posed_joints(rest, retarget(rest, motion));
    for (std::size_t f = 0; f < motion.size(); ++f) {
      for (std::size_t j = 0; j < kJointCount; ++j) {
        if (!tests::is_exact(static_cast<Joint>(j))) continue;
        EXPECT_LT(glm::distance(reached[f][j], motion[f][j]), kRounding)
            << joint_name(static_cast<Joint>(j)) << " at frame " << f << ", seed " << seed;
      }
    }
  }
}

TEST(Retarget, TurnsAreRotations) {
  const tests::RigParts parts = made_rig();
  for (const Mat3& turn : retarget(parts.rig(), made_motion(parts, 7, 40)).turns) {
    EXPECT_LT(difference(glm::transpose(turn) * turn, Mat3(1.0)), kRounding);
    EXPECT_NEAR(glm::dot(glm::cross(turn[0], turn[1]), turn[2]), 1.0, kRounding);
  }
}

TEST(Retarget, PelvisAndChestTurnWithTheirTriangles) {
  using enum Joint;
  const tests::RigParts parts = made_rig();
  const RestRig rest = parts.rig();
  const std::vector<Posture> motion = made_motion(parts, 3, 30);
  const RigPose pose = retarget(rest, motion);
  const std::vector<std::tuple<Segment, Joint, Joint>> edges{
      {Segment::pelvis, left_hip, right_hip}, {Segment::pelvis, left_hip, l5s1},
      {Segment::chest, l5s1, c7t1},           {Segment::chest, l5s1, right_clavicle},
      {Segment::chest, l5s1, left_clavicle},  {Segment::spine, c7t1, left_clavicle}};
  for (const auto& [segment, from, to] : edges) {
    for (std::size_t f = 0; f < motion.size(); ++f) {
      const Vec3 posed = turns_of(rest, pose, segment)[f] * (rest.at(to) - rest.at(from));
      EXPECT_LT(glm::distance(posed, motion[f][index(to)] - motion[f][index(from)]), kRounding);
    }
  }
}

TEST(Retarget, TheFaceLooksWhereTheNasionIs) {
  using enum Joint;
  const tests::RigParts parts = made_rig();
  const RestRig rest = parts.rig();
  const std::vector<Posture> motion = made_motion(parts, 4, 30);
  const RigPose pose = retarget(rest, motion);
  for (std::size_t f = 0; f < motion.size(); ++f) {
    const Vec3 posed = turns_of(rest, pose, Segment::head)[f] * (rest.at(nasion) - rest.at(tragion));
    EXPECT_LT(glm::distance(posed, motion[f][index(nasion)] - motion[f][index(tragion)]), kRounding);
  }
}

TEST(Retarget, RestJointsGiveTheRestPoseOfTrunkLegsAndClavicles) {
  const RestRig rest = made_rig().rig();
  const std::vector<Posture> still(3, rest.joints());
  const RigPose pose = retarget(rest, still);
  for (const Segment segment :
       {Segment::pelvis, Segment::spine, Segment::chest, Segment::neck, Segment::head, Segment::left_clavicle,
        Segment::right_clavicle, Segment::left_foot, Segment::right_foot, Segment::left_toe, Segment::right_toe}) {
    EXPECT_LT(difference(turns_of(rest, pose, segment)[1], Mat3(1.0)), kRounding) << segment_name(segment);
  }
}

TEST(Retarget, TurningTheWorldTurnsThePose) {
  const tests::RigParts parts = made_rig();
  const RestRig rest = parts.rig();
  std::vector<Posture> motion = made_motion(parts, 5, 25);
  const RigPose plain = retarget(rest, motion);
  const Mat3 turn = turn_about({0, 0, 1}, 2.5);  // about the vertical: feet are level against it
  const Vec3 shift(3.0, -2.0, 0.5);
  tests::RigParts moved = parts;
  moved.axes = turn * parts.axes;
  for (Vec3& joint : moved.joints) joint = turn * joint + shift;
  for (Vec3& head : moved.bones.heads) head = turn * head + shift;
  for (Mat3& rotation : moved.bones.rotations) rotation = turn * rotation;
  for (Posture& posture : motion) {
    for (Vec3& joint : posture) joint = turn * joint + shift;
  }
  const RestRig moved_rest = moved.rig();
  const RigPose pose = retarget(moved_rest, motion);
  for (std::size_t i = 0; i < plain.turns.size(); ++i) {
    EXPECT_LT(difference(pose.turns[i], turn * plain.turns[i] * glm::transpose(turn)), 1e-11);
    EXPECT_LT(glm::distance(pose.heads[i], turn * plain.heads[i] + shift), 1e-11);
  }
}

TEST(Retarget, UnmappedBonesFollowAndTheRootStays) {
  const tests::RigParts parts = made_rig();
  const RestRig rest = parts.rig();
  const RigPose pose = retarget(rest, made_motion(parts, 6, 10));
  for (const int bone : {0, 3}) {
    for (const Mat3& local : local_rotations(rest, pose, bone)) EXPECT_EQ(local, Mat3(1.0));
  }
  EXPECT_EQ(pose.turns_of(rest.slot(3))[4], pose.turns_of(rest.slot(2))[4]);
  EXPECT_EQ(pose.heads_of(rest.slot(0))[4], parts.bones.heads[0]);
}

/// Blender's own rule: posed orientation = parent's posed orientation * (rest against the parent's rest) * basis.
TEST(Retarget, LocalRotationsComposeToTheTurns) {
  const tests::RigParts parts = made_rig();
  const RestRig rest = parts.rig();
  const RigPose pose = retarget(rest, made_motion(parts, 8, 12));
  std::vector<Mat3> posed(parts.bones.parents.size());
  for (const int bone : rest.keyed()) {
    const auto b = static_cast<std::size_t>(bone);
    const int parent = parts.bones.parents[b];
    const Mat3 basis = local_rotations(rest, pose, bone)[5];
    posed[b] = parts.bones.rotations[b] * basis;
    if (parent >= 0) {
      const auto p = static_cast<std::size_t>(parent);
      posed[b] = posed[p] * glm::transpose(parts.bones.rotations[p]) * parts.bones.rotations[b] * basis;
    }
    EXPECT_LT(difference(posed[b], pose.turns_of(rest.slot(bone))[5] * parts.bones.rotations[b]), kRounding);
  }
}

TEST(Retarget, RefusesNoFramesAndWhatIsNotFinite) {
  const RestRig rest = made_rig().rig();
  EXPECT_THROW((void)retarget(rest, {}), std::invalid_argument);
  std::vector<Posture> motion(2, rest.joints());
  motion[1][index(Joint::left_knee)].y = kMissing;
  try {
    (void)retarget(rest, motion);
    FAIL() << "a joint that is not a number was taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("frame 1, left_knee"), std::string::npos) << error.what();
  }
  EXPECT_THROW((void)local_rotations(rest, retarget(rest, std::span(motion).first(1)), -1), std::invalid_argument);
}

}  // namespace
}  // namespace reachcast
