// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/whole_body.hpp"

#include <gtest/gtest.h>

#include <random>

#include "reachcast/posture/hold.hpp"

namespace reachcast {
namespace {

using enum Joint;
using Random = std::mt19937_64;
constexpr double kTolerance_m = 1e-9;

/// Links, and the sides of the rigid triangles.
const std::vector<std::pair<Joint, Joint>> kRigid{{left_ball, left_ankle},
                                                  {left_ankle, left_knee},
                                                  {left_knee, left_hip},
                                                  {right_ball, right_ankle},
                                                  {right_ankle, right_knee},
                                                  {right_knee, right_hip},
                                                  {left_hip, right_hip},
                                                  {left_hip, l5s1},
                                                  {right_hip, l5s1},
                                                  {l5s1, c7t1},
                                                  {l5s1, left_clavicle},
                                                  {l5s1, right_clavicle},
                                                  {c7t1, left_clavicle},
                                                  {left_clavicle, right_clavicle},
                                                  {left_clavicle, left_shoulder},
                                                  {right_clavicle, right_shoulder},
                                                  {left_shoulder, left_elbow},
                                                  {right_shoulder, right_elbow},
                                                  {left_elbow, left_wrist},
                                                  {right_elbow, right_wrist},
                                                  {left_wrist, left_grip},
                                                  {right_wrist, right_grip},
                                                  {c7t1, tragion},
                                                  {tragion, nasion}};

double worst_length(const Body& body, const Posture& p) {
  double worst = 0.0;
  for (const auto& [a, b] : kRigid) {
    worst = std::max(worst, std::abs(glm::distance(p[index(a)], p[index(b)]) - body.distance(a, b)));
  }
  return worst;
}

/// A standing posture with both arms bent forward: something to encode that no limit touches.
Posture bent_posture(const Body& body) {
  Posture p = body.posture();
  for (const bool left : {true, false}) {
    const double side = left ? -1.0 : 1.0;
    const auto at = [&](Joint right) -> Vec3& { return p[index(left ? mirrored(right) : right)]; };
    at(right_elbow) =
        at(right_shoulder) + glm::normalize(Vec3(0.3 * side, 0.1, -1)) * body.distance(right_shoulder, right_elbow);
    at(right_wrist) =
        at(right_elbow) + glm::normalize(Vec3(-0.2 * side, 1, 0.1)) * body.distance(right_elbow, right_wrist);
    at(right_grip) =
        at(right_wrist) + glm::normalize(Vec3(-0.1 * side, 1, 0.4)) * body.distance(right_wrist, right_grip);
    const Vec3 along = glm::normalize(at(right_grip) - at(right_wrist));
    at(right_hand_front) = at(right_grip) + 0.02 * along;
    at(right_hand_back) = at(right_grip) - 0.02 * along;
    at(right_knee) += Vec3(0.02 * side, 0.03, 0.0);
  }
  return p;
}

TEST(WholeBody, DecodeInvertsEncodeOnTheSameBody) {
  const Body body = Body::from_stature(1.75, Sex::male);
  const Posture posture = bent_posture(body);
  const Body same = Body::from_posture(posture, 1.75);
  const BodyLinkage linkage(two_handed_linkage(), same);
  HoldReport report;
  const Posture back = Holder(two_handed_linkage(), same, 70.0)
                           .hold(linkage.decode(encode_posture(two_handed_linkage(), posture), anchors_of(posture)),
                                 anchors_of(posture), {}, report);
  // Stretches within 0.7 % of straight are clamped, which the standing legs are: joints may differ, the ends may not.
  for (const Joint end : {left_ball, right_ball, left_grip, right_grip}) {
    EXPECT_LT(glm::distance(back[index(end)], posture[index(end)]), kTolerance_m) << joint_name(end);
  }
  for (std::size_t j = 0; j < kJointCount; ++j) {
    EXPECT_LT(glm::distance(back[j], posture[j]), 0.06) << joint_names()[j];
  }
}

/// Recordings often have one point for both clavicle roots, which a body has apart.
TEST(WholeBody, AMirroredRecordingIsTheMirroredPostureOnABodyWithOtherClavicleRoots) {
  const Body body = Body::from_stature(1.75);
  Posture posture = body.posture();
  posture[index(left_clavicle)] = posture[index(right_clavicle)] = posture[index(suprasternale)];
  posture[index(left_grip)] = {-0.2, 0.35, 0.9};
  posture[index(right_grip)] = {0.3, 0.40, 1.0};
  const BodyLinkage linkage(two_handed_linkage(), body);
  const auto decoded = [&](const Posture& p) {
    return linkage.decode(encode_posture(two_handed_linkage(), p), anchors_of(p)).trunk;
  };
  const Posture one = decoded(posture), image = mirrored(decoded(mirrored(posture)));
  for (const Joint j : {l5s1, c7t1, left_shoulder, right_shoulder, left_clavicle, tragion, nasion})
    EXPECT_LT(glm::distance(one[index(j)], image[index(j)]), kTolerance_m) << joint_name(j);
}

TEST(WholeBody, RandomCoordinatesKeepEverySegment) {
  Random random(11);
  std::normal_distribution<> normal;
  std::uniform_real_distribution<> unit(-1, 1);
  for (int trial = 0; trial < 2000; ++trial) {
    const Body body = Body::from_stature(1.5 + 0.45 * std::abs(unit(random)), trial % 2 ? Sex::female : Sex::male);
    const BodyLinkage linkage(two_handed_linkage(), body);
    Eigen::VectorXd x(posture_coordinate_count(two_handed_linkage()));
    for (double& v : x) v = 2.0 * normal(random);
    Anchors anchors = anchors_of(body.posture());
    const Vec3 hold(unit(random), 0.4 + 0.4 * unit(random), 1.0 + unit(random));
    anchors.grip = {hold - Vec3(0.2, 0, 0), hold + Vec3(0.2, 0, 0)};
    const Decoded decoded = linkage.decode(x, anchors);
    HoldReport report;
    const Posture posture = Holder(two_handed_linkage(), body, 70.0).hold(decoded, anchors, {}, report);
    ASSERT_LT(worst_length(body, posture), kTolerance_m) << trial;
    if (report.shortfall_m > 0.0) continue;
    for (const int side : {0, 1}) {
      ASSERT_LT(glm::distance(posture[index(side ? right_grip : left_grip)], anchors.grip[side]), kTolerance_m);
      ASSERT_LT(glm::distance(posture[index(side ? right_ankle : left_ankle)], anchors.ankle[side]), kTolerance_m);
    }
  }
}

TEST(WholeBody, TurningTheTaskTurnsTheUpperBody) {
  const Body body = Body::from_stature(1.75);
  const Posture posture = bent_posture(body);
  const Eigen::VectorXd x = encode_posture(two_handed_linkage(), posture);
  const BodyLinkage linkage(two_handed_linkage(), body);
  Anchors right = anchors_of(posture);
  const Vec3 hold = 0.5 * (right.grip[0] + right.grip[1]);
  const Vec3 aside(hold.y + 0.0, hold.y * 0.5, hold.z);
  const Vec3 half(0.2 * 0.4, -0.2 * 0.9, 0.0);
  right.grip = {aside - half, aside + half};
  HoldReport report;
  const Posture turned = Holder(two_handed_linkage(), body, 70.0).hold(linkage.decode(x, right), right, {}, report);
  const Vec3 across = turned[index(right_shoulder)] - turned[index(left_shoulder)];
  EXPECT_LT(across.y, -0.1) << "the right shoulder goes back when the hands go right";
}

TEST(Hold, BringsBothHandsAndTheWeightToWhereTheyBelong) {
  const Body body = Body::from_stature(1.75, Sex::male);
  const Eigen::VectorXd x = encode_posture(two_handed_linkage(), bent_posture(body));
  Anchors anchors = anchors_of(body.posture());
  anchors.grip = {Vec3(-0.2, 0.55, 1.2), Vec3(0.2, 0.55, 1.2)};
  const Load load{Vec3(0, 0.55, 1.2), 20.0};
  HoldReport report;
  const Posture posture = Holder(two_handed_linkage(), body, 70.0)
                              .hold(BodyLinkage(two_handed_linkage(), body).decode(x, anchors), anchors, load, report);
  EXPECT_EQ(report.shortfall_m, 0.0);
  EXPECT_LT(glm::length(beyond_support(centre_of_mass(posture, 70.0, load), anchors)), 1e-3);
  EXPECT_LT(glm::distance(posture[index(left_grip)], anchors.grip[0]), kTolerance_m);
}

TEST(Hold, SaysByHowMuchAnAnchorIsOutOfReach) {
  const Body body = Body::from_stature(1.75);
  const Eigen::VectorXd x = encode_posture(two_handed_linkage(), body.posture());
  Anchors anchors = anchors_of(body.posture());
  for (Vec3& grip : anchors.grip) grip += Vec3(0, 0, 3.0);
  HoldReport report;
  (void)Holder(two_handed_linkage(), body, 70.0)
      .hold(BodyLinkage(two_handed_linkage(), body).decode(x, anchors), anchors, {}, report);
  EXPECT_GT(report.shortfall_m, 0.2);
}

TEST(Balance, CentreOfMassOfAStandIsNearTheKnownHeight) {
  // Standing adults: 0.55 to 0.57 of stature (Winter 2009).
  const Body body = Body::from_stature(1.8, Sex::male);
  const Vec3 centre = centre_of_mass(body.posture(), 75.0, {});
  EXPECT_NEAR(centre.z / 1.8, 0.56, 0.02);
  EXPECT_NEAR(centre.x, 0.0, 1e-12);
  EXPECT_EQ(glm::length(beyond_support(centre, anchors_of(body.posture()))), 0.0);
}

}  // namespace
}  // namespace reachcast
