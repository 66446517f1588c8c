// SPDX-License-Identifier: GPL-3.0-or-later
/// Rotations over time as the numbers a bone is keyed with, without jumps from frame to frame.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "reachcast/conventions.hpp"

namespace reachcast {

/// Blender's rotation modes. Euler "XYZ" turns about x first.
enum class RotationMode { quaternion, axis_angle, xyz, xzy, yxz, yzx, zxy, zyx };

/// From Blender's name: QUATERNION, AXIS_ANGLE, XYZ, XZY, YXZ, YZX, ZXY or ZYX; else std::invalid_argument.
[[nodiscard]] RotationMode rotation_mode(std::string_view name);

/// Numbers per frame: 4 for quaternions (w, x, y, z) and axis-angle (angle, then the unit axis), else 3 (about x, y,
/// z).
[[nodiscard]] std::size_t value_count(RotationMode mode);

/// The unit quaternion with w >= 0, from the largest of its four squares (no cancellation).
[[nodiscard]] Quat quaternion_of(const Mat3& rotation);

/// value_count numbers per frame. Radians.
/// Quaternions: each with the sign nearest to the one before, the first with w >= 0.
/// Axis and angle: the axis never flips and the angle never jumps by a turn; without a rotation the axis stays, at
/// first (0, 1, 0).
/// Euler angles: of the two triples that give a rotation the one nearest to the frame before, plus whole turns. At the
/// gimbal, where only the sum of the outer two is defined, the first keeps its value.
[[nodiscard]] std::vector<double> rotation_values(std::span<const Mat3> rotations, RotationMode mode);

}  // namespace reachcast
