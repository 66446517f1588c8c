// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/cross_validate.hpp"

#include <gtest/gtest.h>

#include <array>

#include "predict/predict_cases.hpp"

namespace reachcast {
namespace {

using namespace tests;
constexpr std::array<Scheme, 2> kSchemes{Scheme{1}, Scheme{5}};

TEST(CrossValidate, GivesOneRowASchemeOverEveryMotionThatIsNoMirrorImage) {
  const auto rows = cross_validate(made_corpus(), kSchemes, LeaveOut::motion);
  ASSERT_EQ(rows.size(), 2u);
  for (const SchemeError& row : rows) {
    EXPECT_EQ(row.motions + row.out_of_reach, made_corpus().table()->of(Phase::transfer).size() / 2);
    EXPECT_GT(row.median_m, 0.0);
    EXPECT_LE(row.lower_quartile_m, row.median_m);
    EXPECT_LE(row.median_m, row.upper_quartile_m);
  }
}

/// The made lifts of a stature differ from those of another by proportion alone, so what is left out must matter: with
/// a twin of every motion in the corpus nothing is left to predict.
TEST(CrossValidate, ATwinOfEveryMotionLeavesNoError) {
  const TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "twins.sqlite");
  std::vector<MotionCode> codes;
  for (const double z : {0.9, 1.1, 1.3}) {
    for (const char* name : {"a", "b"}) {
      Reach reach = made_lift(1.72, {0.0, 0.42, 0.2}, {0.1, 0.45, z});
      reach.origin = name + std::to_string(z);
      codes.push_back(encode_reach(reach));
    }
  }
  corpus.add(codes);
  const std::array<Scheme, 1> nearest{Scheme{1}};
  EXPECT_LT(cross_validate(corpus, nearest, LeaveOut::motion).front().median_m, 1e-9);
  EXPECT_THROW((void)cross_validate(corpus, nearest, LeaveOut::subject), std::invalid_argument);
}

}  // namespace
}  // namespace reachcast
