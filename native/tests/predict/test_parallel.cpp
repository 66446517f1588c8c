// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

namespace reachcast {
namespace {

TEST(Parallel, EveryNumberIsWorkedOnOnce) {
  for (const unsigned threads : {0u, 1u, 2u, 7u}) {
    for (const std::size_t count : {0u, 1u, 3u, 1000u}) {
      std::vector<std::atomic<int>> times(count);
      for_each_number(count, threads, [&](std::size_t i) { ++times[i]; });
      for (const auto& t : times) EXPECT_EQ(t, 1);
    }
  }
}

TEST(Parallel, TheErrorOfTheSmallestNumberIsThrownWhateverTheThreads) {
  for (const unsigned threads : {1u, 2u, 7u}) {
    for (int round = 0; round < 20; ++round) {
      try {
        for_each_number(200, threads, [](std::size_t i) {
          if (i % 50 == 17) throw std::invalid_argument(std::to_string(i));
        });
        FAIL() << "no error";
      } catch (const std::invalid_argument& error) {
        EXPECT_STREQ(error.what(), "17");
      }
    }
  }
}

}  // namespace
}  // namespace reachcast
