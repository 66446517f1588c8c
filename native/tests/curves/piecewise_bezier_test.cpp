// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/piecewise_bezier.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include "reachcast/curves/bezier.hpp"

namespace reachcast {
namespace {

constexpr double kRounding = 1e-10;

/// A path with `turns` bends, too many for one cubic.
Points winding(std::size_t count, double turns) {
  Points points;
  for (const double t : even_times(count)) {
    points.emplace_back(std::sin(turns * kPi * t), 2.0 * t, 0.3 * std::cos(1.3 * turns * t));
  }
  return points;
}

double largest_distance(const Points& a, const Points& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, glm::length(a[i] - b[i]));
  return largest;
}

TEST(PiecewiseBezier, OnePieceIsTheBezierFit) {
  const Points points = winding(40, 1.0);
  for (int degree = 2; degree <= 5; ++degree) {
    const PiecewiseBezier curve = fit_piecewise_bezier(points, {degree, 0.0, 1});
    ASSERT_EQ(curve.pieces.size(), 1u);
    EXPECT_LT(largest_distance(curve.pieces[0], fit_bezier(points, degree)), kRounding);
    EXPECT_NEAR(curve.error, maximum_error(points, arc_length_times(points), curve.pieces[0]), kRounding);
  }
}

TEST(PiecewiseBezier, PiecesAreAddedUntilTheToleranceIsKept) {
  const Points points = winding(400, 5.0);
  std::size_t pieces = 1;
  for (const double tolerance : {0.5, 0.1, 0.02, 0.004}) {
    const PiecewiseBezier curve = fit_piecewise_bezier(points, {3, tolerance, 32});
    EXPECT_LE(curve.error, tolerance);
    EXPECT_GE(curve.pieces.size(), pieces);
    pieces = curve.pieces.size();
    const Points found = curve.positions(arc_length_times(points));
    EXPECT_NEAR(largest_distance(found, points), curve.error, kRounding);
    EXPECT_EQ(found.front(), points.front());
    EXPECT_EQ(found.back(), points.back());
  }
  EXPECT_GT(pieces, 4u);
}

TEST(PiecewiseBezier, PiecesMeetWithEqualDerivatives) {
  for (int degree = 2; degree <= 4; ++degree) {
    const PiecewiseBezier curve = fit_piecewise_bezier(winding(150, 4.0), {degree, 0.005, 12});
    ASSERT_GT(curve.pieces.size(), 2u);
    for (std::size_t i = 1; i < curve.pieces.size(); ++i) {
      const Points &left = curve.pieces[i - 1], &right = curve.pieces[i];
      EXPECT_LT(glm::length(left.back() - right.front()), kRounding);
      const Vec3 arriving = (left.back() - left[left.size() - 2]) / (curve.breaks[i] - curve.breaks[i - 1]);
      const Vec3 leaving = (right[1] - right[0]) / (curve.breaks[i + 1] - curve.breaks[i]);
      EXPECT_LT(glm::length(arriving - leaving), 1e-8);
    }
  }
}

// The same least squares with every control point free and the joints as constraints, solved by Lagrange multipliers.
TEST(PiecewiseBezier, AgreesWithConstrainedLeastSquares) {
  const Points points = winding(80, 3.0);
  const std::vector<double> times = arc_length_times(points);
  const PiecewiseBezier curve = fit_piecewise_bezier(points, {3, 0.0, 3});
  ASSERT_EQ(curve.pieces.size(), 3u);
  constexpr Eigen::Index kUnknowns = 12, kConstraints = 6;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(78, kUnknowns), y(78, 3);
  for (Eigen::Index i = 0; i < 78; ++i) {
    const double s = times[static_cast<std::size_t>(i) + 1];
    Eigen::Index piece = 0;
    while (piece < 2 && s >= curve.breaks[static_cast<std::size_t>(piece) + 1]) ++piece;
    const double low = curve.breaks[static_cast<std::size_t>(piece)];
    const double u = (s - low) / (curve.breaks[static_cast<std::size_t>(piece) + 1] - low), v = 1.0 - u;
    a.row(i).segment<4>(4 * piece) << v * v * v, 3 * u * v * v, 3 * u * u * v, u * u * u;
    y.row(i) = to_eigen(points[static_cast<std::size_t>(i) + 1]).transpose();
  }
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(kConstraints, kUnknowns), d = Eigen::MatrixXd::Zero(kConstraints, 3);
  c(0, 0) = c(1, 11) = 1.0;
  d.row(0) = to_eigen(points.front()).transpose();
  d.row(1) = to_eigen(points.back()).transpose();
  for (Eigen::Index joint = 0; joint < 2; ++joint) {
    const auto k = static_cast<std::size_t>(joint);
    const double h = curve.breaks[k + 1] - curve.breaks[k], g = curve.breaks[k + 2] - curve.breaks[k + 1];
    c.row(2 + 2 * joint).segment<2>(4 * joint + 3) << 1.0, -1.0;
    c.row(3 + 2 * joint).segment<4>(4 * joint + 2) << -1.0 / h, 1.0 / h, 1.0 / g, -1.0 / g;
  }
  Eigen::MatrixXd kkt = Eigen::MatrixXd::Zero(kUnknowns + kConstraints, kUnknowns + kConstraints);
  kkt.topLeftCorner(kUnknowns, kUnknowns) = a.transpose() * a;
  kkt.topRightCorner(kUnknowns, kConstraints) = c.transpose();
  kkt.bottomLeftCorner(kConstraints, kUnknowns) = c;
  Eigen::MatrixXd right(kUnknowns + kConstraints, 3);
  right << a.transpose() * y, d;
  const Eigen::MatrixXd control = kkt.fullPivLu().solve(right);
  for (std::size_t i = 0; i < 12; ++i) {
    const Vec3 expected = to_glm(control.row(static_cast<Eigen::Index>(i)).transpose());
    EXPECT_LT(glm::length(curve.pieces[i / 4][i % 4] - expected), 1e-8);
  }
}

TEST(PiecewiseBezier, DegenerateInputHasAnAnswer) {
  const Vec3 here(1.0, 2.0, 3.0), there(2.0, 2.0, 5.0);
  const PiecewiseBezier line = fit_piecewise_bezier(Points{here, there}, {});
  EXPECT_EQ(line.pieces, (std::vector<Points>{axis_points(here, there, 3)}));
  const PiecewiseBezier still = fit_piecewise_bezier(Points(30, here), {});
  EXPECT_LT(still.error, kRounding);
  EXPECT_LT(largest_distance(still.positions(std::vector<double>{0.0, 0.4, 1.0}), Points(3, here)), kRounding);
  Points pausing(20, here);
  pausing.insert(pausing.end(), 20, there);
  const PiecewiseBezier step = fit_piecewise_bezier(pausing, {3, 1e-6, 64});
  for (const Points& piece : step.pieces) {
    for (const Vec3& point : piece) EXPECT_TRUE(is_finite(point));
  }
  Points loop = winding(60, 2.0);
  loop.push_back(loop.front());
  const PiecewiseBezier closed = fit_piecewise_bezier(loop, {3, 0.01, 16});
  EXPECT_EQ(closed.pieces.front().front(), closed.pieces.back().back());
}

std::string message_of(const auto& action) {
  try {
    (void)action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(PiecewiseBezier, NamesTheArgumentThatIsWrong) {
  const Points points = winding(5, 1.0);
  const auto fit = [&](const PiecewiseFit& options) {
    return message_of([&] { return fit_piecewise_bezier(points, options); });
  };
  EXPECT_EQ(fit({1, 0.0, 1}), "degree is 1, expected 2 to 10 for pieces that meet smoothly");
  EXPECT_EQ(fit({3, -0.5, 1}), "tolerance is -0.500000, expected a finite number >= 0");
  EXPECT_EQ(fit({3, 0.0, 65}), "max_pieces is 65, expected 1 to 64");
  const std::vector<double> falling{0.0, 0.5, 0.4, 0.9, 1.0};
  EXPECT_EQ(message_of([&] { return fit_piecewise_bezier(points, falling, {}); }),
            "times[2] is 0.400000, expected at least the one before it, 0.500000");
  EXPECT_EQ(message_of([&] { return fit_piecewise_bezier(points, {}).positions(std::vector<double>{1.5}); }),
            "s[0] is 1.500000, expected a number in [0, 1]");
}

}  // namespace
}  // namespace reachcast
