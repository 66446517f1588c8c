// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/stage_way.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "reachcast/motion/encode.hpp"

namespace reachcast {
namespace {

constexpr double kFarthest_m = 3.0;
constexpr double kShortestArm_m = 0.12, kLongestArm_m = 0.4;  // of the last control point, from the end

Vec3 direction_of(Approach approach, const Vec3& start, const Vec3& end, const Vec3& towards_person) {
  if (approach == Approach::above) return {0, 0, 1};
  if (approach == Approach::front) return towards_person;
  const Vec3 right = glm::cross(towards_person, Vec3(0, 0, 1));
  const double begins = glm::dot(start - end, right);
  return begins < -1e-6 ? -right : right;
}

}  // namespace

std::string_view form_name(WayForm form) {
  constexpr std::array<std::string_view, 4> names{"deviation", "bezier", "published", "given"};
  return names[static_cast<std::size_t>(form)];
}

StageWay learned_way(const Blend& blend, PathForm form) {
  return {form == PathForm::deviation ? WayForm::deviation : WayForm::bezier, way_of(blend.whole, form), {}};
}

StageWay published_way(const Vec3& start, const Vec3& end) {
  return {WayForm::published, published_axis_curve(glm::distance(start, end)), {}};
}

StageWay given_way(const Blend& blend, const InnerPoints& inner, const Vec3& start, const Vec3& end) {
  for (std::size_t i = 0; i < inner.size(); ++i) {
    const double away = std::min(glm::distance(inner[i], start), glm::distance(inner[i], end));
    if (away <= kFarthest_m) continue;  // nor is this true of what is not finite
    std::ostringstream out;
    out << "hand path: inner control point " << i + 1 << " is (" << inner[i].x << ", " << inner[i].y << ", "
        << inner[i].z << ") m; it must be finite and within " << kFarthest_m << " m of an end of the path";
    throw std::invalid_argument(out.str());
  }
  return {WayForm::given, curve_through({start, inner[0], inner[1], end}, curve_of(blend.whole).speed), {}};
}

StageWay approaching(const Blend& blend, Approach approach, const Vec3& start, const Vec3& end,
                     const Vec3& towards_person) {
  const AxisCurve learned = curve_of(blend.whole);
  const Vec3 from = direction_of(approach, start, end, towards_person);
  const double arm = std::clamp(0.5 * glm::distance(start, end), kShortestArm_m, kLongestArm_m);
  std::array<Vec3, 4> control = control_between(learned, start, end);
  control[2] = end + arm * from;
  return {WayForm::bezier, curve_through(control, learned.speed), from};
}

Vec3 level_direction(const Vec3& from, const Vec3& to) {
  const Vec3 level(to.x - from.x, to.y - from.y, 0.0);
  return glm::length(level) > 1e-6 ? glm::normalize(level) : Vec3(0, -1, 0);
}

}  // namespace reachcast
