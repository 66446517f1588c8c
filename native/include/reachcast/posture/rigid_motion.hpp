// SPDX-License-Identifier: GPL-3.0-or-later
/// Turns as vectors, and how a rigid body goes that is pulled at four corners.
#pragma once

#include <array>

#include "reachcast/conventions.hpp"

namespace reachcast {

/// Four points of one rigid body, or where they are wanted.
using Corners = std::array<Vec3, 4>;

/// Axis times angle, at most pi long.
[[nodiscard]] Vec3 rotation_vector(const Quat& turn);
/// The inverse: the turn about `vector` by its length, radians.
[[nodiscard]] Quat rotation_by(const Vec3& vector);

/// A quarter of a turn, the shorter way round.
[[nodiscard]] Quat quarter_of(const Quat& turn);

/// The turn of the rigid motion that brings `from` nearest to `to` in the least-squares sense; it takes the mean of
/// `from` to the mean of `to`. Horn, Closed-form solution of absolute orientation using unit quaternions (1987). Where
/// several turns are equally near (all corners on one line), one of them.
[[nodiscard]] Quat nearest_turn(const Corners& from, const Corners& to);

}  // namespace reachcast
