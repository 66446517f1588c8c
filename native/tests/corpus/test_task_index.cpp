// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/corpus/task_index.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace reachcast {
namespace {

struct Places {
  std::vector<Vec3> homes, targets;
};

/// In steps of an eighth, so that equal places and equal distances are common, and exact in double.
Places coarse_places(std::mt19937_64& random, std::size_t count, unsigned steps) {
  const auto coarse = [&] { return 0.125 * static_cast<double>(random() % steps); };
  Places places;
  for (std::size_t i = 0; i < count; ++i) {
    places.homes.emplace_back(coarse(), coarse(), coarse());
    places.targets.emplace_back(coarse(), coarse(), coarse());
  }
  return places;
}

TEST(TaskIndex, AWalkMeetsEveryPlaceOnceAtItsDistanceNearestFirst) {
  std::mt19937_64 random(6);
  for (const std::size_t count : {0u, 1u, 2u, 16u, 17u, 33u, 500u, 4000u}) {
    for (const unsigned steps : {1u, 3u, 40u}) {
      const Places places = coarse_places(random, count, steps);
      const TaskIndex index(places.homes, places.targets);
      const Vec3 home(0.125, 0.5, 0.25), target(0.25, 0.0, 1.5);
      for (const EndWeights weights : {EndWeights{1.0, 0.0625}, EndWeights{0.0625, 1.0}, EndWeights{1.0, 1.0}}) {
        TaskWalk walk(index, home, target, weights);
        std::vector<bool> met(count, false);
        double last = 0.0;
        for (std::size_t i = 0; i < count; ++i) {
          const auto step = walk.next();
          ASSERT_TRUE(step.has_value());
          ASSERT_FALSE(met[step->at]);
          met[step->at] = true;
          const Vec3 h = places.homes[step->at] - home, t = places.targets[step->at] - target;
          ASSERT_EQ(step->squared_distance, weights.home * glm::dot(h, h) + weights.target * glm::dot(t, t));
          ASSERT_GE(step->squared_distance, last);
          last = step->squared_distance;
        }
        EXPECT_FALSE(walk.next().has_value());
      }
    }
  }
}

}  // namespace
}  // namespace reachcast
