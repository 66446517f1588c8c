// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include "reachcast/curves/bezier.hpp"
#include "reachcast/curves/hand_path.hpp"

namespace reachcast {
namespace {

constexpr double kRounding = 1e-10;

/// Reaches of some people whose first offset depends on the height of the target, and on who they are.
struct Reaches {
  std::vector<Points> paths;
  std::vector<std::string> people;
  Points postures;
};

Reaches made_reaches(std::uint64_t seed, int people, int each, double between = 0.03, double within = 0.02) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto vector = [&](double size) { return size * Vec3(normal(random), normal(random), normal(random)); };
  Reaches reaches;
  for (int person = 0; person < people; ++person) {
    const Vec3 habit = vector(between);
    for (int i = 0; i < each; ++i) {
      const Vec3 start = vector(0.1), end = start + Vec3(0.0, 0.6, 0.0) + vector(0.3);
      const double d = glm::length(end - start);
      Points control = axis_points(start, end, 3);
      control[1] += d * (Vec3(0.0, -0.1, 0.3 * (end.z - start.z)) + habit + vector(within));
      control[2] += d * (Vec3(0.1, 0.0, 0.0) + habit + vector(within));
      reaches.paths.push_back(eval_bezier(control, even_times(30)));
      reaches.people.push_back(std::to_string(person));
      reaches.postures.push_back(vector(0.2));
    }
  }
  return reaches;
}

double largest_distance(const Points& a, const Points& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, glm::length(a[i] - b[i]));
  return largest;
}

TEST(HandPathCovariates, OneLabelGivesTheMeansOfTheGroups) {
  const Reaches all = made_reaches(1, 3, 8);
  HandPathFit options;
  options.covariates = {{"person", all.people}};
  const HandPathModel model = HandPathModel::fit(all.paths, options);
  for (int person = 0; person < 3; ++person) {
    const std::vector<Points> own(all.paths.begin() + 8 * person, all.paths.begin() + 8 * (person + 1));
    const ReachDetails asked{Hand::right, {}, {{"person", std::vector<std::string>{std::to_string(person)}}}};
    const Vec3 end(0.3, 0.5, 0.2);
    EXPECT_LT(largest_distance(model.predict(Vec3(0.0), end, asked).control,
                               HandPathModel::fit(own).predict(Vec3(0.0), end).control),
              kRounding);
  }
  EXPECT_EQ(model.residuals().freedom, 21.0);
}

TEST(HandPathCovariates, WithoutCovariatesEveryTrendIsTheNullModel) {
  const Reaches all = made_reaches(12, 2, 6);
  const Points mean = HandPathModel::fit(all.paths).predict(Vec3(0.0), Vec3(0.2, 0.5, 0.1)).control;
  for (const Trend trend : {Trend::linear, Trend::quadratic, Trend::smooth}) {
    HandPathFit options;
    options.trend = trend;
    const HandPathModel model = HandPathModel::fit(all.paths, options);
    EXPECT_LT(largest_distance(model.predict(Vec3(0.0), Vec3(0.2, 0.5, 0.1)).control, mean), kRounding);
    options.form.degree = 1;
    options.people = all.people;
    const HandPathModel line = HandPathModel::fit(all.paths, options);
    EXPECT_EQ(line.predict(Vec3(0.0), Vec3(1.0)).control, (Points{Vec3(0.0), Vec3(1.0)}));
  }
}

TEST(HandPathCovariates, ALinearDependenceIsFoundAgain) {
  const Reaches all = made_reaches(2, 1, 200, 0.0, 1e-4);
  HandPathFit options;
  options.displacement = true;
  const HandPathModel model = HandPathModel::fit(all.paths, options);
  ASSERT_EQ(model.design().column_names()[2], "displacement_z");
  EXPECT_NEAR(model.linear()->coefficients()(3, 2), 0.3, 0.06) << "arc length is not the parameter they were made with";
  EXPECT_LT(model.linear()->test(0, 3).wilks_p_value, 1e-10);
}

TEST(HandPathCovariates, TheLeftHandIsTheMirrorImageForEveryTrend) {
  const auto mirror = [](Vec3 v) { return Vec3(-v.x, v.y, v.z); };
  const Reaches all = made_reaches(3, 2, 20);
  Reaches mirrored = all;
  for (Points& path : mirrored.paths) {
    for (Vec3& point : path) point = mirror(point);
  }
  for (Vec3& posture : mirrored.postures) posture = mirror(posture);
  for (const Trend trend : {Trend::linear, Trend::quadratic, Trend::smooth}) {
    HandPathFit right, left;
    right.trend = left.trend = trend;
    right.displacement = left.displacement = true;
    right.distance = left.distance = trend != Trend::quadratic;  // its square is that of the displacement
    left.hand = Hand::left;
    right.covariates = {{"posture", all.postures}};
    left.covariates = {{"posture", mirrored.postures}};
    const Vec3 end(0.3, 0.6, 0.1), posture(0.1, 0.0, -0.2);
    const ReachDetails as_right{Hand::right, {}, {{"posture", Points{posture}}}};
    const ReachDetails as_left{Hand::left, {}, {{"posture", Points{mirror(posture)}}}};
    const Points expected = HandPathModel::fit(all.paths, right).predict(Vec3(0.0), end, as_right).control;
    Points found = HandPathModel::fit(mirrored.paths, left).predict(Vec3(0.0), mirror(end), as_left).control;
    for (Vec3& point : found) point = mirror(point);
    EXPECT_LT(largest_distance(found, expected), kRounding);
  }
}

