// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/rig/limbs.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "rig/rig_cases.hpp"

namespace reachcast {
namespace {

using tests::difference;
using tests::kRounding;

constexpr std::size_t kFrames = 60;
constexpr HingeJoints kKnee{Joint::left_hip, Joint::left_knee, Joint::left_ankle};
const HingeRest kStraight{{0, 0, -1}, {0, 0, -1}, {1, 0, 0}};
const std::vector<Mat3> kStill(kFrames, Mat3(1.0));

/// A limb of two unit links. The upper hangs from the origin after `turn`, the lower bends about x by `bend_rad`.
Posture bent_limb(const Mat3& turn, double bend_rad) {
  Posture at{};
  at[index(Joint::left_knee)] = turn * Vec3(0, 0, -1);
  at[index(Joint::left_ankle)] = at[index(Joint::left_knee)] + turn * turn_about({1, 0, 0}, bend_rad) * Vec3(0, 0, -1);
  return at;
}

/// A swing about `axis` while the limb goes from bent to straight (for a stretch) and back.
std::vector<Posture> through_straight(const Vec3& axis, double swing_rad) {
  std::vector<Posture> motion;
  for (std::size_t f = 0; f < kFrames; ++f) {
    const double t = static_cast<double>(f) / (kFrames - 1);
    motion.push_back(bent_limb(turn_about(axis, swing_rad * t), std::max(0.0, std::cos(2.0 * kPi * t))));
  }
  return motion;
}

struct Links {
  std::vector<Mat3> upper = std::vector<Mat3>(kFrames), lower = upper;
};

Links turned(const std::vector<Posture>& motion, const HingeRest& rest = kStraight) {
  Links links;
  turn_hinge(rest, kKnee, motion, kStill, links.upper, links.lower);
  return links;
}

TEST(Hinge, LinkDirectionsAreExact) {
  const std::vector<Posture> motion = through_straight(glm::normalize(Vec3(1, 2, 3)), 2.0);
  const HingeRest rest{glm::normalize(Vec3(0, 0.3, -1)), glm::normalize(Vec3(0, -0.2, -1)), {1, 0, 0}};
  const Links links = turned(motion, rest);
  for (std::size_t f = 0; f < kFrames; ++f) {
    const Vec3 knee = motion[f][index(Joint::left_knee)], ankle = motion[f][index(Joint::left_ankle)];
    EXPECT_LT(glm::distance(links.upper[f] * rest.upper, knee), kRounding);
    EXPECT_LT(glm::distance(links.lower[f] * rest.lower, ankle - knee), kRounding);
  }
}

TEST(Hinge, BothLinksShareItsAxis) {
  const Links links = turned(through_straight({0, 0, 1}, 1.0));
  for (std::size_t f = 0; f < kFrames; ++f) {
    EXPECT_LT(glm::distance(links.upper[f] * kStraight.normal, links.lower[f] * kStraight.normal), 1e-9);
  }
}

TEST(Hinge, NeverFlipsThroughStraight) {
  for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(0, 1, 0), Vec3(1, 0, 0), glm::normalize(Vec3(-1, 1, 2))}) {
    for (const double swing : {0.0, 0.7, 2.0}) {
      const Links links = turned(through_straight(axis, swing));
      for (std::size_t f = 1; f < kFrames; ++f) {
        const double step = glm::distance(links.upper[f] * kStraight.normal, links.upper[f - 1] * kStraight.normal);
        EXPECT_LT(step, 2.0 * swing / kFrames + 1e-6) << "frame " << f << ", swing " << swing;
      }
    }
  }
}

/// While straight, the normal turns evenly from the one before to the one after.
TEST(Hinge, TwistsEvenlyBetweenBentFrames) {
  const double twist = 1.2;
  std::vector<Posture> motion(kFrames, bent_limb(Mat3(1.0), 0.0));
  motion.front() = bent_limb(Mat3(1.0), 0.5);
  motion.back() = bent_limb(turn_about({0, 0, -1}, twist), 0.5);
  const Links links = turned(motion);
  for (std::size_t f = 0; f < kFrames; ++f) {
    const double share = static_cast<double>(f) / (kFrames - 1);
    EXPECT_LT(difference(links.upper[f], turn_about({0, 0, -1}, share * twist)), kRounding);
  }
}

TEST(Hinge, FollowsTheBoneAboveWhenNeverBent) {
  const std::vector<Posture> motion(kFrames, bent_limb(Mat3(1.0), 0.0));
  const std::vector<Mat3> above(kFrames, turn_about({0, 0, 1}, 0.8));
  Links links;
  turn_hinge(kStraight, kKnee, motion, above, links.upper, links.lower);
  EXPECT_LT(difference(links.upper[7], above[7]), kRounding);
  EXPECT_LT(difference(links.lower[7], above[7]), kRounding);
}

