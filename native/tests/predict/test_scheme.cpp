// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/scheme.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "corpus/corpus_cases.hpp"

namespace reachcast {
namespace {

using tests::expect_contains;
using tests::message_of;

TEST(Scheme, TheDefaultIsThePapersBest) {
  EXPECT_EQ(describe(Scheme{}), "ranks of task + stature, 5 triangular");
  EXPECT_NO_THROW(check(Scheme{}));
}

TEST(Scheme, SixtyDifferentOnesCanBeTried) {
  std::set<std::string> names;
  for (const Scheme& scheme : all_schemes()) {
    EXPECT_NO_THROW(check(scheme));
    names.insert(describe(scheme));
  }
  EXPECT_EQ(all_schemes().size(), 60u);
  EXPECT_EQ(names.size(), 60u);
  for (const Scheme& scheme : paper_schemes()) EXPECT_TRUE(names.contains(describe(scheme)));
}

TEST(Scheme, AMistakeIsNamedWithItsLimit) {
  const auto complaint = [](const Scheme& scheme) { return message_of<std::invalid_argument>([&] { check(scheme); }); };
  expect_contains(complaint({.k = 0}), "k is 0");
  expect_contains(complaint({.task = false, .traits = {}}), "compares nothing");
  expect_contains(complaint({.bandwidth = 0.0}), "bandwidth is 0");
  expect_contains(complaint({.ridge = std::nan("")}), "ridge is nan");
  expect_contains(complaint({.task_scale_m = -1.0}), "scale of task is -1");
  expect_contains(complaint({.trait_scales = {0.0, 1e9}}), "scale of age is 1e+09");
}

}  // namespace
}  // namespace reachcast
