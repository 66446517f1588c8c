// SPDX-License-Identifier: GPL-3.0-or-later
/// What simulated people do with the right hand alone.
#include <gtest/gtest.h>

#include <algorithm>

#include "reachcast/simulate/simulate_reach.hpp"
#include "simulate_cases.hpp"

namespace reachcast::simulate {
namespace {

using tests::people;

constexpr double kExact_m = 1e-9;

std::vector<Errand> one_handed_errands(std::size_t person) {
  std::vector<Errand> errands = errands_of(people()[person], person, 7);
  std::erase_if(errands, [](const Errand& errand) { return errand.hands == Hands::both; });
  return errands;
}

TEST(OneHandedSimulation, EverybodyIsAskedForAllPhasesOnceToEachTarget) {
  const std::vector<Errand> errands = one_handed_errands(3);
  EXPECT_EQ(errands.size(), 4 * kOneHandedTargets);
  for (const Errand& errand : errands) {
    EXPECT_EQ(errand.hands, Hands::right);
    EXPECT_GT(errand.target.hold.x, 0.0);
  }
}

TEST(OneHandedSimulation, TheRightHandIsWhereItMustBeAndTheLeftArmHangs) {
  for (const std::size_t number : {2u, 17u}) {
    const Person& person = people()[number];
    const std::vector<Errand> errands = one_handed_errands(number);
    for (std::size_t i = 0; i < errands.size(); i += 7) {
      const Simulated made = simulate_reach(person, errands[i]);
      const Reach& reach = made.reach;
      SCOPED_TRACE(reach.origin);
      EXPECT_EQ(reach.hands, Hands::right);
      ASSERT_EQ(made.shortfall_m, 0.0);
      EXPECT_LT(made.held_m, 0.08);
      const bool comes = errands[i].phase == Phase::reach, goes = errands[i].phase == Phase::return_;
      const bool leaves_target = errands[i].phase == Phase::retrieve || goes;
      const Vec3& target = errands[i].target.hold;
      if (leaves_target) EXPECT_LT(glm::distance(reach.hold_point(0), target), kExact_m);
      if (!leaves_target || comes) EXPECT_LT(glm::distance(reach.hold_point(reach.frames() - 1), target), kExact_m);
      for (const Posture& p : reach.postures) {
        const Vec3 arm = p[index(Joint::left_grip)] - p[index(Joint::left_shoulder)];
        EXPECT_LT(arm.z, -0.9 * glm::length(arm));
        EXPECT_LT(p[index(Joint::left_grip)].x, p[index(Joint::left_hip)].x);
        for (const Joint ankle : {Joint::left_ankle, Joint::right_ankle})
          EXPECT_LT(glm::distance(p[index(ankle)], person.body.at(ankle)), kExact_m);
      }
    }
  }
}

}  // namespace
}  // namespace reachcast::simulate
