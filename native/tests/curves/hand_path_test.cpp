// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/hand_path.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include "reachcast/curves/bezier.hpp"

namespace reachcast {
namespace {

constexpr double kRounding = 1e-12;
const Vec3 kHome(0.1, 0.3, 1.0);
const Vec3 kShelf(0.5, 0.6, 1.4);

std::vector<double> even_times(int steps) {
  std::vector<double> times;
  for (int i = 0; i <= steps; ++i) times.push_back(static_cast<double>(i) / steps);
  return times;
}

/// Reaches between random points, curved at random.
std::vector<Points> random_paths(std::uint64_t seed, int count) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto point = [&](double size) { return size * Vec3(normal(random), normal(random), normal(random)); };
  std::vector<Points> paths;
  for (int i = 0; i < count; ++i) {
    const Vec3 start = point(0.2), end = start + point(0.3) + Vec3(0.0, 1.5, 0.0);
    Points control = axis_points(start, end, 3);
    control[1] += point(0.1);
    control[2] += point(0.1);
    paths.push_back(eval_bezier(control, even_times(25)));
  }
  return paths;
}

Vec3 about_vertical(const Vec3& p, double angle) {
  return {std::cos(angle) * p.x - std::sin(angle) * p.y, std::sin(angle) * p.x + std::cos(angle) * p.y, p.z};
}

Points mapped(const Points& points, const auto& map) {
  Points result;
  for (const Vec3& p : points) result.push_back(map(p));
  return result;
}

double largest_distance(const Points& a, const Points& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, glm::length(a[i] - b[i]));
  return largest;
}

// Section 4: for the median reach of 56.7 cm the offsets are (-1.4, -8.4, 4.3) and (-0.8, -7.9, -0.1) cm.
TEST(HandPath, PublishedOffsetsAreThoseOfTheMedianReach) {
  const Vec3 end(0.0, 0.567, 0.0);
  const HandPath path = HandPathModel::published().predict(Vec3(0.0), end);
  const Points axis = axis_points(Vec3(0.0), end, 3);
  const Vec3 first = 100.0 * (path.control[1] - axis[1]);
  const Vec3 second = 100.0 * (path.control[2] - axis[2]);
  const Vec3 first_printed(-1.4, -8.4, 4.3), second_printed(-0.8, -7.9, -0.1);
  // Centimetres: half of the last decimal printed, plus 56.7 times half of the last decimal of the offsets.
  constexpr double kPrinted = 0.05 + 56.7 * 0.0005;
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(first[i], first_printed[i], kPrinted);
    EXPECT_NEAR(second[i], second_printed[i], kPrinted);
  }
}

TEST(HandPath, EndsExactlyWhereAsked) {
  for (const HandPathModel& model : {HandPathModel::published(), HandPathModel::fit(random_paths(1, 4))}) {
    const HandPath path = model.predict(kHome, kShelf);
    EXPECT_EQ(path.control.front(), kHome);
    EXPECT_EQ(path.control.back(), kShelf);
    const Points positions = path.positions(even_times(10));
    EXPECT_EQ(positions.front(), kHome);
    EXPECT_EQ(positions.back(), kShelf);
  }
}

TEST(HandPath, OnePathIsReproducedBetweenItsOwnEnds) {
  const std::vector<Points> paths = random_paths(2, 1);
  for (const OffsetScaling scaling : {OffsetScaling::distance, OffsetScaling::distance_time}) {
    HandPathFit options;
    options.form.scaling = scaling;
    options.durations_s = {1.3};
    const HandPathModel model = HandPathModel::fit(paths, options);
    const HandPath path = model.predict(paths[0].front(), paths[0].back(), {Hand::right, 1.3, {}});
    EXPECT_LT(largest_distance(path.control, fit_bezier(paths[0])), kRounding);
  }
}

TEST(HandPath, DeviationGrowsWithDistanceOrWithTheRootOfDistanceAndTime) {
  const std::vector<Points> paths = random_paths(3, 5);
  const auto deviation = [&](const HandPathModel& model, double distance, double duration) {
    const Vec3 end(0.0, distance, 0.0);
    return glm::length(model.predict(Vec3(0.0), end, {Hand::right, duration, {}}).control[1] - end / 3.0);
  };
  const HandPathModel by_distance = HandPathModel::fit(paths);
  EXPECT_NEAR(deviation(by_distance, 0.8, 1.0) / deviation(by_distance, 0.2, 3.0), 4.0, kRounding);
  HandPathFit options;
  options.form.scaling = OffsetScaling::distance_time;
  options.durations_s = {1.0, 1.1, 1.2, 1.3, 1.4};
  const HandPathModel by_both = HandPathModel::fit(paths, options);
  EXPECT_NEAR(deviation(by_both, 0.8, 1.0) / deviation(by_both, 0.2, 4.0), 1.0, kRounding);
  EXPECT_NEAR(deviation(by_both, 0.8, 4.0) / deviation(by_both, 0.8, 1.0), 2.0, kRounding);
}

