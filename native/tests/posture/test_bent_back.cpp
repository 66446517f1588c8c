// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <random>

#include "reachcast/posture/hold.hpp"
#include "reachcast/posture/straight_chest.hpp"
#include "reachcast/posture/trunk_pose.hpp"

namespace reachcast {
namespace {

using enum Joint;
constexpr double kTolerance_m = 1e-9;
constexpr double kClamped_m = 1e-3;  // the legs are nearly straight, where stretches are clamped
constexpr std::array kTrunk{left_hip,       right_hip,     l5s1,           c7t1,    suprasternale, left_clavicle,
                            right_clavicle, left_shoulder, right_shoulder, tragion, nasion};

Body with_bones(double stature_m, std::size_t count) {
  const Body body = Body::from_stature(stature_m);
  Points points;
  for (std::size_t i = 1; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count);
    points.push_back(body.at(l5s1) + share * (body.at(c7t1) - body.at(l5s1)) + Vec3(0, 0.02 * std::sin(6 * share), 0));
  }
  return body.bending_at(points);
}

/// Hands on a box in front of the thighs, trunk leaning forward, knees bent: no logit is clamped.
Decoded leaning(const BodyLinkage& linkage, const Body& body, double bend_rad, Anchors& anchors) {
  std::mt19937_64 random(5);
  std::normal_distribution<> normal;
  Eigen::VectorXd x = encode_posture(two_handed_linkage(), body.posture());
  for (double& v : x) v += 0.1 * normal(random);
  anchors = anchors_of(body.posture());
  anchors.grip = {Vec3(-0.2, 0.5, 0.7), Vec3(0.2, 0.5, 0.7)};
  return linkage.decode(x, anchors, bend_rad);
}

double worst_distance(const Posture& a, const Posture& b) {
  double worst = 0.0;
  for (const Joint j : kTrunk) worst = std::max(worst, glm::distance(a[index(j)], b[index(j)]));
  return worst;
}

TEST(BentBack, ADecodedTrunkHasTheChordAndTheChestOfItsBend) {
  for (const std::size_t bones : {0u, 1u, 2u, 3u, 5u}) {
    const Body body = bones == 0 ? Body::from_stature(1.75) : with_bones(1.75, bones);
    const BodyLinkage linkage(two_handed_linkage(), body);
    for (const double bend : {0.2, 0.7, kMostBend_rad}) {
      Anchors anchors;
      const Posture posture = leaning(linkage, body, bend, anchors).trunk;
      const Posture stand = bent_stand(body, bend).posture;
      for (const Joint a : {l5s1, c7t1, suprasternale, left_clavicle, right_clavicle}) {
        for (const Joint b : {l5s1, c7t1, suprasternale, left_clavicle, right_clavicle}) {
          EXPECT_NEAR(glm::distance(posture[index(a)], posture[index(b)]),
                      glm::distance(stand[index(a)], stand[index(b)]), kTolerance_m);
        }
      }
      EXPECT_NEAR(glm::distance(posture[index(c7t1)], posture[index(tragion)]), body.distance(c7t1, tragion),
                  kTolerance_m);
    }
  }
}

TEST(BentBack, DecodeInvertsEncode) {
  const Body body = Body::from_stature(1.7);  // the proportions against which recordings are measured
  const BodyLinkage linkage(two_handed_linkage(), body);
  const Holder holder(two_handed_linkage(), body, 70.0);
  for (const double bend : {0.0, 0.3, 0.8, 1.3}) {
    Anchors anchors;
    HoldReport report;
    const Posture posture = holder.hold(leaning(linkage, body, bend, anchors), anchors, {}, report);
    ASSERT_EQ(report.shortfall_m, 0.0);
    const Decoded back = linkage.decode(encode_posture(two_handed_linkage(), posture, bend), anchors, bend);
    EXPECT_LT(worst_distance(back.trunk, posture), kClamped_m) << bend;
  }
}

TEST(BentBack, StraighteningUndoesTheBend) {
  const Body body = Body::from_stature(1.8, Sex::male);
  for (const double bend : {0.0, 0.4, 1.1, kMostBend_rad}) {
    const Posture straight = straight_chest(bent_stand(body, bend).posture, bend);
    for (const Joint j : {c7t1, suprasternale, left_clavicle, right_clavicle})
      EXPECT_LT(glm::distance(straight[index(j)], body.at(j)), kTolerance_m) << bend << " " << joint_name(j);
  }
}

TEST(BentBack, ABackThatCannotBendIsAsItWas) {
  const Body body = Body::from_stature(1.75), stiff = body.bending_at({});
  const BodyLinkage plain(two_handed_linkage(), body), bony(two_handed_linkage(), stiff);
  Anchors anchors;
  const Posture straight = leaning(plain, body, 0.0, anchors).trunk;
  EXPECT_LT(worst_distance(leaning(bony, stiff, 0.9, anchors).trunk, straight), kTolerance_m);
}

TEST(BentBack, DecodingIsContinuousInTheBend) {
  const Body body = with_bones(1.75, 3);
  const BodyLinkage linkage(two_handed_linkage(), body);
  Anchors anchors;
  Posture before = leaning(linkage, body, 0.0, anchors).trunk;
  for (double bend = 1e-3; bend < kMostBend_rad; bend += 1e-3) {
    const Posture now = leaning(linkage, body, bend, anchors).trunk;
    ASSERT_LT(worst_distance(now, before), 2e-3) << bend;
    before = now;
  }
}

TEST(BentBack, TrunkPosesKeepIt) {
  const Body body = with_bones(1.7, 4);
  const BodyLinkage linkage(two_handed_linkage(), body);
  Anchors anchors;
  const Decoded decoded = leaning(linkage, body, 0.9, anchors);
  const Decoded back = decoded_of(two_handed_linkage(), body, trunk_pose_of(two_handed_linkage(), body, decoded));
  EXPECT_EQ(back.bend_rad, 0.9);
  EXPECT_LT(worst_distance(back.trunk, decoded.trunk), kTolerance_m);
}

}  // namespace
}  // namespace reachcast
