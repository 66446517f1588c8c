// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/path_around.hpp"

#include <algorithm>
#include <cmath>

namespace reachcast {
namespace {

constexpr double kSharpest = 4.0;  // power of time by which the level way can lag
constexpr int kTimes = 32;

/// t^4 (1 - t)^2, scaled to a peak of 1 at t = 2/3: near an end, zero in value and slope at both.
double late_bump(double t) {
  return t * t * t * t * (1.0 - t) * (1.0 - t) * 45.5625;
}

double cost(const PathShape& shape) {
  return 0.15 * std::abs(shape.lead) + shape.rise_m + 0.8 * shape.retreat_m;
}

std::vector<PathShape> all_shapes() {
  std::vector<PathShape> shapes;
  for (const double lead : {0.0, 0.25, -0.25, 0.5, -0.5, 0.75, -0.75, 1.0, -1.0}) {
    for (const double rise : {0.0, 0.02, 0.05, 0.1, 0.15}) {
      for (const double retreat : {0.0, 0.05, 0.1, 0.15, 0.2, 0.3}) shapes.push_back({lead, rise, retreat});
    }
  }
  std::stable_sort(shapes.begin(), shapes.end(), [](const auto& a, const auto& b) { return cost(a) < cost(b); });
  return shapes;
}

}  // namespace

Vec3 shaped_point_at(const EndpointPath& path, const Vec3& start, const Vec3& end, const PathShape& shape,
                     const Vec3& towards_person, double t) {
  if (shape.is_straight()) return point_at(path, start, end, t);
  const double clamped = std::clamp(t, 0.0, 1.0), power = 1.0 + (kSharpest - 1.0) * std::abs(shape.lead);
  const double early = 1.0 - std::pow(1.0 - clamped, power), late = std::pow(clamped, power);
  const Vec3 level = point_at(path, start, end, shape.lead >= 0.0 ? late : early);
  const Vec3 height = point_at(path, start, end, shape.lead >= 0.0 ? early : late);
  const double middle = 16.0 * clamped * clamped * (1.0 - clamped) * (1.0 - clamped);
  const double rise = shape.rise_m * (late_bump(clamped) + late_bump(1.0 - clamped));
  return Vec3(level.x, level.y, height.z + rise) + shape.retreat_m * middle * towards_person;
}

const std::vector<PathShape>& path_shapes() {
  static const std::vector<PathShape> shapes = all_shapes();
  return shapes;
}

std::vector<CurveBend> curve_bends(const Vec3& towards_person, const std::optional<Vec3>& approach) {
  std::vector<Vec3> free, along;
  for (const double up : {0.0, 0.1, 0.25, 0.5}) {
    for (const double back : {0.0, 0.15, 0.3, 0.5}) free.push_back(Vec3(0, 0, up) + back * towards_person);
  }
  for (const double further : {0.0, 0.1, 0.2, 0.3}) along.push_back(further * approach.value_or(Vec3(0.0)));
  std::vector<CurveBend> bends;
  for (const Vec3& first : free) {
    for (const Vec3& second : approach ? along : free) bends.push_back({first, second});
  }
  const auto moved = [](const CurveBend& bend) { return glm::length(bend[0]) + glm::length(bend[1]); };
  std::stable_sort(bends.begin(), bends.end(), [&](const auto& a, const auto& b) { return moved(a) < moved(b); });
  return bends;
}

double bend_of(const std::function<Vec3(double)>& bent, const std::function<Vec3(double)>& learned) {
  std::vector<Vec3> line;
  for (int k = 0; k <= 2 * kTimes; ++k) line.push_back(learned(0.5 * k / kTimes));
  double most = 0.0;
  for (int i = 1; i < kTimes; ++i) {
    const Vec3 at = bent(static_cast<double>(i) / kTimes);
    double nearest = glm::distance(at, line.front());
    for (const Vec3& point : line) nearest = std::min(nearest, glm::distance(at, point));
    most = std::max(most, nearest);
  }
  return most;
}

}  // namespace reachcast
