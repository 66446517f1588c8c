// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/path_offsets.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "reachcast/curves/bezier.hpp"

namespace reachcast {

void OffsetForm::require_valid() const {
  if (degree >= 1 && degree <= kMaxBezierDegree) return;
  throw std::invalid_argument("degree is " + std::to_string(degree) + ", expected 1 to " +
                              std::to_string(kMaxBezierDegree));
}

double offset_scale(const OffsetForm& form, double distance_m, std::optional<double> duration_s) {
  if (form.scaling == OffsetScaling::none) return 1.0;
  if (form.scaling == OffsetScaling::distance) return distance_m;
  if (!duration_s) {
    throw std::invalid_argument("duration is missing, a model scaled by distance and time needs it");
  }
  if (!std::isfinite(*duration_s) || *duration_s <= 0.0) {
    throw std::invalid_argument("duration is " + std::to_string(*duration_s) + " s, expected a finite number > 0");
  }
  return std::sqrt(*duration_s * distance_m);  // 2007, section 4: Y_i = (P_i - A_i) / sqrt(t d_a)
}

Points offset_origins(const OffsetForm& form, const Vec3& start, const Vec3& end) {
  form.require_valid();
  Points origins = axis_points(start, end, form.degree);
  const bool from_start = form.origin == OffsetOrigin::ends || form.origin == OffsetOrigin::start_axis;
  const bool from_end = form.origin == OffsetOrigin::ends || form.origin == OffsetOrigin::axis_end;
  for (int i = 1; i < form.degree; ++i) {
    const bool first_half = 2 * i <= form.degree;
    if (first_half && from_start) origins[static_cast<std::size_t>(i)] = start;
    if (!first_half && from_end) origins[static_cast<std::size_t>(i)] = end;
  }
  return {origins.begin() + 1, origins.end() - 1};
}

Eigen::VectorXd offsets_of(std::span<const Vec3> control, const OffsetForm& form, Hand hand,
                           std::optional<double> duration_s) {
  form.require_valid();
  if (control.size() != static_cast<std::size_t>(form.degree) + 1) {
    throw std::invalid_argument("control has " + std::to_string(control.size()) + " points, expected " +
                                std::to_string(form.degree + 1));
  }
  const double distance_m = glm::length(control.back() - control.front());
  if (form.scaling != OffsetScaling::none && distance_m < kMinimumReach_m) {
    throw std::invalid_argument("starts and ends " + std::to_string(distance_m) + " m apart, expected at least " +
                                std::to_string(kMinimumReach_m) + " m to scale by");
  }
  const double scale = offset_scale(form, distance_m, duration_s);
  const Points origins = offset_origins(form, control.front(), control.back());
  Eigen::VectorXd offsets(form.size());
  for (std::size_t i = 0; i < origins.size(); ++i) {
    offsets.segment<3>(3 * static_cast<Eigen::Index>(i)) =
        to_eigen(for_hand((control[i + 1] - origins[i]) / scale, hand));
  }
  return offsets;
}

Points control_of(const Eigen::VectorXd& offsets, const OffsetForm& form, const Vec3& start, const Vec3& end, Hand hand,
                  std::optional<double> duration_s) {
  const double scale = offset_scale(form, glm::length(end - start), duration_s);
  Points control = offset_origins(form, start, end);
  for (std::size_t i = 0; i < control.size(); ++i) {
    control[i] += scale * for_hand(to_glm(offsets.segment<3>(3 * static_cast<Eigen::Index>(i))), hand);
  }
  control.insert(control.begin(), start);
  control.push_back(end);
  return control;
}

}  // namespace reachcast
