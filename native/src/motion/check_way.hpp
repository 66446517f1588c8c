// SPDX-License-Identifier: GPL-3.0-or-later
/// Whether a way of the hands can be learned from, and which part of it. Private to motion/.
#pragma once

#include <string>

#include "movements.hpp"

namespace reachcast {

/// What is looked at; all of the same recording.
struct Tracked {
  const Clip& clip;
  const HandTracks& hands;
  const Points* object;        ///< bridged; null: none
  const Points* object_as_is;  ///< with what is missing; null: none
  const std::vector<TrackingFault>& faults;
};

/// The frames around `anchor`, within a range, in which neither foot has moved from its place at the anchor; `moved`
/// names the foot that ends them.
struct Standing {
  FrameRange frames;
  std::string moved;  ///< empty: both feet stand throughout
};
[[nodiscard]] Standing standing_about(const Clip& clip, std::size_t anchor, const FrameRange& within,
                                      const FindOptions& options);

/// Why the range is no phase; empty when it is one. Feet are not looked at.
[[nodiscard]] std::string why_not(const Tracked& recorded, const FrameRange& range, Phase phase,
                                  const FindOptions& options);

/// "0.31": two digits for messages.
[[nodiscard]] std::string two_digits(double value);

}  // namespace reachcast
