// SPDX-License-Identifier: GPL-3.0-or-later
/// The chest as it would be with a straight back: what a bend (spine.hpp) did to it undone. Seen so, the chest is
/// rigid, and its triangle shows how it is turned however far its sternum has come down to the line from l5s1 to c7t1.
#pragma once

#include "reachcast/body/spine.hpp"

namespace reachcast {

/// Only c7t1, suprasternale and clavicle roots move: away from l5s1 to the length of the arc, and turned back about the
/// sideways axis of the chest. That axis stands across the plane of l5s1, c7t1 and the sternum; where these lie on one
/// line, it goes from the left shoulder to the right one.
[[nodiscard]] Posture straight_chest(const Posture& posture, double bend_rad);

}  // namespace reachcast