TEST(HandPathCovariates, PredictionsStayWithinTheStatedBound) {
  const Reaches all = made_reaches(4, 3, 30);
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (const OffsetOrigin origin : {OffsetOrigin::axis, OffsetOrigin::ends, OffsetOrigin::start_axis}) {
    HandPathFit options;
    options.form.origin = origin;
    options.trend = Trend::smooth;
    options.displacement = true;
    const HandPathModel model = HandPathModel::fit(all.paths, options);
    for (int i = 0; i < 2000; ++i) {
      const double size = std::pow(10.0, i % 4 - 2);
      const Vec3 end = size * Vec3(normal(random), normal(random), normal(random));
      const Points control = model.predict(Vec3(0.0), end).control;
      const double bound = model.deviation_bound(glm::length(end)).value();
      for (const double s : {0.2, 0.5, 0.8}) EXPECT_LE(glm::length(eval_bezier(control, s) - s * end), bound);
    }
    const Points far = model.predict(Vec3(0.0), Vec3(-50.0, 20.0, 9.0)).control;
    HandPathFit plain;
    plain.form = options.form;
    const Points null = HandPathModel::fit(all.paths, plain).predict(Vec3(0.0), Vec3(-50.0, 20.0, 9.0)).control;
    EXPECT_LT(largest_distance(far, null), 1e-9) << "far from the data it is the null model";
  }
  EXPECT_FALSE([&] {
    HandPathFit options;
    options.displacement = true;
    return HandPathModel::fit(all.paths, options).deviation_bound(1.0);
  }());
}

// The share of new reaches whose coordinate lies in a 90 % band of one reach.
TEST(HandPathCovariates, BandsHoldAsManyReachesAsTheySay) {
  constexpr double kLevel = 0.9;
  const Reaches learned = made_reaches(6, 1, 60, 0.0), fresh = made_reaches(7, 1, 800, 0.0);
  for (const Trend trend : {Trend::linear, Trend::smooth}) {
    HandPathFit options;
    options.trend = trend;
    options.displacement = true;
    const HandPathModel model = HandPathModel::fit(learned.paths, options);
    int inside = 0, count = 0;
    for (const Points& path : fresh.paths) {
      const Points control = fit_bezier(path);
      const std::vector<double> s{0.3, 0.5, 0.7};
      const PathBand band = model.band(path.front(), path.back(), s, kLevel, {}, true);
      for (std::size_t k = 0; k < s.size(); ++k) {
        const Vec3 miss = glm::abs(eval_bezier(control, s[k]) - band.centre[k]);
        for (int axis = 0; axis < 3; ++axis, ++count) inside += miss[axis] <= band.half_width[k][axis] ? 1 : 0;
      }
    }
    EXPECT_NEAR(static_cast<double>(inside) / count, kLevel, 0.03);
  }
}

// With no covariates the band of the mean is the textbook interval t s / sqrt(n) of each coordinate.
TEST(HandPathCovariates, TheBandOfTheNullModelIsTheIntervalOfAMean) {
  const Reaches all = made_reaches(8, 1, 12);
  HandPathFit options;
  options.form.degree = 2;
  const HandPathModel model = HandPathModel::fit(all.paths, options);
  const PathBand band = model.band(Vec3(0.0), Vec3(0.0, 2.0, 0.0), std::vector<double>{0.0, 0.5, 1.0});
  constexpr double kT11 = 2.200985160;  // 97.5 % quantile of Student's t with 11 degrees of freedom
  for (int axis = 0; axis < 3; ++axis) {
    const double deviation = std::sqrt((*model.covariance())(axis, axis));
    EXPECT_NEAR(band.half_width[1][axis], 0.5 * 2.0 * kT11 * deviation / std::sqrt(12.0), 1e-9);
  }
  EXPECT_EQ(band.half_width.front(), Vec3(0.0));
  EXPECT_EQ(band.half_width.back(), Vec3(0.0));
}

