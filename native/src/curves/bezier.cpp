// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/bezier.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace reachcast {

namespace {

// Relative size below which a direction counts as left open by the points.
constexpr double kRankTolerance = 1e-10;

void require_points(std::span<const Vec3> points, const char* name) {
  const std::string label(name);
  if (points.size() < 2) {
    throw std::invalid_argument(label + " has " + std::to_string(points.size()) + " points, expected at least 2");
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_finite(points[i])) throw std::invalid_argument(label + "[" + std::to_string(i) + "] is not finite");
  }
}

void require_degree(int degree) {
  if (degree >= 1 && degree <= kMaxBezierDegree) return;
  throw std::invalid_argument("degree is " + std::to_string(degree) + ", expected 1 to " +
                              std::to_string(kMaxBezierDegree));
}

void require_unit(std::span<const double> values, const char* name) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] >= 0.0 && values[i] <= 1.0) continue;
    throw std::invalid_argument(std::string(name) + "[" + std::to_string(i) + "] is " + std::to_string(values[i]) +
                                ", expected a number in [0, 1]");
  }
}

void require_times(std::span<const double> times, std::size_t count) {
  if (times.size() != count) {
    throw std::invalid_argument("times has " + std::to_string(times.size()) + " values, expected " +
                                std::to_string(count) + ", one per point");
  }
  require_unit(times, "times");
}

void require_control(std::span<const Vec3> control) {
  require_points(control, "control");
  if (control.size() <= std::size_t{kMaxBezierDegree} + 1) return;
  throw std::invalid_argument("control has " + std::to_string(control.size()) + " points, expected at most " +
                              std::to_string(kMaxBezierDegree + 1));
}

Vec3 de_casteljau(std::span<const Vec3> control, double s) {
  Points level(control.begin(), control.end());
  for (std::size_t count = level.size() - 1; count > 0; --count) {
    for (std::size_t i = 0; i < count; ++i) level[i] = (1.0 - s) * level[i] + s * level[i + 1];
  }
  return level.front();
}

}  // namespace

std::vector<double> arc_length_times(std::span<const Vec3> points) {
  require_points(points, "points");
  std::vector<double> times(points.size(), 0.0);
  for (std::size_t i = 1; i < points.size(); ++i) times[i] = times[i - 1] + glm::length(points[i] - points[i - 1]);
  const double total = times.back();
  if (!std::isfinite(total)) throw std::invalid_argument("points span a length that is not finite");
  for (std::size_t i = 0; i < times.size(); ++i) {
    times[i] = total > 0.0 ? times[i] / total : static_cast<double>(i) / static_cast<double>(times.size() - 1);
  }
  return times;
}

std::vector<double> even_times(std::size_t count) {
  if (count < 2) throw std::invalid_argument("count is " + std::to_string(count) + ", expected at least 2");
  std::vector<double> times(count);
  for (std::size_t i = 0; i < count; ++i) times[i] = static_cast<double>(i) / static_cast<double>(count - 1);
  return times;
}

Eigen::RowVectorXd bernstein(double s, int degree) {
  require_degree(degree);
  require_unit(std::span<const double>(&s, 1), "s");
  Eigen::RowVectorXd row(degree + 1);
  double binomial = 1.0;
  for (int i = 0; i <= degree; ++i) {
    row[i] = binomial * std::pow(s, i) * std::pow(1.0 - s, degree - i);
    binomial = binomial * (degree - i) / (i + 1);
  }
  return row;
}

Points axis_points(const Vec3& start, const Vec3& end, int degree) {
  require_degree(degree);
  Points points;
  for (int i = 0; i <= degree; ++i) points.push_back(start + static_cast<double>(i) / degree * (end - start));
  points.back() = end;
  return points;
}

Points fit_bezier(std::span<const Vec3> points, int degree) {
  return fit_bezier(points, arc_length_times(points), degree);
}

Points fit_bezier(std::span<const Vec3> points, std::span<const double> times, int degree) {
  require_points(points, "points");
  require_degree(degree);
  require_times(times, points.size());
  Points control = axis_points(points.front(), points.back(), degree);
  const auto inner = static_cast<Eigen::Index>(points.size()) - 2;
  if (degree == 1 || inner == 0) return control;
  // The paper's B P = Y with B (n-1) x (d-1) (2007, section 3.2), with the axis points taken off both sides. They are
  // the control points of the straight line from Z_0 to Z_n, so what remains of Y_i is Z_i minus that line at s_i.
  Eigen::MatrixXd basis(inner, degree - 1);
  Eigen::MatrixXd deviation(inner, 3);
  for (Eigen::Index i = 0; i < inner; ++i) {
    const auto k = static_cast<std::size_t>(i) + 1;
    basis.row(i) = bernstein(times[k], degree).segment(1, degree - 1);
    const Vec3 line = (1.0 - times[k]) * points.front() + times[k] * points.back();
    deviation.row(i) = to_eigen(points[k] - line).transpose();
  }
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> qr;
  qr.setThreshold(kRankTolerance);
  qr.compute(basis);
  const Eigen::MatrixXd offsets = qr.solve(deviation);
  for (int i = 1; i < degree; ++i) {
    control[static_cast<std::size_t>(i)] += to_glm(offsets.row(i - 1).transpose());
  }
  return control;
}

Vec3 eval_bezier(std::span<const Vec3> control, double s) {
  return eval_bezier(control, std::span<const double>(&s, 1)).front();
}

Points eval_bezier(std::span<const Vec3> control, std::span<const double> s) {
  require_control(control);
  require_unit(s, "s");
  Points points;
  points.reserve(s.size());
  for (const double value : s) points.push_back(de_casteljau(control, value));
  return points;
}

double maximum_error(std::span<const Vec3> points, std::span<const double> times, std::span<const Vec3> control) {
  require_points(points, "points");
  require_times(times, points.size());
  const Points curve = eval_bezier(control, times);
  double largest = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) largest = std::max(largest, glm::length(points[i] - curve[i]));
  return largest;
}

}  // namespace reachcast
