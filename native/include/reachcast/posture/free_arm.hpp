// SPDX-License-Identifier: GPL-3.0-or-later
/// The arm that has nothing to do while the other hand works: where it hangs from its own shoulder.
#pragma once

#include "reachcast/posture/whole_body.hpp"

namespace reachcast {

/// From the free shoulder to its grip, as seen by a person who faces the hold point (twist.hpp), in lengths of the
/// stretched arm up to the grip: an arm that hangs nearly straight does so on every body.
[[nodiscard]] Vec3 relative_hang(const Posture& posture, Hands hands);

/// The inverse, metres, for anchors whose working grip is known: what Anchors::hang is to be on this body.
[[nodiscard]] Vec3 hang_on(const Body& body, const Anchors& anchors, const Vec3& relative);

}  // namespace reachcast
