// SPDX-License-Identifier: GPL-3.0-or-later
/// What weight asks of joints: moments about them, newton metres, statics only. Segment masses and centres: Winter,
/// Biomechanics and Motor Control (2009), table 4.1. A moment is given as a level vector towards where the weight lies.
#pragma once

#include "reachcast/posture/balance.hpp"

namespace reachcast {

inline constexpr double kGravity = 9.81;  ///< m/s^2

/// About L5/S1, of trunk, head and arms above it and of what is held. body_mass_kg > 0.
[[nodiscard]] Vec3 back_moment(const Posture& posture, double body_mass_kg, const Load& load);

/// About `joint`, of the left (0) or right (1) arm. body_mass_kg > 0.
[[nodiscard]] Vec3 arm_moment(const Posture& posture, std::size_t side, const Vec3& joint, double body_mass_kg);

}  // namespace reachcast
