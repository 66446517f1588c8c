// SPDX-License-Identifier: GPL-3.0-or-later
/// What a foot or the pelvis does during a reach: it stays, or it goes once along an endpoint path.
#pragma once

#include <array>

#include "reachcast/curves/axis_curve.hpp"
#include "reachcast/curves/endpoint_path.hpp"
#include "reachcast/motion/motion_code.hpp"

namespace reachcast {

/// What ends nearer than this to where it began stays: recorded ankles of standing feet wander by less.
inline constexpr double kLeastMove_m = 0.03;

/// All zero for what stays.
struct EndpointMove {
  Vec3 displacement{0.0};  ///< from start to end, body frame, in statures
  EndpointPath path{decltype(EndpointPath::velocity)::Zero(), decltype(EndpointPath::deviation)::Zero()};
  AxisCurve curve{{Vec3(0.0), Vec3(0.0)}, {0.0, 0.0}};  ///< the same path as a Bezier curve

  [[nodiscard]] bool stays() const { return displacement == Vec3(0.0); }
};

/// Of the left and the right ankle.
[[nodiscard]] std::array<EndpointMove, 2> foot_moves_of(const Reach& reach);
[[nodiscard]] std::array<EndpointMove, 2> foot_moves_of(const MotionCode& code);
void set_foot_moves(MotionCode& code, const std::array<EndpointMove, 2>& moves);

/// Of l5s1.
[[nodiscard]] EndpointMove pelvis_move_of(const Reach& reach);
[[nodiscard]] EndpointMove pelvis_move_of(const MotionCode& code);
void set_pelvis_move(MotionCode& code, const EndpointMove& move);

/// The same move backwards.
[[nodiscard]] EndpointMove reversed(const EndpointMove& move);

}  // namespace reachcast
