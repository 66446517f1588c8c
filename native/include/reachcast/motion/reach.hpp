// SPDX-License-Identifier: GPL-3.0-or-later
/// One labelled phase of one person's motion, in the body frame, in the canonical joints.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "reachcast/body/body.hpp"
#include "reachcast/body/joints.hpp"
#include "reachcast/body/subject.hpp"
#include "reachcast/conventions.hpp"

namespace reachcast {

/// The four phases of the box experiment (2004 paper, p. 547).
enum class Phase {
  transfer,  ///< loaded, home to shelf
  return_,   ///< hands empty, back to rest ("return" in Python and in the corpus)
  reach,     ///< hands empty, to the box
  retrieve,  ///< loaded, shelf to home
};
inline constexpr std::size_t kPhaseCount = 4;
/// Whether the object is in the hands: transfer and retrieve.
[[nodiscard]] bool is_loaded(Phase phase);
/// What the phase is when it is played backwards: transfer and retrieve, reach and return.
[[nodiscard]] Phase opposite(Phase phase);
[[nodiscard]] std::string_view phase_name(Phase phase);
[[nodiscard]] std::optional<Phase> find_phase(std::string_view name);

/// Which hands work: hold the object, come for it or leave it. The other hand, if any, is free.
enum class Hands { both, left, right };
[[nodiscard]] std::string_view hands_name(Hands hands);  ///< "both", "left" or "right"
[[nodiscard]] std::optional<Hands> find_hands(std::string_view name);
/// Those of the mirror image.
[[nodiscard]] Hands mirrored(Hands hands);

struct Reach {
  Subject subject;
  Phase phase = Phase::transfer;
  Hands hands = Hands::both;
  std::string origin;                       ///< file and frames, e.g. "omomo/sub8_largebox_025.csv:22-50"
  double duration_s = 0.0;                  ///< > 0, first to last posture
  std::vector<Posture> postures;            ///< body frame, evenly spaced in time, at least 4
  std::array<bool, kJointCount> derived{};  ///< joints that the recording lacked

  [[nodiscard]] std::size_t frames() const { return postures.size(); }
  /// Midpoint of the two grips at a frame: where the object is held.
  [[nodiscard]] Vec3 hold_point(std::size_t frame) const;
};

/// The same motion performed by the mirror image of the person: x changes sign, left and right change names.
[[nodiscard]] Reach mirrored(const Reach& reach);

/// What is added to the origin of a motion that is played backwards.
inline constexpr const char* kBackwards = " (backwards)";

/// The same motion played backwards, of the opposite phase. The origin says so.
[[nodiscard]] Reach reversed(const Reach& reach);

}  // namespace reachcast
