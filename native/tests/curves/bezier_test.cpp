// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/bezier.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

namespace reachcast {
namespace {

/// Rounding of degree 10 at most, on points of size 1.
constexpr double kRounding = 1e-12;

Points random_points(std::mt19937_64& random, std::size_t count) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Points points;
  for (std::size_t i = 0; i < count; ++i) points.emplace_back(uniform(random), uniform(random), uniform(random));
  return points;
}

std::vector<double> random_times(std::mt19937_64& random, std::size_t count) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<double> times(count);
  std::generate(times.begin(), times.end(), [&] { return uniform(random); });
  std::sort(times.begin(), times.end());
  times.front() = 0.0;
  times.back() = 1.0;
  return times;
}

double largest_distance(const Points& a, const Points& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, glm::length(a[i] - b[i]));
  return largest;
}

/// sum of binomial(d, i) s^i (1-s)^(d-i) P_i in long double, straight from the definition.
Vec3 bernstein_sum(const Points& control, double s) {
  const auto d = static_cast<int>(control.size()) - 1;
  long double sum[3] = {0, 0, 0};
  for (int i = 0; i <= d; ++i) {
    const long double binomial = std::tgamma(d + 1.0L) / (std::tgamma(i + 1.0L) * std::tgamma(d - i + 1.0L));
    const long double weight = binomial * std::pow(static_cast<long double>(s), i) * std::pow(1.0L - s, d - i);
    for (int axis = 0; axis < 3; ++axis) sum[axis] += weight * control[static_cast<std::size_t>(i)][axis];
  }
  return {static_cast<double>(sum[0]), static_cast<double>(sum[1]), static_cast<double>(sum[2])};
}

double sum_of_squares(const Points& control, const Points& points, const std::vector<double>& times) {
  double sum = 0.0;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Vec3 miss = points[i] - bernstein_sum(control, times[i]);
    sum += glm::dot(miss, miss);
  }
  return sum;
}

TEST(Bezier, DeCasteljauAgreesWithBernstein) {
  std::mt19937_64 random(1);
  for (std::size_t degree = 1; degree <= 10; ++degree) {
    const Points control = random_points(random, degree + 1);
    for (const double s : random_times(random, 20)) {
      EXPECT_LT(glm::length(eval_bezier(control, s) - bernstein_sum(control, s)), kRounding);
    }
    EXPECT_EQ(eval_bezier(control, 0.0), control.front());
    EXPECT_EQ(eval_bezier(control, 1.0), control.back());
  }
}

TEST(Bezier, FitRecoversTheCurveThatPointsWereTakenFrom) {
  std::mt19937_64 random(2);
  for (int degree = 1; degree <= 5; ++degree) {
    for (int round = 0; round < 20; ++round) {
      const Points control = random_points(random, static_cast<std::size_t>(degree) + 1);
      std::vector<double> times;
      for (int i = 0; i <= 30; ++i) times.push_back(i / 30.0);
      const Points points = eval_bezier(control, times);
      EXPECT_LT(largest_distance(fit_bezier(points, times, degree), control), 1e-11);
    }
  }
}

// The paper's own B^T B P = B^T Y in long double, as an oracle that shares nothing with the implementation.
TEST(Bezier, FitAgreesWithTheNormalEquations) {
  using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  std::mt19937_64 random(3);
  for (int degree = 2; degree <= 5; ++degree) {
    for (const int count : {12, 40, 200}) {
      const Points points = random_points(random, static_cast<std::size_t>(count));
      const std::vector<double> times = arc_length_times(points);
      Matrix b(count - 2, degree - 1), y(count - 2, 3);
      for (int i = 1; i + 1 < count; ++i) {
        const double s = times[static_cast<std::size_t>(i)];
        const auto weight = [&](int j) {
          Points unit(static_cast<std::size_t>(degree) + 1, Vec3(0.0));
          unit[static_cast<std::size_t>(j)].x = 1.0;
          return bernstein_sum(unit, s).x;
        };
        for (int j = 1; j < degree; ++j) b(i - 1, j - 1) = weight(j);
        const Vec3 rest =
            points[static_cast<std::size_t>(i)] - weight(0) * points.front() - weight(degree) * points.back();
        for (int axis = 0; axis < 3; ++axis) y(i - 1, axis) = rest[axis];
      }
      const Matrix inner = (b.transpose() * b).fullPivLu().solve(b.transpose() * y);
      const Points control = fit_bezier(points, degree);
      for (int j = 1; j < degree; ++j) {
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_NEAR(control[static_cast<std::size_t>(j)][axis], static_cast<double>(inner(j - 1, axis)), 1e-9);
        }
      }
      EXPECT_EQ(control.front(), points.front());
      EXPECT_EQ(control.back(), points.back());
    }
  }
}

