// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/covariates.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace reachcast {
namespace {

using Labels = std::vector<std::string>;
using Numbers = std::vector<double>;

const std::vector<Covariate> kReaches{{"stature", Numbers{1.6, 1.8, 1.7}},
                                      {"object", Labels{"cup", "box", "can"}},
                                      {"target", Points{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}}};

TEST(Covariates, EachKindHasItsColumns) {
  const Design design(kReaches);
  EXPECT_EQ(design.column_names(), (Labels{"stature", "object=can", "object=cup", "target_x", "target_y", "target_z"}));
  Eigen::MatrixXd expected(3, 6);
  expected << 1.6, 0, 1, 1, 2, 3, 1.8, 0, 0, 4, 5, 6, 1.7, 1, 0, 7, 8, 9;
  EXPECT_EQ(design.rows(kReaches, 3), expected);
  ASSERT_EQ(design.terms().size(), 3u);
  EXPECT_EQ(design.terms()[1].first, 1);
  EXPECT_EQ(design.terms()[1].count, 2);
}

TEST(Covariates, SquaresAndProductsFollowTheirTerm) {
  const std::vector<Covariate> reach{{"t", Points{{2, 3, 5}}}, {"age", Numbers{7}}};
  const Design design(reach, true);
  EXPECT_EQ(design.column_names(), (Labels{"t_x", "t_y", "t_z", "t_x*t_x", "t_x*t_y", "t_x*t_z", "t_y*t_y", "t_y*t_z",
                                           "t_z*t_z", "age", "age*age"}));
  Eigen::RowVectorXd expected(11);
  expected << 2, 3, 5, 4, 6, 10, 9, 15, 25, 7, 49;
  EXPECT_EQ(design.rows(reach, 1).row(0), expected);
}

TEST(Covariates, OrderDoesNotMatter) {
  const Design design(kReaches);
  const std::vector<Covariate> turned{kReaches[2], kReaches[0], kReaches[1]};
  EXPECT_EQ(design.rows(turned, 3), design.rows(kReaches, 3));
}

TEST(Covariates, NoneAreNoColumns) {
  EXPECT_EQ(Design().rows({}, 4).cols(), 0);
  EXPECT_EQ(Design().rows({}, 4).rows(), 4);
}

std::string message_of(const auto& action) {
  try {
    (void)action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(Covariates, NamesTheCovariateThatIsWrong) {
  const Design design(kReaches);
  const auto rows = [&](std::vector<Covariate> given) {
    return message_of([&] { return design.rows(given, given.front().count()); });
  };
  std::vector<Covariate> given = kReaches;
  given.pop_back();
  EXPECT_EQ(rows(given), "covariates['target'] is missing, the model was fitted with it");
  given = kReaches;
  given.push_back({"age", Numbers{1, 2, 3}});
  EXPECT_EQ(rows(given), "covariates['age'] is not among those that the model was fitted with");
  given = kReaches;
  given.push_back(kReaches[0]);
  EXPECT_EQ(rows(given), "covariates['stature'] is given twice");
  given = kReaches;
  given[2].values = Numbers{1, 2, 3};
  EXPECT_EQ(rows(given), "covariates['target'] holds numbers, expected vectors");
  given = kReaches;
  given[1].values = Labels{"cup", "pan", "can"};
  EXPECT_EQ(rows(given), "covariates['object'] has the label 'pan', expected one of box, can, cup");
  given = kReaches;
  given[1].values = Labels{"cup"};
  EXPECT_EQ(rows(given), "covariates['object'] has 1 values, expected 3, one per reach");
  given = kReaches;
  given[0].values = Numbers{1.6, kMissing, 1.7};
  EXPECT_EQ(rows(given), "covariates['stature'] is not finite for reach 1");
  const std::vector<Covariate> alike{{"sex", Labels{"f", "f"}}};
  EXPECT_EQ(message_of([&] { return Design(alike); }),
            "covariates['sex'] has fewer than 2 different labels, so nothing to compare");
  const std::vector<Covariate> twice{kReaches[0], kReaches[0]};
  EXPECT_EQ(message_of([&] { return Design(twice); }), "covariates['stature'] is given twice");
}

}  // namespace
}  // namespace reachcast
