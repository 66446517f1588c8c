// SPDX-License-Identifier: GPL-3.0-or-later
/// Both representations of where an endpoint goes, behind one interface (DESIGN 3.3).
#pragma once

#include <variant>

#include "reachcast/curves/axis_curve.hpp"
#include "reachcast/curves/endpoint_path.hpp"

namespace reachcast {

using EndpointWay = std::variant<EndpointPath, AxisCurve>;

/// Share of the way covered at scaled time t: 0 at 0, 1 at 1.
[[nodiscard]] double progress(const EndpointWay& way, double t);

/// Point at scaled time t; exactly `start` at 0 and `end` at 1.
[[nodiscard]] Vec3 point_at(const EndpointWay& way, const Vec3& start, const Vec3& end, double t);
/// The same where progress(way, t) is known.
[[nodiscard]] Vec3 point_at(const EndpointWay& way, const Vec3& start, const Vec3& end, double t, double progress);

}  // namespace reachcast