TEST(Bezier, NoNearbyControlPointsFitBetter) {
  std::mt19937_64 random(4);
  const Points points = random_points(random, 25);
  const std::vector<double> times = arc_length_times(points);
  const Points control = fit_bezier(points);
  const double best = sum_of_squares(control, points, times);
  for (int round = 0; round < 500; ++round) {
    Points moved = control;
    const Points step = random_points(random, 2);
    const double size = std::pow(10.0, -(round % 5));
    moved[1] += size * step[0];
    moved[2] += size * step[1];
    EXPECT_GE(sum_of_squares(moved, points, times), best - kRounding);
  }
}

TEST(Bezier, FitCommutesWithRigidMotionAndScale) {
  std::mt19937_64 random(5);
  const Points points = random_points(random, 20);
  const Mat3 turn = glm::mat3_cast(glm::normalize(Quat(0.3, -0.7, 0.2, 0.5)));
  const auto moved = [&](const Points& original) {
    Points result;
    for (const Vec3& p : original) result.push_back(0.4 * (turn * p) + Vec3(3.0, -1.0, 2.0));
    return result;
  };
  EXPECT_LT(largest_distance(fit_bezier(moved(points)), moved(fit_bezier(points))), 1e-11);
}

TEST(Bezier, BernsteinPolynomialsAreTheWeightsOfControlPoints) {
  for (int degree = 1; degree <= kMaxBezierDegree; ++degree) {
    for (const double s : {0.0, 0.2, 0.5, 0.93, 1.0}) {
      const Eigen::RowVectorXd row = bernstein(s, degree);
      EXPECT_NEAR(row.sum(), 1.0, kRounding);
      for (int i = 0; i <= degree; ++i) {
        Points unit(static_cast<std::size_t>(degree) + 1, Vec3(0.0));
        unit[static_cast<std::size_t>(i)].y = 1.0;
        EXPECT_NEAR(row[i], bernstein_sum(unit, s).y, kRounding);
      }
    }
  }
}

TEST(Bezier, TheMaximumErrorIsTheLargestMiss) {
  std::mt19937_64 random(6);
  const Points points = random_points(random, 30), control = random_points(random, 4);
  const std::vector<double> times = random_times(random, 30);
  double largest = 0.0;
  for (std::size_t i = 0; i < 30; ++i) {
    largest = std::max(largest, glm::length(points[i] - bernstein_sum(control, times[i])));
  }
  EXPECT_NEAR(maximum_error(points, times, control), largest, kRounding);
}

TEST(Bezier, EvenTimesIgnoreWhereThePointsLie) {
  EXPECT_EQ(even_times(5), (std::vector<double>{0.0, 0.25, 0.5, 0.75, 1.0}));
  EXPECT_THROW((void)even_times(1), std::invalid_argument);
}

TEST(Bezier, ArcLengthTimesAreRelativeDistances) {
  const Points points{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 2, 0}, {1, 2, 1}};
  EXPECT_EQ(arc_length_times(points), (std::vector<double>{0.0, 0.25, 0.25, 0.75, 1.0}));
  EXPECT_EQ(arc_length_times(Points(5, Vec3(1.0))), (std::vector<double>{0.0, 0.25, 0.5, 0.75, 1.0}));
}