TEST(HandPathCovariates, AStrangerVariesMoreThanAKnownPerson) {
  const Reaches all = made_reaches(9, 12, 10, 0.08, 0.01);
  HandPathFit options;
  options.trend = Trend::smooth;
  options.displacement = true;
  options.lengths = {{"displacement", 0.2}};
  const HandPathModel known = HandPathModel::fit(all.paths, options);
  options.people = all.people;
  const HandPathModel stranger = HandPathModel::fit(all.paths, options);
  EXPECT_GT(stranger.covariance()->trace(), 1.05 * known.covariance()->trace());
  options.trend = Trend::linear;
  const HandPathModel linear = HandPathModel::fit(all.paths, options);
  HandPathFit others = options;
  others.people.clear();
  const std::vector<Points> rest(all.paths.begin() + 10, all.paths.end());
  const HandPathModel without = HandPathModel::fit(rest, others);
  const Points predicted = without.predict(all.paths[0].front(), all.paths[0].back()).control;
  const Eigen::VectorXd miss =
      offsets_of(fit_bezier(all.paths[0]), {}, Hand::right, {}) - offsets_of(predicted, {}, Hand::right, {});
  EXPECT_LT((linear.residuals().rows.row(0).transpose() - miss).norm(), kRounding);
}

TEST(HandPathCovariates, SamplesSpreadAboutThePrediction) {
  const Reaches all = made_reaches(10, 1, 80);
  HandPathFit options;
  options.displacement = true;
  const HandPathModel model = HandPathModel::fit(all.paths, options);
  const Vec3 end(0.0, 1.0, 0.0);
  const Points mean = model.predict(Vec3(0.0), end).control;
  constexpr int kCount = 20'000;
  Eigen::MatrixXd deviations(kCount, 6);
  for (int i = 0; i < kCount; ++i) {
    const Points control = model.sample(Vec3(0.0), end, static_cast<std::uint64_t>(i)).control;
    deviations.row(i) << to_eigen(control[1] - mean[1]).transpose(), to_eigen(control[2] - mean[2]).transpose();
  }
  const Eigen::MatrixXd found = deviations.transpose() * deviations / kCount;
  EXPECT_LT((found - *model.covariance()).cwiseAbs().maxCoeff(), 0.05 * model.covariance()->diagonal().maxCoeff());
}

TEST(HandPathCovariates, FlashHoganIsStraightAndSmooth) {
  const HandPath path = HandPathModel::flash_hogan().predict(Vec3(0.0), Vec3(1.0, 2.0, 3.0));
  EXPECT_LT(glm::length(path.positions(std::vector<double>{0.25})[0] - Vec3(1.0, 2.0, 3.0) * 0.103515625), 1e-14);
  EXPECT_EQ(HandPathModel::flash_hogan().deviation_bound(1.0), 0.0);
}

std::string message_of(const auto& action) {
  try {
    (void)action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(HandPathCovariates, NamesWhatIsWrong) {
  const Reaches all = made_reaches(11, 2, 4);
  const auto fit = [&](const auto& change) {
    HandPathFit options;
    change(options);
    return message_of([&] { return HandPathModel::fit(all.paths, options); });
  };
  EXPECT_EQ(fit([&](HandPathFit& o) {
              o.covariates = {{"distance", std::vector<double>(8, 1.0)}};
            }),
            "covariates['distance'] is a name that the model fills in itself");
  EXPECT_EQ(fit([](HandPathFit& o) { o.people = {"a"}; }), "people has 1 values, expected 8, one per path");
  EXPECT_EQ(fit([](HandPathFit& o) { o.people.assign(8, "a"); }),
            "people has 1 different name, expected at least 2 to learn one from the others");
  EXPECT_EQ(fit([](HandPathFit& o) { o.trend = Trend::smooth, o.ridge = -1.0; }),
            "ridge is -1.000000, expected a finite number > 0");
  EXPECT_EQ(fit([](HandPathFit& o) {
              o.trend = Trend::smooth, o.lengths = {{"age", 1.0}};
            }),
            "lengths['age'] is not the name of a covariate");
  EXPECT_EQ(fit([](HandPathFit& o) {
              o.trend = Trend::smooth, o.displacement = true, o.lengths = {{"displacement", 0.0}};
            }),
            "lengths['displacement'] is 0.000000, expected a finite number > 0");
  EXPECT_EQ(fit([](HandPathFit& o) { o.trend = Trend::quadratic, o.displacement = true; }),
            "8 reaches cannot determine 10 coefficients, expected at least as many reaches");
  HandPathFit options;
  options.displacement = true;
  const HandPathModel model = HandPathModel::fit(all.paths, options);
  EXPECT_EQ(message_of([&] { return model.offsets(); }), "the offsets depend on covariates: predict a path instead");
  const std::vector<double> half{0.5};
  EXPECT_EQ(message_of([&] { return model.band(Vec3(0.0), Vec3(1.0), half, 1.0); }),
            "level is 1.000000, expected a number between 0 and 1");
  EXPECT_NE(message_of([&] { return HandPathModel::published().band(Vec3(0.0), Vec3(1.0), half); }).find("covariance"),
            std::string::npos);
  EXPECT_EQ(message_of([&] { return model.deviation_bound(-1.0); }),
            "distance is -1.000000, expected a finite number >= 0");
}

}  // namespace
}  // namespace reachcast
