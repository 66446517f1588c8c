// SPDX-License-Identifier: GPL-3.0-or-later
/// What the simulated people are asked to do: the experiment of Faraway (2004, p. 547) and of Faraway, Reed and Wang
/// (2007, section 2), and the same shelves filled from the floor.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reachcast/motion/reach.hpp"
#include "reachcast/simulate/person.hpp"

namespace reachcast::simulate {

inline constexpr std::size_t kTowers = 3;  ///< ahead, 45 degrees to the right, to the right
inline constexpr std::size_t kLevels = 5;  ///< from ankle to eye level
inline constexpr std::size_t kDepths = 2;  ///< near, far
inline constexpr std::size_t kTargets = kTowers * kLevels * kDepths;
inline constexpr std::size_t kReplicates = 2;

/// A place where a box stands, by where its handles are held.
struct BoxSpot {
  Vec3 hold{0.0};  ///< midway between the handles, body frame, metres
  double yaw_rad = 0.0;
};

/// One motion to be made.
struct Errand {
  Phase phase = Phase::transfer;
  BoxSpot home, target;
  double load_kg = 0.0;  ///< of the box
  std::string origin;
  std::uint64_t seed = 0;
};

/// The four phases with each target and replicate, the box's home ahead at the height of the waist (`paper`), then
/// transfers and retrieves between these targets and a home on the floor (`floor`), once each; targets lower than the
/// knee are left out there. Places are given in statures, so that everybody can do everything; a far target that the
/// arms would not reach stands nearer.
[[nodiscard]] std::vector<Errand> errands_of(const Person& person, std::size_t number, std::uint64_t seed);

}  // namespace reachcast::simulate
