// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/contact.hpp"

#include <gtest/gtest.h>

namespace reachcast {
namespace {

constexpr double kStature_m = 1.72;

OrientedBox box_at(const Vec3& centre) {
  return {centre, Vec3(0.18, 0.14, 0.12), Mat3(1.0)};
}

Posture standing() {
  return Body::from_stature(kStature_m).posture();
}

TEST(Contact, NobodyStandsInHisOwnArms) {
  const Depths depths = depths_of(capsules_of(standing(), kStature_m), box_at({0.0, 0.6, 1.0}));
  for (const double depth : depths) EXPECT_EQ(depth, 0.0);
}

TEST(Contact, ABoxAgainstTheBellyIsAsDeepAsItWasPushed) {
  const BodyCapsules body = capsules_of(standing(), kStature_m);
  const Capsule& waist = body[index(BodyPart::waist_left)];
  const double front = std::max(waist.a.y, waist.b.y) + waist.radius_m, height = 0.5 * (waist.a.z + waist.b.z);
  double last = 0.0;
  for (const double in : {0.01, 0.03, 0.06}) {
    const double depth = depths_of(body, box_at({0.0, front + 0.14 - in, height}))[index(Mover::box)];
    EXPECT_GT(depth, last);
    EXPECT_LE(depth, in + 1e-9);
    last = depth;
  }
  EXPECT_EQ(depths_of(body, box_at({0.0, front + 0.25, height}))[index(Mover::box)], 0.0);
}

TEST(Contact, AHandInAThighIsNamedAndFreedByItsWayOut) {
  using enum Joint;
  Posture posture = standing();
  const Vec3 thigh = 0.5 * (posture[index(left_hip)] + posture[index(left_knee)]);
  const Vec3 by = thigh - posture[index(left_grip)];
  for (const Joint j : {left_wrist, left_grip, left_hand_front, left_hand_back}) posture[index(j)] += by;
  const BodyCapsules body = capsules_of(posture, kStature_m);
  bool found = false;
  for (const Contact& contact : contacts_of(body, box_at({0.0, 0.8, 1.0}))) {
    EXPECT_TRUE(contact.mover == Mover::left_hand || contact.mover == Mover::left_forearm);
    if (contact.mover != Mover::left_hand || contact.part != BodyPart::left_thigh) continue;
    found = true;
    Capsule hand = capsule_of(contact.mover, body);
    hand.a += contact.depth_m * contact.direction;
    hand.b += contact.depth_m * contact.direction;
    EXPECT_NEAR(penetration(hand, body[index(contact.part)]).depth_m, 0.0, 1e-9);
  }
  EXPECT_TRUE(found);
  EXPECT_EQ(mover_name(Mover::left_hand), "left hand");
  EXPECT_EQ(body_part_name(BodyPart::left_thigh), "left thigh");
}

TEST(Contact, TheMirroredBodyHasTheMirroredContacts) {
  Posture posture = standing();
  posture[index(Joint::right_wrist)] = posture[index(Joint::l5s1)] + Vec3(0.03, 0.05, 0.1);
  posture[index(Joint::left_elbow)] = posture[index(Joint::suprasternale)];
  const Depths one = depths_of(capsules_of(posture, kStature_m), box_at({0.05, 0.2, 0.9}));
  const Depths other = depths_of(capsules_of(mirrored(posture), kStature_m), box_at({-0.05, 0.2, 0.9}));
  EXPECT_NEAR(one[index(Mover::left_forearm)], other[index(Mover::right_forearm)], 1e-12);
  EXPECT_NEAR(one[index(Mover::right_hand)], other[index(Mover::left_hand)], 1e-12);
  EXPECT_NEAR(one[index(Mover::box)], other[index(Mover::box)], 1e-12);
  EXPECT_GT(one[index(Mover::right_hand)], 0.0);
}

}  // namespace
}  // namespace reachcast
