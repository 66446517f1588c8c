// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/predict.hpp"

#include <gtest/gtest.h>

#include <random>
#include <regex>

#include "predict/predict_cases.hpp"

namespace reachcast {
namespace {

using enum Joint;
using namespace tests;

constexpr double kExact_m = 1e-6;     // links and grips: the promise of the issue is a thousand times wider
constexpr double kRetarget_m = 0.01;  // mean over joints and frames: eight splines cost 1 to 4 mm on these lifts
constexpr double kMirror_m = 1e-6;    // the same arithmetic with left and right exchanged

/// Grips from handles while held, and feet from where they stand, whichever is worse.
double worst_end(const Body& body, const Task& t, const Motion& motion) {
  double worst = 0.0;
  for (std::size_t f = 0; f < motion.postures.size(); ++f) {
    const Posture& p = motion.postures[f];
    if (f >= frame(motion, "grasp") && f <= frame(motion, "release")) {
      worst = std::max({worst, glm::distance(p[index(left_grip)], grip_of(t.object, motion.box[f], true)),
                        glm::distance(p[index(right_grip)], grip_of(t.object, motion.box[f], false))});
    }
    for (const Joint j : {left_ball, left_ankle, right_ball, right_ankle}) {
      worst = std::max(worst, glm::distance(p[index(j)], body.at(j)));
    }
  }
  return worst;
}

TEST(Predict, OneMotionOnItsOwnBodyAndTaskGivesTheRecordingBack) {
  for (const double stature : {1.55, 1.72, 1.9}) {
    for (const double height : {0.85, 1.1, 1.35}) {
      const std::size_t frames = 31;
      const Reach reach = made_lift(stature, {0.02, 0.42, 0.3}, {0.02, 0.42, height}, frames);
      TemporaryFolder folder;
      Corpus corpus = Corpus::create(folder / "one.sqlite");
      corpus.add(std::vector{encode_reach(reach)});
      const Body body = Body::from_stature(stature);
      const Motion motion =
          predict(corpus, subject(stature), task(reach.hold_point(0) - kUp, reach.hold_point(frames - 1) - kUp), body,
                  options(24.0, 1));
      ASSERT_EQ(frame(motion, "placed") - frame(motion, "lift_off") + 1, frames);
      double sum = 0.0;
      for (std::size_t f = 0; f < frames; ++f) {
        for (std::size_t j = 0; j < kJointCount; ++j) {
          sum += glm::distance(motion.postures[frame(motion, "lift_off") + f][j], reach.postures[f][j]);
        }
      }
      const double mean = sum / static_cast<double>(frames * kJointCount);
      EXPECT_LT(mean, kRetarget_m) << "stature " << stature << ", shelf " << height;
      RecordProperty("mean_error_mm_" + std::to_string(int(100 * stature)) + "_" + std::to_string(int(100 * height)),
                     std::to_string(1000.0 * mean));
    }
  }
}

TEST(Predict, AStoredMotionAloneIsWhatACorpusOfItGives) {
  TemporaryFolder folder;
  Corpus many = Corpus::create(folder / "many.sqlite");
  std::vector<MotionCode> codes;
  for (const double stature : {1.6, 1.7, 1.8})
    codes.push_back(encode_reach(made_lift(stature, {0.02, 0.42, 0.3}, {0.02, 0.42, 0.6 + 0.3 * stature}, 25)));
  for (std::size_t i = 0; i < codes.size(); ++i) codes[i].origin = "lift " + std::to_string(i);
  const std::vector<std::int64_t> ids = many.add(codes);
  const Body body = Body::from_stature(1.75);
  const Task t = task({0.0, 0.4, 0.4}, {0.1, 0.45, 1.2});
  for (std::size_t i = 0; i < codes.size(); ++i) {
    Corpus one = Corpus::create(folder / ("one" + std::to_string(i)));
    one.add(std::span(codes).subspan(i, 1));
    PredictOptions nearest = options(24.0, 1);  // with an obstacle, however far, no path is raised over edges
    nearest.obstacles =
        std::make_shared<const Obstacles>(std::vector<Triangle>{{{{9.0, 9.0, 9.0}, {9.1, 9.0, 9.0}, {9.0, 9.1, 9.0}}}});
    const Motion expected = predict(one, subject(1.75), t, body, nearest);
    PredictOptions alone = options(24.0, 5);
    alone.motion = ids[i];
    const Motion motion = predict(many, subject(1.75), t, body, alone);
    ASSERT_EQ(motion.postures.size(), expected.postures.size());
    for (std::size_t f = 0; f < motion.postures.size(); ++f) {
      for (std::size_t j = 0; j < kJointCount; ++j)
        EXPECT_LT(glm::distance(motion.postures[f][j], expected.postures[f][j]), 1e-9);
    }
    ASSERT_EQ(motion.neighbours.at(0).neighbours.size(), 1U);
    EXPECT_EQ(motion.neighbours[0].neighbours[0].origin, codes[i].origin);
    alone.phases = {Phase::reach};
    EXPECT_THROW((void)predict(many, subject(1.75), t, body, alone), std::invalid_argument);
    alone.phases = {Phase::transfer};
    alone.motion = 77;
    EXPECT_THROW((void)predict(many, subject(1.75), t, body, alone), std::invalid_argument);
  }
}

TEST(Predict, TwoCallsAgreeInEveryBit) {
  const Task t = task({0.0, 0.42, 0.0}, {0.2, 0.4, 0.95});
  const Body body = Body::from_stature(1.68);
  const Motion a = predict(made_corpus(), subject(1.68), t, body), b = predict(made_corpus(), subject(1.68), t, body);
  ASSERT_EQ(a.postures.size(), b.postures.size());
  for (std::size_t f = 0; f < a.postures.size(); ++f) {
    ASSERT_EQ(a.postures[f], b.postures[f]) << f;
    ASSERT_EQ(a.box[f].position, b.box[f].position);
  }
  EXPECT_EQ(a.times_s, b.times_s);
}

TEST(Predict, AMirroredTaskGivesTheMirroredMotion) {
  const Body body = Body::from_stature(1.74);
  for (const double x : {0.08, 0.21, 0.33}) {
    const Task right = task({0.04, 0.42, 0.1}, {x, 0.41, 0.98}), left = task({-0.04, 0.42, 0.1}, {-x, 0.41, 0.98});
    const Motion a = predict(made_corpus(), subject(1.74), right, body),
                 b = predict(made_corpus(), subject(1.74), left, body);
    ASSERT_EQ(a.postures.size(), b.postures.size());
    double worst = 0.0;
    for (std::size_t f = 0; f < a.postures.size(); ++f) {
      for (std::size_t j = 0; j < kJointCount; ++j) {
        const Vec3& other = b.postures[f][index(mirrored(static_cast<Joint>(j)))];
        worst = std::max(worst, glm::distance(a.postures[f][j], other * Vec3(-1, 1, 1)));
      }
    }
    EXPECT_LT(worst, kMirror_m) << "target " << x << " m to the side";
  }
}

TEST(Predict, LinksGripsAndFeetAreExactOnRandomBodiesAndTasks) {
  std::mt19937_64 random(2007);
  const auto between = [&](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
  const std::regex refusal(R"(is \d+\.\d cm out of reach from the (left|right) (shoulder|hip)$)");
  int done = 0;
  constexpr int kTrials = 3000;
  for (int trial = 0; trial < kTrials; ++trial) {
    const double stature = between(1.45, 2.0);
    std::map<std::string, double> lengths = Body::from_stature(stature, trial % 2 ? Sex::female : Sex::male).lengths();
    for (const char* segment : {"shank", "thigh", "trunk", "upper_arm", "forearm"})
      lengths[segment] *= between(0.93, 1.07);
    const Body body = Body::from_lengths(stature, lengths);
    Task t = task({between(-0.25, 0.25), between(0.35, 0.5), between(0.0, 0.9)},
                  {between(-0.45, 0.45), between(0.25, 0.5), between(0.1, 1.7)});
    t.target_yaw_rad = between(-0.8, 0.8);
    t.object.mass_kg = between(0.0, 20.0);
    try {
      const Motion motion = predict(made_corpus(), subject(stature), t, body, options(6.0, 5));
      ASSERT_LT(worst_link(body, motion), kExact_m) << trial;
      ASSERT_LT(worst_end(body, t, motion), kExact_m) << trial;
      ASSERT_LT(glm::distance(motion.box[frame(motion, "release")].position, t.target), kExact_m) << trial;
      ++done;
    } catch (const std::invalid_argument& error) {
      ASSERT_TRUE(std::regex_search(error.what(), refusal)) << trial << ": " << error.what();
    }
  }
  EXPECT_GT(done, kTrials / 2);
  RecordProperty("predicted", done);
}

TEST(Predict, AnyFrameRateTellsTheSameStory) {
  const Task t = task({0.0, 0.42, 0.0}, {0.1, 0.42, 1.0});
  const Body body = Body::from_stature(1.72);
  for (const double rate : {1.0, 5.0, 12.0, 23.976, 30.0, 60.0, 120.0, 240.0}) {
    const Motion motion = predict(made_corpus(), subject(1.72), t, body, options(rate, 5));
    std::vector<std::string> names;
    for (const Event& event : motion.plan.events) names.push_back(event.name);
    EXPECT_EQ(names, (std::vector<std::string>{"grasp", "lift_off", "placed", "release", "end"}));
    for (std::size_t i = 1; i < 5; ++i) EXPECT_LT(motion.plan.events[i - 1].frame, motion.plan.events[i].frame) << rate;
    const std::size_t end = motion.plan.end, lift_off = frame(motion, "lift_off"), placed = frame(motion, "placed");
    ASSERT_EQ(motion.postures.size(), end + 1) << rate;
    ASSERT_EQ(motion.box.size(), end + 1) << rate;
    for (std::size_t f = 0; f <= end; ++f) ASSERT_DOUBLE_EQ(motion.times_s[f], static_cast<double>(f) / rate);
    EXPECT_EQ(motion.box[lift_off].position, t.home) << rate;
    EXPECT_EQ(motion.box[placed].position, t.target) << rate;
    EXPECT_LT(worst_link(body, motion), kExact_m) << rate;
    EXPECT_LT(worst_end(body, t, motion), kExact_m) << rate;
    if (rate < 5.0) continue;  // a transfer takes at least four frames
    EXPECT_NEAR(static_cast<double>(placed - lift_off) / rate, 1.25, 0.5 / rate + 1e-9) << "as all the made lifts take";
  }
}

TEST(Predict, NoJointLeapsFromFrameToFrame) {
  constexpr double kRate = 240.0, kFastest_m_s = 4.0;  // hands that throw a light box peak at some 3 m/s
  const Body body = Body::from_stature(1.72);
  for (const double x : {-0.3, 0.0, 0.2}) {
    for (const double z : {0.2, 0.7, 1.2}) {
      const Motion motion =
          predict(made_corpus(), subject(1.72), task({0, 0.42, 0}, {x, 0.4, z}), body, options(kRate, 5));
      double step = 0.0;
      for (std::size_t f = 1; f < motion.postures.size(); ++f) {
        for (std::size_t j = 0; j < kJointCount; ++j) {
          step = std::max(step, glm::distance(motion.postures[f][j], motion.postures[f - 1][j]));
        }
      }
      EXPECT_LT(step * kRate, kFastest_m_s) << "target " << x << ", " << z;
    }
  }
}

TEST(Predict, TheDurationIsTheOneAskedFor) {
  const Motion motion = predict(made_corpus(), subject(1.72), task({0, 0.42, 0}, {0, 0.42, 1.0}),
                                Body::from_stature(1.72), options(50.0, 5, {{Phase::transfer, 2.4}}));
  EXPECT_EQ(frame(motion, "placed") - frame(motion, "lift_off"), 120u);
}

TEST(Predict, WeightsAddUpAndDistancesAreThoseOfTheMotionsNamed) {
  const Task t = task({0.0, 0.42, 0.0}, {0.1, 0.42, 1.0});
  const Motion motion = predict(made_corpus(), subject(1.7), t, Body::from_stature(1.7));
  double sum = 0.0;
  ASSERT_EQ(motion.neighbours.size(), 1u);
  for (const Neighbour& n : motion.neighbours.front().neighbours) {
    const StoredMotion stored = made_corpus().load(std::vector{n.id}).front();
    sum += n.weight;
    EXPECT_EQ(n.origin, stored.code.origin);
    EXPECT_EQ(n.is_mirrored, stored.code.is_mirrored);
    EXPECT_DOUBLE_EQ(n.target_distance_m, glm::distance(stored.code.target, t.target + kUp));
    EXPECT_DOUBLE_EQ(n.home_distance_m, glm::distance(stored.code.home, t.home + kUp));
    EXPECT_DOUBLE_EQ(n.stature_difference_m, std::abs(stored.code.subject.stature_m - 1.7));
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

}  // namespace
}  // namespace reachcast