TEST(Unwrap, GivesBackWhatWasWrapped) {
  std::vector<double> angles, wrapped;
  for (int i = 0; i < 400; ++i) angles.push_back(20.0 * std::sin(0.05 * i));
  for (const double angle : angles) wrapped.push_back(std::remainder(angle, 2.0 * kPi));
  unwrap(wrapped);
  for (std::size_t i = 0; i < angles.size(); ++i) EXPECT_NEAR(wrapped[i], angles[i], 1e-12 * 20.0 * kPi);
  std::vector<double> half{0.0, kPi, 0.0, -kPi, -2.0 * kPi};
  const std::vector<double> same = half;
  unwrap(half);
  EXPECT_EQ(half, same);  // half a turn is no jump
  unwrap({});
}

/// Arms ahead, the right hand turned about its own axis through more than a turn by where the left grip is.
struct Pronation {
  std::vector<Mat3> forearm = std::vector<Mat3>(kFrames, Mat3(1.0)), hand = forearm;
  Pronation(double from_rad, double to_rad) {
    const HandRest rest{{0, 1, 0}, {0, 0, -1}};
    std::vector<Posture> motion(kFrames);
    for (std::size_t f = 0; f < kFrames; ++f) {
      const double twist = from_rad + (to_rad - from_rad) * static_cast<double>(f) / (kFrames - 1);
      Posture& at = motion[f];
      at[index(Joint::right_wrist)] = {0, 1, 0};
      at[index(Joint::right_grip)] = {0, 1.1, 0};
      at[index(Joint::left_grip)] = at[index(Joint::right_grip)] + turn_about({0, 1, 0}, twist) * Vec3(0, 0, -0.5);
    }
    turn_hand(rest, arms()[1], motion, forearm, hand);
  }
};

TEST(Hand, SharesItsTwistWithTheForearm) {
  const Pronation p(-1.0, 1.5);
  for (std::size_t f = 0; f < kFrames; ++f) {
    const double twist = -1.0 + 2.5 * static_cast<double>(f) / (kFrames - 1);
    EXPECT_LT(difference(p.hand[f], turn_about({0, 1, 0}, twist)), kRounding);
    EXPECT_LT(difference(p.forearm[f], turn_about({0, 1, 0}, 0.5 * twist)), kRounding);
  }
}

TEST(Hand, PassesHalfATurnWithoutAJumpAndStopsAtItsLimit) {
  const Pronation p(0.5, 4.0);  // wraps at pi; the mean is nearest to no whole turn
  for (std::size_t f = 0; f < kFrames; ++f) {
    const double twist = 0.5 + 3.5 * static_cast<double>(f) / (kFrames - 1);
    EXPECT_LT(difference(p.hand[f], turn_about({0, 1, 0}, std::min(twist, kMaxHandTwist_rad))), kRounding);
  }
}

/// The left foot in place after `pitch` (toes down positive) about the sideways axis, then `yaw` about the vertical.
std::vector<Posture> feet(const std::vector<double>& pitch, double yaw) {
  std::vector<Posture> motion(pitch.size());
  for (std::size_t f = 0; f < pitch.size(); ++f) {
    motion[f][index(Joint::left_ball)] =
        turn_about({0, 0, 1}, yaw) * turn_about({1, 0, 0}, -pitch[f]) * Vec3(0, 0.2, 0);
  }
  return motion;
}

const FootRest kFlatFoot{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}};

TEST(Foot, StaysLevelWhateverTheShinDoes) {
  const std::vector<Posture> motion = feet(std::vector<double>(kFrames, 0.3), 0.4);
  std::vector<Mat3> shin(kFrames), foot(kFrames), toe(kFrames);
  for (std::size_t f = 0; f < kFrames; ++f) shin[f] = turn_about({0, 0, 1}, 0.1 * static_cast<double>(f));
  turn_foot(kFlatFoot, legs()[0], motion, shin, foot, toe);
  const Mat3 yaw = turn_about({0, 0, 1}, 0.4);
  for (std::size_t f = 0; f < kFrames; ++f) {
    EXPECT_LT(difference(foot[f], yaw * turn_about({1, 0, 0}, -0.3)), kRounding);
    EXPECT_LT(difference(toe[f], yaw), kRounding);
  }
}

/// A foot that swings back past straight down, with its shin, and later forward again.
TEST(Foot, DoesNotTurnRoundWhenItSwingsPastStraightDown) {
  std::vector<double> pitch;
  std::vector<Mat3> shin, foot(kFrames), toe(kFrames);
  for (std::size_t f = 0; f < kFrames; ++f) {
    pitch.push_back(2.6 * std::sin(kPi * static_cast<double>(f) / (kFrames - 1)));
    shin.push_back(turn_about({1, 0, 0}, -pitch.back()));
  }
  turn_foot(kFlatFoot, legs()[0], feet(pitch, 0.0), shin, foot, toe);
  for (std::size_t f = 0; f < kFrames; ++f) EXPECT_LT(difference(foot[f], shin[f]), 1e-9) << "pitch " << pitch[f];
}

}  // namespace
}  // namespace reachcast