// A turned room with a turned person gives the turned paths: nothing prefers a direction of the world.
TEST(HandPath, LearningAndPredictingCommuteWithATurnAboutTheVertical) {
  const std::vector<Points> paths = random_paths(4, 12);
  for (const double angle : {0.3, 2.0, -1.4}) {
    const auto turn = [&](const Vec3& p) { return about_vertical(p, angle); };
    std::vector<Points> turned;
    for (const Points& path : paths) turned.push_back(mapped(path, turn));
    const HandPath there = HandPathModel::fit(turned).predict(turn(kHome), turn(kShelf));
    const HandPath here = HandPathModel::fit(paths).predict(kHome, kShelf);
    EXPECT_LT(largest_distance(there.control, mapped(here.control, turn)), kRounding);
  }
}

TEST(HandPath, TheLeftHandIsTheMirrorImage) {
  const auto mirror = [](const Vec3& p) { return Vec3(-p.x, p.y, p.z); };
  const std::vector<Points> paths = random_paths(5, 6);
  std::vector<Points> left_paths;
  for (const Points& path : paths) left_paths.push_back(mapped(path, mirror));
  HandPathFit left_handed;
  left_handed.hand = Hand::left;
  const HandPathModel right = HandPathModel::fit(paths);
  const HandPathModel left = HandPathModel::fit(left_paths, left_handed);
  EXPECT_LT(largest_distance(right.offsets(), left.offsets()), kRounding);
  for (const HandPathModel& model : {HandPathModel::published(), right}) {
    const Points control = model.predict(mirror(kHome), mirror(kShelf), {Hand::left, {}, {}}).control;
    EXPECT_EQ(control, mapped(model.predict(kHome, kShelf).control, mirror));
  }
  EXPECT_EQ(right.sample(mirror(kHome), mirror(kShelf), 9, {Hand::left, {}, {}}).control,
            mapped(right.sample(kHome, kShelf, 9).control, mirror));
}

TEST(HandPath, MeanAndCovarianceAgreeWithTheirDefinitions) {
  const std::vector<Points> paths = random_paths(6, 40);
  const HandPathModel model = HandPathModel::fit(paths);
  std::vector<std::array<long double, 6>> rows;
  for (const Points& path : paths) {
    const Points control = fit_bezier(path);
    const Vec3 axis = path.back() - path.front();
    std::array<long double, 6> row{};
    for (std::size_t k = 0; k < 6; ++k) {
      const auto i = k / 3 + 1;
      const auto c = static_cast<int>(k % 3);
      row[k] = (control[i][c] - path.front()[c] - static_cast<double>(i) / 3.0 * axis[c]) / glm::length(axis);
    }
    rows.push_back(row);
  }
  const auto mean = [&](std::size_t k) {
    long double sum = 0;
    for (const auto& row : rows) sum += row[k];
    return sum / static_cast<long double>(rows.size());
  };
  for (std::size_t a = 0; a < 6; ++a) {
    EXPECT_NEAR(model.offsets()[a / 3][static_cast<int>(a % 3)], static_cast<double>(mean(a)), kRounding);
    for (std::size_t b = 0; b < 6; ++b) {
      long double sum = 0;
      for (const auto& row : rows) sum += (row[a] - mean(a)) * (row[b] - mean(b));
      EXPECT_NEAR((*model.covariance())(static_cast<int>(a), static_cast<int>(b)), static_cast<double>(sum / 39),
                  kRounding);
    }
  }
}

TEST(HandPath, SamplesHaveTheMeanAndCovarianceOfTheModel) {
  const HandPathModel model = HandPathModel::fit(random_paths(7, 30));
  constexpr int kCount = 20'000;
  const Vec3 end(0.0, 1.0, 0.0);  // d_a = 1: offsets are deviations
  const Points mean_control = model.predict(Vec3(0.0), end).control;
  Eigen::MatrixXd deviations(kCount, 6);
  for (int i = 0; i < kCount; ++i) {
    const Points control = model.sample(Vec3(0.0), end, static_cast<std::uint64_t>(i)).control;
    deviations.row(i) << to_eigen(control[1] - mean_control[1]).transpose(),
        to_eigen(control[2] - mean_control[2]).transpose();
  }
  const Eigen::MatrixXd& covariance = *model.covariance();
  const Eigen::MatrixXd found = deviations.transpose() * deviations / kCount;
  const double size = covariance.diagonal().maxCoeff();
  EXPECT_LT((found - covariance).cwiseAbs().maxCoeff(), 0.05 * size);  // five standard errors: 5 sqrt(2 / 20,000)
  EXPECT_LT(deviations.colwise().mean().cwiseAbs().maxCoeff(), 5.0 * std::sqrt(size / kCount));
  const double fourth = deviations.col(0).array().pow(4).mean() / std::pow(found(0, 0), 2);
  EXPECT_NEAR(fourth, 3.0, 0.2) << "kurtosis of a normal distribution";
}

