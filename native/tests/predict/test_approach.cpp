// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/approach.hpp"

#include <gtest/gtest.h>

#include <random>

namespace reachcast {
namespace {

constexpr double kMostRise_m = 0.10;  // that approach.hpp promises

std::function<Vec3(double)> straight(const Vec3& home, const Vec3& target) {
  return [=](double t) { return home + t * t * (3.0 - 2.0 * t) * (target - home); };
}

TEST(EdgeClearance, RaisesALiftToASideShelfBeforeItsEdgeAndNeverMuch) {
  const auto path = straight(Vec3(0, 0.42, 0.1), Vec3(0.6, 0.35, 1.1));
  const EdgeClearance clearance(path, Box{});
  EXPECT_GT(clearance.largest_m(), 0.02);
  EXPECT_LE(clearance.largest_m(), kMostRise_m + 1e-12);
}

TEST(EdgeClearance, LeavesAPathThatIsClearAlone) {
  const auto arc = [](double t) { return Vec3(0.6 * t, 0.4, 1.0 + 0.5 * t * (1.0 - t)); };
  EXPECT_EQ(EdgeClearance(arc, Box{}).largest_m(), 0.0);
}

TEST(EdgeClearance, LeavesTheEndsWhereTheyAre) {
  const EdgeClearance clearance(straight(Vec3(-0.1, 0.4, 1.1), Vec3(0.5, 0.3, 0.1)), Box{});
  EXPECT_EQ(clearance.rise_m(0.0), 0.0);
  EXPECT_EQ(clearance.rise_m(1.0), 0.0);
  EXPECT_LT(clearance.rise_m(0.01) / 0.01, 0.2) << "no jump in speed at lift-off";
}

TEST(EdgeClearance, StaysWithinItsBoundForAnyTask) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<> side(-0.6, 0.6), ahead(0.1, 0.7), up(0.0, 1.9);
  for (int trial = 0; trial < 500; ++trial) {
    const Vec3 home(side(random), ahead(random), up(random)), target(side(random), ahead(random), up(random));
    ASSERT_LE(EdgeClearance(straight(home, target), Box{}).largest_m(), kMostRise_m + 1e-12) << trial;
  }
}

}  // namespace
}  // namespace reachcast
