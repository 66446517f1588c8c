// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/endpoint_way.hpp"

namespace reachcast {

double progress(const EndpointWay& way, double t) {
  return std::visit([&](const auto& any) { return progress(any, t); }, way);
}

Vec3 point_at(const EndpointWay& way, const Vec3& start, const Vec3& end, double t) {
  return point_at(way, start, end, t, progress(way, t));
}

Vec3 point_at(const EndpointWay& way, const Vec3& start, const Vec3& end, double t, double progress) {
  if (const auto* path = std::get_if<EndpointPath>(&way)) return point_at(*path, start, end, t, progress);
  return point_on(std::get<AxisCurve>(way), start, end, progress);
}

}  // namespace reachcast
