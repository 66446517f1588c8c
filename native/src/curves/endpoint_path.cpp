// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/endpoint_path.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "reachcast/curves/bspline.hpp"

namespace reachcast {
namespace {

constexpr double kShortestAxis_m = 0.01;
constexpr double kRamp = 0.1;

}  // namespace

double resting_time(double t) {
  const double speed = 1.0 / (1.0 - kRamp), clamped = std::clamp(t, 0.0, 1.0);
  if (clamped < kRamp) return 0.5 * speed * clamped * clamped / kRamp;
  if (clamped > 1.0 - kRamp) return 1.0 - 0.5 * speed * (1.0 - clamped) * (1.0 - clamped) / kRamp;
  return speed * (clamped - 0.5 * kRamp);
}

EndpointPath fit_endpoint_path(std::span<const Vec3> points) {
  const auto count = static_cast<Eigen::Index>(points.size());
  if (count < 4)
    throw std::invalid_argument("points holds " + std::to_string(count) + " points; a path needs at least 4");
  const Vec3 axis = points.back() - points.front();
  const double length = glm::length(axis);
  if (!(length >= kShortestAxis_m)) {
    throw std::invalid_argument("points: start and end are " + std::to_string(length) +
                                " m apart; a path needs at least 0.01 m");
  }
  Eigen::MatrixXd integrals(count, kPathBasisCount), basis(count, kPathBasisCount);
  Eigen::MatrixXd covered(count, 1), deviation(count, 3);
  for (Eigen::Index f = 0; f < count; ++f) {
    const double t = static_cast<double>(f) / static_cast<double>(count - 1);
    const Vec3 offset = points[static_cast<std::size_t>(f)] - points.front();
    const double p = glm::dot(offset, axis) / (length * length);
    basis.row(f) = bspline_row(resting_time(t)).segment<kPathBasisCount>(1);
    integrals.row(f) = bspline_integral_row(t).segment<kPathBasisCount>(1);
    covered(f, 0) = p;
    deviation.row(f) = to_eigen(offset - p * axis).transpose();
  }
  if (!covered.allFinite()) throw std::invalid_argument("points holds a number that is not finite");
  // p(t) is the integral of v(t): fitting p avoids differentiating the recording.
  return {solve_smooth(integrals, covered), solve_smooth(basis, deviation)};
}

EndpointPath carried(const EndpointPath& path, const Vec3& from, const Vec3& to) {
  const double was = glm::length(from), is = glm::length(to);
  EndpointPath out = path;
  if (was < 1e-9 || is < 1e-9) {
    out.deviation.setZero();
    return out;
  }
  const Quat turn = smallest_rotation(from, to);
  const double shrink = std::min(1.0, is / was);
  for (Eigen::Index i = 0; i < kPathBasisCount; ++i) {
    out.deviation.row(i) = shrink * to_eigen(turn * to_glm(path.deviation.row(i).transpose())).transpose();
  }
  return out;
}

double progress(const EndpointPath& path, double t) {
  static const BasisRow all = bspline_integral_row(1.0);
  const double whole = all.segment<kPathBasisCount>(1).dot(path.velocity);
  if (t <= 0.0 || whole <= 1e-9) return t <= 0.0 ? 0.0 : std::min(t, 1.0);
  if (t >= 1.0) return 1.0;
  return bspline_integral_row(t).segment<kPathBasisCount>(1).dot(path.velocity) / whole;
}

Vec3 point_at(const EndpointPath& path, const Vec3& start, const Vec3& end, double t) {
  const Vec3 axis = end - start;
  const double square = glm::dot(axis, axis);
  const Vec3 off = to_glm((bspline_row(resting_time(t)).segment<kPathBasisCount>(1) * path.deviation).transpose());
  const Vec3 radial = square > 1e-18 ? off - glm::dot(off, axis) / square * axis : off;
  if (t >= 1.0) return end;
  return start + progress(path, t) * axis + (t <= 0.0 ? Vec3(0.0) : radial);
}

}  // namespace reachcast
