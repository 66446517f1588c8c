// SPDX-License-Identifier: GPL-3.0-or-later
/// Whether a recording is of both hands at work or of one. Private to motion/.
#pragma once

#include "movements.hpp"

namespace reachcast {

/// One hand where the other hangs at its side whenever there is work: while the object moves, and the working hand
/// keeps its place on it, or, without an object (null), from the first frame to the last. Both otherwise. A recording
/// in which the hands take turns counts as one of both. `both`: hand_tracks(clip).
[[nodiscard]] Hands working_hands(const HandTracks& both, const Clip& clip, const Points* object,
                                  const FindOptions& options);

}  // namespace reachcast
