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
    return predict_transfer(made_corpus(), subject(stature), task(home, target), body).outside_data;
  };
  EXPECT_TRUE(reasons(1.72, {0, 0.40, 0.03}, {-0.02, 0.40, 0.98}).empty());
  EXPECT_FALSE(reasons(1.72, {0, 0.40, 0.03}, {-0.45, 0.2, 0.5}).empty());
  EXPECT_FALSE(reasons(1.4, {0, 0.40, 0.03}, {-0.02, 0.40, 0.98}).empty());
}

TEST(Predict, RefusesBadInputInOneSentenceThatNamesIt) {
  const Body body = Body::from_stature(1.72);
  const Task good = task({0, 0.42, 0}, {0, 0.42, 1.0});
  const auto said = [&](double stature, const Task& t, const PredictOptions& options = {}) {
    return complaint([&] { (void)predict_transfer(made_corpus(), subject(stature), t, body, options); });
  };
  const auto expect = [](const std::string& text, const std::string& word) {
    expect_contains(text, word);
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  };
  for (const double bad : {kMissing, 0.0, -1.7, 3.0}) expect(said(bad, good), "stature");
  for (const double bad : {kMissing, 0.0, 0.5, 1001.0, -24.0})
    expect(said(1.72, good, {.frame_rate = bad, .neighbours = 5, .duration_s = {}}), "frame_rate");
  for (const double bad : {kMissing, 0.0, 61.0})
    expect(said(1.72, good, {.frame_rate = 24, .neighbours = 5, .duration_s = bad}), "duration");
  for (const int bad : {0, -3})
    expect(said(1.72, good, {.frame_rate = 24, .neighbours = bad, .duration_s = {}}), "k is");
  expect(said(1.72, task({0, kMissing, 0}, {0, 0.42, 1})), "home");
  expect(said(1.72, task({0, 0.42, 0}, {0, 0.42, 1.0 / 0.0})), "target");
  expect(said(1.72, task(good.home, good.home)), "home and target");
  expect(said(1.72, task(good.home, {0, 0.42, 2.6})), "cm out of reach");
  expect(said(1.72, task({0, 2.6, 0}, good.target)), "the home");
  TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "none.sqlite");
  const auto without = [&] { (void)predict_transfer(corpus, subject(1.72), good, body); };
  expect(complaint(without), "holds no motions");
  Reach reach = made_lift(1.72, {0, 0.42, 0.15}, {0, 0.42, 1.0});
  reach.phase = Phase::retrieve;
  corpus.add(std::vector{encode_reach(reach)});
  expect(complaint(without), "transfer");
}

}  // namespace
}  // namespace reachcast
