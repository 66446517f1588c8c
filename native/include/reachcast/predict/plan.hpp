// SPDX-License-Identifier: GPL-3.0-or-later
/// Which phases follow one another, and when: the timetable of a performance.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "reachcast/motion/reach.hpp"

namespace reachcast {

/// A named frame: "grasp" (the hands close on the object), "lift_off", "placed", "release" (they open), "end". From
/// its second time on a name has a number: "grasp_2".
struct Event {
  std::string name;
  std::size_t frame = 0;
};

enum class Place { home, target };
[[nodiscard]] Place other(Place place);

/// One phase of a performance. Times are frames, from the beginning of the performance, with fractions.
struct Stage {
  Phase phase = Phase::transfer;
  Place object = Place::home;       ///< where the object stands when the stage begins
  std::size_t first = 0, last = 0;  ///< the hands move
  /// The body moves: it gathers way while the hands still grip and settles while they let go, so that it neither starts
  /// nor stops with a jerk. The stages of a performance follow each other without a gap.
  double body_first = 0.0, body_last = 0.0;
};

struct Plan {
  std::vector<Stage> stages;
  std::vector<Event> events;  ///< in the order of time
  std::size_t end = 0;        ///< last frame

  [[nodiscard]] std::optional<std::size_t> frame_of(std::string_view event) const;
};

/// Where the object stands when such a sequence begins: where its first loaded phase takes it from; at the target when
/// none is loaded. Throws std::invalid_argument when the sequence is empty or cannot be performed: the object must be
/// where a phase takes it from, and the hands where the phase before has left them.
[[nodiscard]] Place first_place(std::span<const Phase> phases);

/// Hands move for `seconds` each (as many as phases), at least 4 frames, and pause between: to grip and to let go, and
/// a little at rest.
[[nodiscard]] Plan plan_phases(std::span<const Phase> phases, std::span<const double> seconds, double frame_rate);

/// 0 before `first`, 1 after `last`, from rest to rest.
[[nodiscard]] double eased(double first, double last, double moment);

/// Scaled time of the stage's posture: constant speed between a ramp from rest and a ramp to rest.
[[nodiscard]] double posture_time(const Stage& stage, double moment);

/// Share of the object's weight that the hands carry: they take it between grasp and lift-off and give it up between
/// placed and release.
[[nodiscard]] double load_share(const Plan& plan, double frame_rate, double moment);

}  // namespace reachcast
