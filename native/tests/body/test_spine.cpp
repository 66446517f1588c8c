// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/body/spine.hpp"

#include <gtest/gtest.h>

namespace reachcast {
namespace {

using enum Joint;
constexpr double kRounding = 1e-12;
const Vec3 kRight(1, 0, 0);

/// Many short straight steps along an evenly bent curve that starts half the bend behind its chord.
Vec3 walked_arc(double length_m, double bend_rad) {
  constexpr int kSteps = 20000;
  Vec3 end(0.0);
  for (int i = 0; i < kSteps; ++i) {
    const double angle = bend_rad * ((i + 0.5) / kSteps - 0.5);
    end += Vec3(0.0, std::sin(angle), std::cos(angle)) * (length_m / kSteps);
  }
  return end;
}

TEST(Spine, AnArcHasTheChordOfAWalkAlongIt) {
  for (const double bend : {0.0, 0.01, 0.3, 1.0, kMostBend_rad}) {
    const BentBack back = bent_arc({0, 0, 0.5}, kRight, bend);
    EXPECT_LT(glm::distance(back.end, walked_arc(0.5, bend)), 1e-9) << bend;
    EXPECT_NEAR(glm::length(back.end), 0.5 * ratio_of_bend(bend), kRounding);
  }
}

TEST(Spine, RatioAndBendInvertEachOther) {
  for (double bend = 0.0; bend <= kMostBend_rad; bend += 0.01) {
    EXPECT_NEAR(bend_of_ratio(ratio_of_bend(bend)), bend, 1e-7) << bend;
  }
  EXPECT_EQ(bend_of_ratio(1.0), 0.0);
  EXPECT_EQ(bend_of_ratio(1.3), 0.0);
  EXPECT_EQ(bend_of_ratio(0.2), kMostBend_rad);
}

TEST(Spine, ItBendsForward) {
  const BentBack back = bent_arc({0, 0, 0.5}, kRight, 0.8);
  EXPECT_LT(glm::distance(back.upper * Vec3(0, 0, 1), Vec3(0, std::sin(0.4), std::cos(0.4))), kRounding);
}

TEST(Spine, ManyPiecesAreAnArc) {
  const std::vector<Vec3> pieces(2000, Vec3(0, 0, 0.5 / 2000));
  const BentBack fine = bent_back(pieces, kRight, 1.2), arc = bent_arc({0, 0, 0.5}, kRight, 1.2);
  EXPECT_LT(glm::distance(fine.end, arc.end), 1e-6);
  EXPECT_LT(glm::length(fine.upper[2] - arc.upper[2]), 1e-3);
}

TEST(Spine, PiecesTurnEvenlyAndJoinIntoTheChord) {
  const std::vector<Vec3> pieces{{0.0, 0.03, 0.1}, {0.0, -0.01, 0.15}, {0.001, -0.04, 0.1}, {-0.001, 0.01, 0.12}};
  Vec3 chord(0.0), end(0.0);
  const BentBack back = bent_back(pieces, kRight, 1.0);
  for (std::size_t i = 0; i < pieces.size(); ++i) chord += pieces[i], end += back.turns[i] * pieces[i];
  EXPECT_LT(glm::distance(end, back.end), kRounding);
  EXPECT_LT(glm::length(glm::cross(glm::normalize(chord), glm::normalize(end))), kRounding);
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const Mat3 between = back.turns[i] * glm::transpose(back.turns[i - 1]);
    const double angle = std::acos(std::clamp(0.5 * (between[0][0] + between[1][1] + between[2][2] - 1.0), -1.0, 1.0));
    const double share = 0.5 * (glm::length(pieces[i]) + glm::length(pieces[i - 1]));
    double whole = 0.0;
    for (const Vec3& piece : pieces) whole += glm::length(piece);
    EXPECT_NEAR(angle, share / whole, 1e-9) << i;
  }
}

TEST(Spine, OnePieceDoesNotBend) {
  const Body stiff = Body::from_stature(1.7).bending_at({});
  const BentStand stand = bent_stand(stiff, 1.0);
  for (std::size_t j = 0; j < kJointCount; ++j)
    EXPECT_LT(glm::distance(stand.posture[j], stiff.posture()[j]), kRounding);
}

TEST(Spine, WhatIsAboveMovesAsOnePiece) {
  const Body body = Body::from_stature(1.75, Sex::female);
  const BentStand stand = bent_stand(body, 1.0);
  for (const Joint j : {suprasternale, left_clavicle, right_shoulder, left_grip, nasion}) {
    EXPECT_NEAR(glm::distance(stand.posture[index(j)], stand.posture[index(c7t1)]), body.distance(j, c7t1), kRounding);
  }
  EXPECT_NEAR(glm::distance(stand.posture[index(l5s1)], stand.posture[index(c7t1)]),
              body.distance(l5s1, c7t1) * ratio_of_bend(1.0), kRounding);
  EXPECT_EQ(stand.posture[index(left_hip)], body.at(left_hip));
}

TEST(Spine, TheMirrorImageOfABodyBendsAsItsMirrorImage) {
  const Body body = Body::from_stature(1.7);
  const Vec3 waist = body.at(l5s1), up = body.at(c7t1) - waist;
  const Body bony = body.bending_at({waist + 0.3 * up + Vec3(0.01, 0.02, 0), waist + 0.6 * up});
  const Posture one = mirrored(bent_stand(bony, 0.9).posture), other = bent_stand(mirrored(bony), 0.9).posture;
  for (std::size_t j = 0; j < kJointCount; ++j) EXPECT_LT(glm::distance(one[j], other[j]), kRounding);
}

}  // namespace
}  // namespace reachcast
