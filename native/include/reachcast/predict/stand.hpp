// SPDX-License-Identifier: GPL-3.0-or-later
/// How a person stands who has nothing to do: where `reach` begins and `return` ends.
#pragma once

#include "reachcast/body/body.hpp"

namespace reachcast {

/// Upright on the feet, knees a little bent, arms hanging beside the thighs a little ahead, elbows nearly straight. All
/// segments have their lengths.
[[nodiscard]] Posture standing_at_ease(const Body& body);

}  // namespace reachcast
