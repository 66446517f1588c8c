// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstring>
#include <set>

#include "reachcast/curves/bezier.hpp"
#include "reachcast/motion/encode.hpp"
#include "reachcast/simulate/hand_motion.hpp"
#include "reachcast/simulate/simulate_reach.hpp"
#include "simulate_cases.hpp"

namespace reachcast::simulate::tests {
namespace {

/// Codes of some of a person's motions; a person's whole experiment takes half a minute.
std::vector<MotionCode> codes_of(std::size_t who, std::uint64_t seed) {
  const Person person = make_people(seed)[who];
  const auto errands = errands_of(person, who, seed);
  std::vector<MotionCode> out;
  for (std::size_t i = 0; i < errands.size(); i += 37)
    out.push_back(encode_reach(simulate_reach(person, errands[i]).reach));
  return out;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

TEST(People, AreTenWomenAndTenMenOverTheWholeRange) {
  std::multiset<double> ages, statures;
  int women = 0;
  for (const Person& person : people()) {
    women += *person.subject.sex == Sex::female ? 1 : 0;
    ages.insert(*person.subject.age_years);
    statures.insert(person.subject.stature_m);
  }
  EXPECT_EQ(people().size(), 20u);
  EXPECT_EQ(women, 10);
  EXPECT_EQ(*statures.begin(), 1.47);
  EXPECT_EQ(*statures.rbegin(), 1.95);
  EXPECT_EQ(*ages.begin(), 20.0);
  EXPECT_EQ(*ages.rbegin(), 70.0);
}

TEST(Experiment, HasThirtyTargetsFourPhasesAndTwoReplicates) {
  std::set<std::string> paper;
  std::set<std::string> origins;
  for (const Errand& errand : errands_of(people()[3], 3, 1)) {
    EXPECT_TRUE(origins.insert(errand.origin).second) << errand.origin;
    if (errand.origin.starts_with("paper")) paper.insert(errand.origin);
  }
  EXPECT_EQ(paper.size(), kTargets * 4 * kReplicates);
}

TEST(HandMotion, VariesAsThePaperSays) {
  const Vec3 start(0.0, 0.4, 0.95), end = start + Vec3(0.35, 0.1, 0.435);
  const double distance = glm::distance(start, end);
  ASSERT_NEAR(distance, 0.567, 2e-3);
  const auto farthest = [](const HandPath& a, const Points& b) {
    double most = 0.0;
    for (int i = 0; i <= 40; ++i)
      most = std::max(most, glm::distance(eval_bezier(a.control, i / 40.0), eval_bezier(b, i / 40.0)));
    return most;
  };
  std::vector<double> within, from_mean;
  for (std::uint64_t draw = 0; draw < 2000; ++draw) {
    const Person person = make_people(draw)[draw % kPeople];
    const HandPath one = draw_hand_path(person, start, end, 2 * draw),
                   two = draw_hand_path(person, start, end, 2 * draw + 1);
    within.push_back(farthest(one, two.control));
    Points mean = HandPathModel::published().predict(start, end).control;
    for (std::size_t i : {1u, 2u}) mean[i].x -= distance * HandPathModel::published().offsets()[i - 1].x;
    from_mean.push_back(farthest(one, mean));
  }
  EXPECT_NEAR(median(within), 0.067, 0.003);
  EXPECT_NEAR(median(from_mean), std::sqrt(0.080 * 0.080 - 0.017 * 0.017), 0.004);  // less what a cubic cannot follow
}

TEST(HandMotion, TimesAreThoseOfMtm) {
  Person person = people()[0];
  person.tempo = 1.0;
  const Vec3 start(0.0, 0.4, 1.0), end(0.0, 0.4, 1.0 + 20 * 0.0254);
  EXPECT_NEAR(motion_seconds(person, Phase::reach, start, end, 0.0), 18.6 * 0.036, 1e-9);
  EXPECT_NEAR(motion_seconds(person, Phase::transfer, start, end, 0.0), 18.2 * 0.036, 1e-9);
  EXPECT_NEAR(motion_seconds(person, Phase::transfer, start, end, 2 * 7.5 * 0.4536), (1.06 * 18.2 + 2.2) * 0.036, 1e-9);
  EXPECT_NEAR(motion_seconds(person, Phase::transfer, Vec3(0, 0.4, 0.2), Vec3(0, 0.4, 0.7), 0.0), 31.9 * 0.036, 1e-9);
}

TEST(Simulation, SameSeedGivesTheSameBytesAndAnotherSeedOthers) {
  const auto one = codes_of(6, 11), two = codes_of(6, 11), other = codes_of(6, 12);
  ASSERT_EQ(one.size(), two.size());
  ASSERT_GE(one.size(), 7u);
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_EQ(one[i].origin, two[i].origin);
    ASSERT_EQ(std::memcmp(one[i].coefficients.data(), two[i].coefficients.data(),
                          static_cast<std::size_t>(one[i].coefficients.size()) * sizeof(double)),
              0)
        << one[i].origin;
  }
  EXPECT_NE(one[0].coefficients, other[0].coefficients);
}

TEST(Simulation, ReplicatesOfOnePersonDiffer) {
  const Person& person = people()[4];
  const auto errands = errands_of(person, 4, 9);
  const Simulated first = simulate_reach(person, errands[0]), again = simulate_reach(person, errands[4]);
  ASSERT_EQ(errands[0].phase, errands[4].phase);
  double most = 0.0;
  for (std::size_t f = 0; f < kFrames; ++f)
    most = std::max(most, glm::distance(first.reach.hold_point(f), again.reach.hold_point(f)));
  EXPECT_GT(most, 0.01);
}

TEST(Simulation, StandsOnItsFeetHoldsTheBoxAndKeepsItsLengths) {
  for (const std::size_t who : {0u, 7u, 13u, 19u}) {
    const Person& person = people()[who];
    const auto errands = errands_of(person, who, 5);
    for (std::size_t i = 0; i < errands.size(); i += 23) {
      const Simulated made = simulate_reach(person, errands[i]);
      if (made.shortfall_m > 0.0) continue;
      EXPECT_LT(made.unbalanced_m, 0.01) << errands[i].origin;
      const Anchors stand = anchors_of(person.body.posture());
      for (const Posture& p : made.reach.postures) {
        const Anchors got = anchors_of(p);
        for (const std::size_t side : {0u, 1u}) {
          EXPECT_LT(glm::distance(got.ankle[side], stand.ankle[side]), 1e-9);
          EXPECT_LT(glm::distance(got.ball[side], stand.ball[side]), 1e-9);
        }
        if (is_loaded(errands[i].phase)) {
          EXPECT_NEAR(glm::distance(got.grip[0], got.grip[1]), 0.4, 1e-9);
        }
        EXPECT_NEAR(glm::distance(p[index(Joint::right_hip)], p[index(Joint::right_knee)]),
                    person.body.distance(Joint::right_hip, Joint::right_knee), 1e-9);
      }
    }
  }
}

/// Change of a joint's step from one of 25 postures to the next. Knees that come straight are the worst, with 0.040 m
/// over the motions looked at.
TEST(Simulation, MotionsAreSmooth) {
  const Person& person = people()[16];
  const auto errands = errands_of(person, 16, 5);
  for (std::size_t i = 0; i < errands.size(); i += 31) {
    const Simulated made = simulate_reach(person, errands[i]);
    for (std::size_t f = 2; f < kFrames; ++f) {
      for (std::size_t j = 0; j < kJointCount; ++j) {
        const Vec3 bend =
            made.reach.postures[f][j] - 2.0 * made.reach.postures[f - 1][j] + made.reach.postures[f - 2][j];
        EXPECT_LT(glm::length(bend), 0.045) << errands[i].origin << " " << joint_names()[j] << " " << f;
      }
    }
  }
}

}  // namespace
}  // namespace reachcast::simulate::tests
