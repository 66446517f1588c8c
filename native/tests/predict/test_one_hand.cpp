// SPDX-License-Identifier: GPL-3.0-or-later
/// The same with one hand.
#include <gtest/gtest.h>

#include "motion/made_one_handed.hpp"
#include "predict/predict_cases.hpp"
#include "reachcast/posture/whole_body.hpp"
#include "reachcast/predict/performance.hpp"
#include "reachcast/predict/replay.hpp"

namespace reachcast {
namespace {

using enum Phase;
using namespace tests;

constexpr double kExact_m = 1e-6;
constexpr double kReplayed_m = 0.02;  // eight splines of a motion whose legs and hanging arm are nearly straight
const Vec3 kHome(0.25, 0.32, 1.0), kRest(0.26, 0.15, 0.92);

/// Right-handed motions of all four phases, with mirror images, so that there are left-handed ones too.
class OneHandedCorpus {
 public:
  OneHandedCorpus() {
    std::vector<MotionCode> codes;
    for (const double stature : {1.6, 1.7, 1.8}) {
      for (const Vec3& target : {Vec3(0.2, 0.36, 1.2), Vec3(0.35, 0.32, 1.1), Vec3(0.3, 0.35, 1.35)}) {
        add(codes, made_one_handed(stature, kHome, target, Hands::right), transfer);
        add(codes, made_one_handed(stature, kRest, target, Hands::right), reach);
      }
    }
    corpus_.add(codes);
  }
  [[nodiscard]] const Corpus& operator*() const { return corpus_; }

