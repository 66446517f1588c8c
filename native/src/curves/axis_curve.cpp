// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/axis_curve.hpp"

#include <algorithm>

#include "reachcast/curves/bezier.hpp"
#include "reachcast/curves/hand_path.hpp"

namespace reachcast {
namespace {

double at_rest(double exponent) {
  return std::clamp(exponent, kLeastExponent, kMostExponent);
}

}  // namespace

AxisCurve fit_axis_curve(std::span<const Vec3> points) {
  if (points.size() < 4) {
    throw std::invalid_argument("points holds " + std::to_string(points.size()) + " points; a path needs at least 4");
  }
  const SpeedProfile speed = fit_speed_profile(points, {});
  const Points control = fit_bezier(points);
  return curve_through({control[0], control[1], control[2], control[3]}, {at_rest(speed.alpha), at_rest(speed.beta)});
}

AxisCurve published_axis_curve(double distance_m) {
  static const HandPathModel model = HandPathModel::published();
  static const Points offsets = model.offsets();
  AxisCurve curve;
  for (std::size_t i = 0; i < 2; ++i) curve.offsets[i] = distance_m * Vec3(0.0, offsets[i].y, offsets[i].z);
  curve.speed = model.speed();
  return curve;
}

AxisCurve carried(const AxisCurve& curve, const Vec3& from, const Vec3& to) {
  const double was = glm::length(from), is = glm::length(to);
  AxisCurve out{{Vec3(0.0), Vec3(0.0)}, curve.speed};
  if (was < 1e-9 || is < 1e-9) return out;
  const Quat turn = smallest_rotation(from, to);
  for (std::size_t i = 0; i < 2; ++i) out.offsets[i] = is / was * (turn * curve.offsets[i]);
  return out;
}

std::array<Vec3, 4> control_between(const AxisCurve& curve, const Vec3& start, const Vec3& end) {
  return {start, start + (end - start) / 3.0 + curve.offsets[0], start + 2.0 / 3.0 * (end - start) + curve.offsets[1],
          end};
}

AxisCurve curve_through(const std::array<Vec3, 4>& control, const SpeedProfile& speed) {
  const Vec3 axis = control[3] - control[0];
  return {{control[1] - control[0] - axis / 3.0, control[2] - control[0] - 2.0 / 3.0 * axis}, speed};
}

double progress(const AxisCurve& curve, double t) {
  if (t <= 0.0) return 0.0;
  return t >= 1.0 ? 1.0 : curve.speed.progress(t);
}

Vec3 point_on(const AxisCurve& curve, const Vec3& start, const Vec3& end, double progress) {
  if (progress <= 0.0) return start;
  if (progress >= 1.0) return end;
  // The axis points lie evenly on the axis, so that the curve is the axis plus the curve of the offsets.
  const double s = progress, r = 1.0 - progress;
  return start + s * (end - start) + 3.0 * s * r * (r * curve.offsets[0] + s * curve.offsets[1]);
}

}  // namespace reachcast