// Two paths leave one direction of variation: every sample lies on it.
TEST(HandPath, SamplesOfFewPathsStayAmongThem) {
  const HandPathModel model = HandPathModel::fit(random_paths(8, 2));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(*model.covariance());
  const Eigen::VectorXd direction = eigen.eigenvectors().col(5);
  const Vec3 end(0.0, 1.0, 0.0);
  const Points mean_control = model.predict(Vec3(0.0), end).control;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Points control = model.sample(Vec3(0.0), end, seed).control;
    Eigen::VectorXd deviation(6);
    deviation << to_eigen(control[1] - mean_control[1]), to_eigen(control[2] - mean_control[2]);
    EXPECT_LT((deviation - direction * direction.dot(deviation)).norm(), 1e-7 * (1.0 + deviation.norm()));
  }
  const HandPathModel twice = HandPathModel::fit(std::vector<Points>(3, random_paths(8, 1)[0]));
  EXPECT_LT(largest_distance(twice.sample(kHome, kShelf, 1).control, twice.predict(kHome, kShelf).control), kRounding)
      << "equal paths do not vary";
}

TEST(HandPath, TheSeedAloneDecidesTheSample) {
  const HandPathModel model = HandPathModel::fit(random_paths(9, 10));
  EXPECT_EQ(model.sample(kHome, kShelf, 42).control, model.sample(kHome, kShelf, 42).control);
  EXPECT_NE(model.sample(kHome, kShelf, 42).control, model.sample(kHome, kShelf, 43).control);
}

TEST(HandPath, AReachThatEndsWhereItStartsStandsStill) {
  const HandPath path = HandPathModel::published().predict(kHome, kHome);
  EXPECT_EQ(path.control, Points(4, kHome));
  EXPECT_EQ(path.positions(std::vector<double>{0.0, 0.5, 1.0}), Points(3, kHome));
}

TEST(HandPath, OtherDegreesWork) {
  for (const int degree : {1, 2, 4}) {
    HandPathFit options;
    options.form.degree = degree;
    const std::vector<Points> paths = random_paths(10, 3);
    const HandPathModel model = HandPathModel::fit(paths, options);
    EXPECT_EQ(model.degree(), degree);
    EXPECT_EQ(model.sample(kHome, kShelf, 1).control.size(), static_cast<std::size_t>(degree) + 1);
  }
}

std::string message_of(const auto& action) {
  try {
    (void)action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(HandPath, NamesThePathOrTheArgumentThatIsWrong) {
  std::vector<Points> paths = random_paths(11, 3);
  const auto fit = [&](const HandPathFit& options = {}) {
    return message_of([&] { return HandPathModel::fit(paths, options); });
  };
  HandPathFit timed;
  timed.form.scaling = OffsetScaling::distance_time;
  EXPECT_EQ(fit(timed), "durations has 0 values, expected 3, one per path");
  timed.durations_s = {1.0, 0.0, 1.0};
  EXPECT_EQ(fit(timed), "paths[1]: duration is 0.000000 s, expected a finite number > 0");
  timed.durations_s = {1.0, 1.0, 1.0};
  EXPECT_EQ(message_of([&] { return HandPathModel::fit(paths, timed).predict(kHome, kShelf); }),
            "duration is missing, a model scaled by distance and time needs it");
  HandPathFit options;
  options.form.degree = 0;
  EXPECT_EQ(fit(options), "degree is 0, expected 1 to 10");
  options = {};
  options.speed.alpha = -1.0;
  EXPECT_NE(fit(options).find("alpha is -1"), std::string::npos);
  paths[2][4].x = kMissing;
  EXPECT_EQ(fit(), "paths[2]: points[4] is not finite");
  paths[2] = Points(5, kHome);
  EXPECT_NE(fit().find("paths[2]: starts and ends 0.000000 m apart"), std::string::npos);
  paths.clear();
  EXPECT_EQ(fit(), "paths is empty, expected at least 1 path");
  const HandPathModel model = HandPathModel::published();
  EXPECT_EQ(message_of([&] { return model.predict(Vec3(kMissing), kShelf); }), "start is not finite");
  EXPECT_EQ(message_of([&] { return model.predict(kHome, Vec3(kMissing)); }), "end is not finite");
  EXPECT_NE(message_of([&] { return model.sample(kHome, kShelf, 1); }).find("no covariance"), std::string::npos);
  EXPECT_NE(message_of([&] {
              return HandPathModel::fit(random_paths(1, 1)).sample(kHome, kShelf, 1);
            }).find("at least 2 paths"),
            std::string::npos);
}

}  // namespace
}  // namespace reachcast