TEST(Bezier, TwoPointsGiveTheStraightLine) {
  const Points points{{0, 0, 0}, {3, 6, -9}};
  for (int degree = 1; degree <= kMaxBezierDegree; ++degree) {
    EXPECT_EQ(fit_bezier(points, degree), axis_points(points[0], points[1], degree));
  }
}

TEST(Bezier, AStandstillGivesEqualControlPoints) {
  EXPECT_EQ(fit_bezier(Points(7, Vec3(1.0, 2.0, 3.0))), Points(4, Vec3(1.0, 2.0, 3.0)));
}

TEST(Bezier, WhatPointsLeaveOpenStaysNearTheAxis) {
  const Points points{{0, 0, 0}, {0.5, 0.3, 0}, {1, 0, 0}};
  const Points control = fit_bezier(points, 3);
  EXPECT_LT(glm::length(eval_bezier(control, 0.5) - points[1]), kRounding) << "one inner point is met exactly";
  EXPECT_NEAR(control[1].y, control[2].y, kRounding) << "and both inner control points move alike";
  const Points repeated{points[0], points[0], points[0], points[1], points[1], points[2], points[2]};
  EXPECT_LT(largest_distance(fit_bezier(repeated, 3), control), kRounding);
  const Points line{{0, 0, 0}, {0, 0, 0}, {1, 1, 1}, {1, 1, 1}};
  EXPECT_LT(largest_distance(fit_bezier(line, 3), axis_points(line.front(), line.back(), 3)), kRounding);
}

TEST(Bezier, APathMayEndWhereItBegan) {
  const Points loop = eval_bezier(Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}},
                                  std::vector<double>{0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0});
  const Points control = fit_bezier(loop);
  EXPECT_EQ(control.front(), control.back());
  for (const Vec3& p : control) EXPECT_TRUE(is_finite(p));
  EXPECT_GT(glm::length(control[1]), 0.5);
}

std::string message_of(const auto& action) {
  try {
    (void)action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(Bezier, NamesTheArgumentThatIsWrong) {
  const Points good{{0, 0, 0}, {1, 0, 0}, {2, 1, 0}};
  Points bad = good;
  bad[1].y = kMissing;
  const std::vector<double> short_times{0.0, 1.0}, late{0.0, 1.5, 1.0};
  EXPECT_EQ(message_of([&] { return fit_bezier(bad); }), "points[1] is not finite");
  EXPECT_EQ(message_of([&] { return fit_bezier(Points(1, Vec3(0.0))); }), "points has 1 points, expected at least 2");
  EXPECT_EQ(message_of([&] { return fit_bezier(good, 0); }), "degree is 0, expected 1 to 10");
  EXPECT_EQ(message_of([&] { return fit_bezier(good, 11); }), "degree is 11, expected 1 to 10");
  EXPECT_EQ(message_of([&] { return fit_bezier(good, short_times); }), "times has 2 values, expected 3, one per point");
  EXPECT_EQ(message_of([&] { return fit_bezier(good, late); }), "times[1] is 1.500000, expected a number in [0, 1]");
  EXPECT_EQ(message_of([&] { return eval_bezier(good, -0.5); }), "s[0] is -0.500000, expected a number in [0, 1]");
  EXPECT_EQ(message_of([&] { return eval_bezier(good, kMissing); }), "s[0] is nan, expected a number in [0, 1]");
  EXPECT_EQ(message_of([&] { return eval_bezier(bad, 0.5); }), "control[1] is not finite");
  EXPECT_EQ(message_of([&] { return eval_bezier(Points(12, Vec3(0.0)), 0.5); }),
            "control has 12 points, expected at most 11");
  EXPECT_EQ(message_of([&] {
              return fit_bezier(Points{{-1e308, 0, 0}, {1e308, 0, 0}});
            }),
            "points span a length that is not finite");
}

}  // namespace
}  // namespace reachcast
