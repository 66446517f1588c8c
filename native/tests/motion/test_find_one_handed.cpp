// SPDX-License-Identifier: GPL-3.0-or-later
/// Recordings of one hand at work, found and labelled.
#include <gtest/gtest.h>

#include "made_one_handed.hpp"
#include "made_session.hpp"
#include "reachcast/motion/labels.hpp"

namespace reachcast {
namespace {

using namespace tests;

const Subject kPerson{1.75, {}, {}, {}};
const Vec3 kRest(0.25, 0.08, 0.88), kCounter(0.25, 0.36, 1.0), kTop(0.32, 0.38, 1.3), kInHand(0.0, 0.0, -0.06);

/// Reach, transfer, return; the left hand is that of the mirror image.
Session one_handed_session(Hands hands, double rate_hz = 60.0) {
  const Body body = Body::from_stature(1.75);
  Session session;
  session.clip.source = "made";
  session.clip.rate_hz = rate_hz;
  for (const std::string_view name : joint_names()) session.clip.names.emplace_back(name);
  session.clip.derived.assign(kJointCount, false);
  const auto stay = [&](const Vec3& at, const Vec3& to, const Vec3& object, bool held) {
    const auto frames = static_cast<int>(1.1 * rate_hz);
    for (int f = 0; f < frames; ++f) {
      const double share = smooth_step(f / static_cast<double>(frames - 1));
      const Vec3 hold = at + share * (to - at);
      const Posture right = right_handed_posture(body, hold, 0.1 - 0.2 * share), left = mirrored(right);
      const Posture& now = hands == Hands::left ? left : right;
      session.clip.positions.insert(session.clip.positions.end(), now.begin(), now.end());
      const Vec3 box = held ? hold + kInHand : object;
      session.object.positions.push_back(hands == Hands::left ? box * Vec3(-1, 1, 1) : box);
    }
  };
  const Vec3 here = kCounter + kInHand, there = kTop + kInHand;
  stay(kRest, kRest, here, false);
  stay(kRest, kCounter, here, false);
  stay(kCounter, kCounter, here, false);
  stay(kCounter, kTop, here, true);
  stay(kTop, kTop, there, false);
  stay(kTop, kRest, there, false);
  stay(kRest, kRest, there, false);
  return session;
}

std::string found_in(const FoundReaches& found) {
  std::string text;
  for (const Reach& reach : found.reaches)
    text += std::string(phase_name(reach.phase)) + " " + std::string(hands_name(reach.hands)) + ", ";
  for (const Rejection& r : found.rejections) text += r.what + ": " + r.reason + ", ";
  return text;
}

TEST(FindOneHanded, TheHandThatWorksIsFoundWithAndWithoutAnObject) {
  for (const Hands hands : {Hands::right, Hands::left}) {
    const Session session = one_handed_session(hands);
    const std::string with = " " + std::string(hands_name(hands)) + ", ";
    const std::string wanted = "reach" + with + "transfer" + with + "return" + with;
    EXPECT_EQ(found_in(find_reaches(session.clip, kPerson, {}, {session.object, {}, "made"})), wanted);
    const FoundReaches found = find_reaches(session.clip, kPerson);
    EXPECT_EQ(found_in(found), wanted);
    const Vec3 side(hands == Hands::left ? -1.0 : 1.0, 1.0, 1.0);
    EXPECT_LT(glm::distance(found.reaches[1].hold_point(found.reaches[1].frames() - 1), side * kTop), 0.03);
  }
}

TEST(FindOneHanded, BothHandsAtWorkStayBoth) {
  const Session session = made_session(there_and_back());
  for (const Reach& reach : find_reaches(session.clip, kPerson).reaches) EXPECT_EQ(reach.hands, Hands::both);
}

TEST(FindOneHanded, ALabelSaysWhichHand) {
  const Session session = one_handed_session(Hands::left);
  const auto labels = [](const std::string& hands) {
    return parse_labels("file,phase,first,last,hands\nmade,transfer,196,264," + hands + "\n", "labels.csv");
  };
  const FoundReaches left = cut_labelled(session.clip, labels("left"), kPerson);
  ASSERT_EQ(left.reaches.size(), 1u) << found_in(left);
  EXPECT_EQ(left.reaches[0].hands, Hands::left);
  EXPECT_TRUE(cut_labelled(session.clip, labels(""), kPerson).reaches.empty()) << "two hands are not alike there";
  EXPECT_THROW((void)labels("third"), std::invalid_argument);
}

}  // namespace
}  // namespace reachcast
