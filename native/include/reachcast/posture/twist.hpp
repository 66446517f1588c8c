// SPDX-License-Identifier: GPL-3.0-or-later
/// A person who reaches to the side turns: the arms fully, the chest and the pelvis by a share, the feet not at all.
/// Coordinates are taken of the posture as it would face its hold point and the turn is put back when decoding, so that
/// what was learned ahead of the body serves to its sides (the 2004 paper, p. 551, expects no good prediction there).
#pragma once

#include <vector>

#include "reachcast/body/body.hpp"

namespace reachcast {

struct Anchors;

/// Turn about the vertical, radians, from facing forward (y) to facing the hold point, seen from a little behind
/// the ankles so that it is defined and steady for everything that hands can hold in front of the body.
[[nodiscard]] double facing_yaw(const Anchors& anchors);

/// The same anchors with the grips turned about the vertical line midway between the ankles.
[[nodiscard]] Anchors with_grips_turned(const Anchors& anchors, double yaw_rad);

/// The posture with its grips turned by `yaw_rad` about that line, the chest by four fifths of it, the pelvis by two, and
/// the limbs spanned again between their new ends with the coordinates they had. Twisting back undoes it. Every link
/// keeps its length; an arm that cannot span stops short of its grip.
[[nodiscard]] Posture twisted(const Posture& posture, double yaw_rad);

/// Coordinates of one of holding_limbs() in `posture`, its planes turned as twisted() turns them.
[[nodiscard]] std::vector<double> turned_limb_coordinates(std::size_t limb, const Posture& posture, double yaw_rad);

}  // namespace reachcast