 private:
  static void add(std::vector<MotionCode>& codes, Reach reach, Phase phase) {
    reach.phase = phase;
    for (const Reach& each : {reach, reversed(reach)}) {
      codes.push_back(encode_reach(each));
      codes.push_back(encode_reach(mirrored(each)));
      codes.back().is_mirrored = true;
    }
  }
  TemporaryFolder folder_;
  Corpus corpus_ = Corpus::create(folder_ / "one_handed.sqlite");
};

const Corpus& one_handed() {
  static const OneHandedCorpus made;
  return *made;
}

const Box kCup{0.08, 0.08, 0.2, 0.1, 0.12, 1.0};

Task one_hand_task(Hands hands) {
  const Vec3 side(hands == Hands::left ? -1.0 : 1.0, 1.0, 1.0);
  return {
      .home = side * Vec3(0.25, 0.40, 0.85), .target = side * Vec3(0.32, 0.40, 1.15), .object = kCup, .hands = hands};
}

PredictOptions of(std::vector<Phase> phases, double rate = 24.0) {
  PredictOptions how = options(rate);
  how.phases = std::move(phases);
  return how;
}

const std::vector<std::vector<Phase>> kSequences{
    {transfer}, {retrieve}, {reach, transfer, return_}, {reach, transfer, return_, reach, retrieve, return_}};

TEST(OneHandPrediction, TheWorkingHandIsOnTheObjectAndTheFeetStay) {
  for (const Hands hands : {Hands::right, Hands::left}) {
    const Joint grip = hands == Hands::right ? Joint::right_grip : Joint::left_grip;
    for (const double stature : {1.6, 1.85}) {
      const Body body = Body::from_stature(stature);
      for (const auto& phases : kSequences) {
        const Motion motion = predict(one_handed(), subject(stature), one_hand_task(hands), body, of(phases));
        EXPECT_LT(worst_link(body, motion), kExact_m);
        for (const Stage& stage : motion.plan.stages) {
          for (std::size_t f = stage.first; is_loaded(stage.phase) && f <= stage.last; ++f) {
            const Vec3 middle = motion.box[f].position + Vec3(0, 0, kCup.handle_height_m);
            ASSERT_LT(glm::distance(motion.postures[f][index(grip)], middle), kExact_m);
          }
        }
        for (const Posture& p : motion.postures) {
          for (const Joint j : {Joint::left_ball, Joint::left_ankle, Joint::right_ball, Joint::right_ankle})
            ASSERT_LT(glm::distance(p[index(j)], body.at(j)), kExact_m);
        }
      }
    }
  }
}

TEST(OneHandPrediction, TheFreeHandHangsBesideTheThigh) {
  const Body body = Body::from_stature(1.75);
  const Motion motion = predict(one_handed(), subject(1.75), one_hand_task(Hands::right), body, of(kSequences.back()));
  for (const Posture& p : motion.postures) {
    const Vec3 hang = p[index(Joint::left_grip)] - p[index(Joint::left_shoulder)];
    EXPECT_LT(hang.z, -0.9 * glm::length(hang));
    EXPECT_LT(p[index(Joint::left_grip)].x, p[index(Joint::left_hip)].x);
  }
}

TEST(OneHandPrediction, HasNoJumpInPlaceOrSpeedWherePhasesMeet) {
  const Body body = Body::from_stature(1.75);
  const auto worst = [&](double rate, int order) {
    const Motion motion =
        predict(one_handed(), subject(1.75), one_hand_task(Hands::left), body, of(kSequences.back(), rate));
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

TEST(OneHandPrediction, TheLeftHandDoesWhatTheMirrorImageOfTheRightHandDoes) {
  const Body body = Body::from_stature(1.75);
  const auto with = [&](Hands hands) {
    return predict(one_handed(), subject(1.75), one_hand_task(hands), body, of({reach, transfer, return_}));
  };
  const Motion right = with(Hands::right), left = with(Hands::left);
  ASSERT_EQ(left.postures.size(), right.postures.size());
  for (std::size_t f = 0; f < left.postures.size(); ++f) {
    const Posture image = mirrored(left.postures[f]);
    for (std::size_t j = 0; j < kJointCount; ++j)
      ASSERT_LT(glm::distance(image[j], right.postures[f][j]), 1e-5) << joint_names()[j] << " at frame " << f;
  }
}

TEST(OneHandPrediction, OnlyMotionsOfThatHandAreNeighbours) {
  for (const Hands hands : {Hands::right, Hands::left}) {
    const Motion motion = predict(one_handed(), subject(1.75), one_hand_task(hands), Body::from_stature(1.75));
    for (const Neighbour& near : motion.neighbours.front().neighbours)
      EXPECT_EQ(near.is_mirrored, hands == Hands::left) << near.origin;
  }
}

TEST(OneHandPrediction, ACorpusOfBothHandsLendsItsPosturesAndSaysSo) {
  const Body body = Body::from_stature(1.75);
  const Motion motion =
      predict(made_corpus(), subject(1.75), one_hand_task(Hands::right), body, of({reach, transfer, return_}));
  ASSERT_FALSE(motion.outside_data.empty());
  EXPECT_NE(motion.outside_data.front().find("with the right hand was recorded"), std::string::npos)
      << motion.outside_data.front();
  EXPECT_LT(worst_link(body, motion), kExact_m);
  for (const Posture& p : motion.postures) {
    const Vec3 hang = p[index(Joint::left_grip)] - p[index(Joint::left_shoulder)];
    EXPECT_LT(hang.z, -0.9 * glm::length(hang));
    EXPECT_GT(p[index(Joint::c7t1)].z, p[index(Joint::l5s1)].z + 0.2) << "the trunk stands";
  }
}

TEST(OneHandPrediction, ACorpusOfOneHandHasNothingToSayAboutBoth) {
  EXPECT_THROW(
      (void)predict(one_handed(), subject(1.75), task({0, 0.42, 0.8}, {0, 0.42, 1.2}), Body::from_stature(1.75)),
      std::invalid_argument);
}

TEST(OneHandPrediction, AnotherHandsMotionCannotBeRetargeted) {
  PredictOptions how = of({transfer});
  how.motion = one_handed().table()->of(transfer, Hands::right).rows.front() + 1;
  EXPECT_NO_THROW(
      (void)predict(one_handed(), subject(1.75), one_hand_task(Hands::right), Body::from_stature(1.75), how));
  EXPECT_THROW((void)predict(one_handed(), subject(1.75), one_hand_task(Hands::left), Body::from_stature(1.75), how),
               std::invalid_argument);
}

/// Encoded and decoded again, onto the same body and between the same ends.
TEST(OneHandPrediction, AMotionComesBackAsItWas) {
  for (const Hands hands : {Hands::right, Hands::left}) {
    Reach reach = made_one_handed(1.75, kHome, {0.35, 0.38, 1.3}, hands);
    const MotionCode code = encode_reach(reach);
    MotionSummary summary;
    summary.subject = code.subject;
    summary.hands = code.hands;
    summary.home = code.home;
    summary.target = code.target;
    std::vector<double> times;
    for (std::size_t f = 0; f < reach.frames(); ++f)
      times.push_back(static_cast<double>(f) / static_cast<double>(reach.frames() - 1));
    std::vector<Posture> back(times.size());
    ASSERT_TRUE(Replay::of(summary)->perform(code, PathForm::deviation, times, back));
    double sum = 0.0;
    for (std::size_t f = 0; f < back.size(); ++f) {
      for (std::size_t j = 0; j < kRecordedJointCount; ++j) sum += glm::distance(back[f][j], reach.postures[f][j]);
    }
    EXPECT_LT(sum / static_cast<double>(back.size() * kRecordedJointCount), kReplayed_m) << hands_name(hands);
  }
}

}  // namespace
}  // namespace reachcast
