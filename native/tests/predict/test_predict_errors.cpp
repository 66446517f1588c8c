// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <functional>

#include "predict/predict_cases.hpp"

namespace reachcast {
namespace {

using namespace tests;

std::string complaint(const std::function<void()>& call) {
  return message_of<std::invalid_argument>(call);
}

TEST(Predict, SaysWhenTheTaskLiesOutsideTheData) {
  const Body body = Body::from_stature(1.72);
  const auto reasons = [&](double stature, const Vec3& home, const Vec3& target) {
    return predict(made_corpus(), subject(stature), task(home, target), body).outside_data;
  };
  EXPECT_TRUE(reasons(1.72, {0, 0.40, 0.03}, {-0.02, 0.40, 0.98}).empty());
  EXPECT_FALSE(reasons(1.72, {0, 0.40, 0.03}, {-0.45, 0.2, 0.5}).empty());
  EXPECT_FALSE(reasons(1.4, {0, 0.40, 0.03}, {-0.02, 0.40, 0.98}).empty());
}

TEST(Predict, RefusesBadInputInOneSentenceThatNamesIt) {
  const Body body = Body::from_stature(1.72);
  const Task good = task({0, 0.42, 0}, {0, 0.42, 1.0});
  const auto said = [&](double stature, const Task& t, const PredictOptions& how = {}) {
    return complaint([&] { (void)predict(made_corpus(), subject(stature), t, body, how); });
  };
  const auto expect = [](const std::string& text, const std::string& word) {
    expect_contains(text, word);
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  };
  for (const double bad : {kMissing, 0.0, -1.7, 3.0}) expect(said(bad, good), "stature");
  for (const double bad : {kMissing, 0.0, 0.5, 1001.0, -24.0}) expect(said(1.72, good, options(bad)), "frame_rate");
  for (const double bad : {kMissing, 0.0, 61.0})
    expect(said(1.72, good, options(24, 5, {{Phase::transfer, bad}})), "duration");
  for (const int bad : {0, -3}) expect(said(1.72, good, options(24, bad)), "k is");
  expect(said(1.72, task({0, kMissing, 0}, {0, 0.42, 1})), "home");
  expect(said(1.72, task({0, 0.42, 0}, {0, 0.42, 1.0 / 0.0})), "target");
  expect(said(1.72, task(good.home, good.home)), "home and target");
  expect(said(1.72, task(good.home, {0, 0.42, 2.6})), "cm out of reach");
  expect(said(1.72, task({0, 2.6, 0}, good.target)), "the home");
  TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "none.sqlite");
  const auto without = [&] { (void)predict(corpus, subject(1.72), good, body); };
  expect(complaint(without), "holds no motions");
}

TEST(Predict, RefusesPhasesThatCannotFollowOneAnother) {
  using enum Phase;
  const auto said = [&](const std::vector<Phase>& phases) {
    PredictOptions how;
    how.phases = phases;
    const Task good = task({0, 0.42, 0}, {0, 0.42, 1.0});
    return complaint([&] { (void)predict(made_corpus(), subject(1.72), good, Body::from_stature(1.72), how); });
  };
  expect_contains(said({}), "phases is empty");
  expect_contains(said({transfer, transfer}), "takes the object from home, but it is at the target");
  expect_contains(said({retrieve, retrieve}), "takes the object from the target, but it is at home");
  expect_contains(said({transfer, reach}), "reach begins with empty hands at rest");
  expect_contains(said({return_, transfer}), "reach comes between");
  PredictOptions how;
  how.durations_s = {{retrieve, 1.0}};
  expect_contains(
      complaint([&] {
        (void)predict(made_corpus(), subject(1.72), task({0, 0.42, 0}, {0, 0.42, 1.0}), Body::from_stature(1.72), how);
      }),
      "do not include it");
}

}  // namespace
}  // namespace reachcast
