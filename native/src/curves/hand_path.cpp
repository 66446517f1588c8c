// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/hand_path.hpp"

#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include "reachcast/curves/bezier.hpp"

namespace reachcast {

namespace {

// A pivot smaller than this share of its variance is what rounding leaves of zero.
constexpr double kPivotTolerance = 1e-12;

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument(what);
}

double scale_of(OffsetScaling scaling, double distance_m, std::optional<double> duration_s) {
  if (scaling == OffsetScaling::distance) return distance_m;
  if (!duration_s) refuse("duration is missing, a model scaled by distance and time needs it");
  if (!std::isfinite(*duration_s) || *duration_s <= 0.0) {
    refuse("duration is " + std::to_string(*duration_s) + " s, expected a finite number > 0");
  }
  return std::sqrt(*duration_s * distance_m);
}

Vec3 for_hand(const Vec3& right_hand_offset, Hand hand) {
  const Vec3& offset = right_hand_offset;
  return hand == Hand::right ? offset : Vec3(-offset.x, offset.y, offset.z);
}

/// Y_i = (P_i - A_i) / scale for the inner control points (2007, sections 3.3 and 4), stacked.
Eigen::VectorXd scaled_offsets(const Points& path, const HandPathFit& options, std::optional<double> duration_s) {
  const Points control = fit_bezier(path, options.degree);
  const Points axis = axis_points(path.front(), path.back(), options.degree);
  const double distance_m = glm::length(path.back() - path.front());
  if (distance_m < kMinimumReach_m) {
    refuse("starts and ends " + std::to_string(distance_m) + " m apart, expected at least " +
           std::to_string(kMinimumReach_m) + " m");
  }
  const double scale = scale_of(options.scaling, distance_m, duration_s);
  Eigen::VectorXd offsets(3 * (options.degree - 1));
  for (int i = 1; i < options.degree; ++i) {
    const auto k = static_cast<std::size_t>(i);
    offsets.segment<3>(Eigen::Index{3} * (i - 1)) = to_eigen(for_hand((control[k] - axis[k]) / scale, options.hand));
  }
  return offsets;
}

/// One row of scaled offsets per path.
Eigen::MatrixXd offset_rows(std::span<const Points> paths, const HandPathFit& options) {
  const bool timed = options.scaling == OffsetScaling::distance_time;
  if (timed && options.durations_s.size() != paths.size()) {
    refuse("durations has " + std::to_string(options.durations_s.size()) + " values, expected " +
           std::to_string(paths.size()) + ", one per path");
  }
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(paths.size()), 3 * (options.degree - 1));
  for (std::size_t i = 0; i < paths.size(); ++i) {
    try {
      std::optional<double> duration_s;
      if (timed) duration_s = options.durations_s[i];
      rows.row(static_cast<Eigen::Index>(i)) = scaled_offsets(paths[i], options, duration_s).transpose();
    } catch (const std::invalid_argument& error) {
      refuse("paths[" + std::to_string(i) + "]: " + error.what());
    }
  }
  return rows;
}

/// L with L L^T = covariance, which may have no full rank (few paths): a direction without variance gets none. Unlike
/// an eigenvector basis, L does not depend on how a machine rounds.
Eigen::MatrixXd cholesky_factor(const Eigen::MatrixXd& covariance) {
  const Eigen::Index n = covariance.rows();
  Eigen::MatrixXd factor = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    double pivot = covariance(j, j);
    for (Eigen::Index k = 0; k < j; ++k) pivot -= factor(j, k) * factor(j, k);
    if (pivot <= kPivotTolerance * covariance(j, j)) continue;
    factor(j, j) = std::sqrt(pivot);
    for (Eigen::Index i = j + 1; i < n; ++i) {
      double rest = covariance(i, j);
      for (Eigen::Index k = 0; k < j; ++k) rest -= factor(i, k) * factor(j, k);
      factor(i, j) = rest / factor(j, j);
    }
  }
  return factor;
}

/// Independent standard normal numbers (Box and Muller). The standard fixes the bits of mt19937_64 but not what
/// std::normal_distribution makes of them.
Eigen::VectorXd normal_numbers(std::uint64_t seed, Eigen::Index count) {
  std::mt19937_64 bits(seed);
  const auto uniform = [&] { return static_cast<double>(bits() >> 11) * 0x1.0p-53; };  // [0, 1)
  Eigen::VectorXd numbers(count);
  for (Eigen::Index i = 0; i < count; i += 2) {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    const double angle = 2.0 * kPi * uniform();
    numbers[i] = radius * std::cos(angle);
    if (i + 1 < count) numbers[i + 1] = radius * std::sin(angle);
  }
  return numbers;
}

}  // namespace

Points HandPath::positions(std::span<const double> t) const {
  std::vector<double> s;
  s.reserve(t.size());
  for (const double time : t) s.push_back(speed.progress(time));
  return eval_bezier(control, s);
}

HandPathModel HandPathModel::published() {
  HandPathModel model;
  model.offsets_.resize(6);
  model.offsets_ << -0.025, -0.148, 0.077, -0.015, -0.139, -0.002;  // 2007, section 4, after Table 2
  return model;
}

HandPathModel HandPathModel::fit(std::span<const Points> paths, const HandPathFit& options) {
  if (paths.empty()) refuse("paths is empty, expected at least 1 path");
  if (options.degree < 1 || options.degree > kMaxBezierDegree) {
    refuse("degree is " + std::to_string(options.degree) + ", expected 1 to " + std::to_string(kMaxBezierDegree));
  }
  (void)options.speed.progress(0.5);  // throws for exponents out of range
  const Eigen::MatrixXd rows = offset_rows(paths, options);
  HandPathModel model;
  model.scaling_ = options.scaling;
  model.speed_ = options.speed;
  model.offsets_ = rows.colwise().mean().transpose();
  if (rows.rows() >= 2) {
    const Eigen::MatrixXd residuals = rows.rowwise() - model.offsets_.transpose();
    model.covariance_ = residuals.transpose() * residuals / static_cast<double>(rows.rows() - 1);
  }
  return model;
}

HandPath HandPathModel::predict(const Vec3& start, const Vec3& end, Hand hand, std::optional<double> duration_s) const {
  return place(offsets_, start, end, hand, duration_s);
}

HandPath HandPathModel::sample(const Vec3& start, const Vec3& end, std::uint64_t seed, Hand hand,
                               std::optional<double> duration_s) const {
  if (!covariance_) refuse("the model has no covariance to sample from: fit it to at least 2 paths");
  const Eigen::VectorXd normals = normal_numbers(seed, offsets_.size());
  return place(offsets_ + cholesky_factor(*covariance_) * normals, start, end, hand, duration_s);
}

Points HandPathModel::offsets() const {
  Points points;
  for (Eigen::Index i = 0; i < offsets_.size(); i += 3) points.push_back(to_glm(offsets_.segment<3>(i)));
  return points;
}

HandPath HandPathModel::place(const Eigen::VectorXd& offsets, const Vec3& start, const Vec3& end, Hand hand,
                              std::optional<double> duration_s) const {
  if (!is_finite(start)) refuse("start is not finite");
  if (!is_finite(end)) refuse("end is not finite");
  const double scale = scale_of(scaling_, glm::length(end - start), duration_s);
  HandPath path{axis_points(start, end, degree()), speed_};
  for (int i = 1; i < degree(); ++i) {
    const Vec3 offset = to_glm(offsets.segment<3>(Eigen::Index{3} * (i - 1)));
    path.control[static_cast<std::size_t>(i)] += scale * for_hand(offset, hand);
  }
  return path;
}

}  // namespace reachcast
