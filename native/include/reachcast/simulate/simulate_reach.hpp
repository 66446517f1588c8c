// SPDX-License-Identifier: GPL-3.0-or-later
/// One motion of one person: hands by published figures, the body by least effort.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "reachcast/motion/motion_code.hpp"
#include "reachcast/simulate/experiment.hpp"

namespace reachcast::simulate {

inline constexpr std::size_t kMoments = 10;  ///< shares of the path at which least effort is sought
inline constexpr std::size_t kFrames = 25;

struct Simulated {
  Reach reach;
  double held_m = 0.0;        ///< how far the trunk had to be moved for the hands to hold on
  double unbalanced_m = 0.0;  ///< how far the weight lies beyond the feet
  double shortfall_m = 0.0;   ///< > 0: somewhere the hands could not be held; the motion is of no use
};

/// Deterministic. The reach is in the body frame; its hands, feet and segment lengths are exact at all frames.
[[nodiscard]] Simulated simulate_reach(const Person& person, const Errand& errand);

struct CorpusCounts {
  std::size_t simulated = 0;  ///< motions that are added, without mirror images
  std::size_t left_out = 0;   ///< motions somewhere out of reach
};

/// Every motion of the experiment, each followed by its mirror image, in the order of people and errands whatever the
/// number of threads. `only`: numbers of people; empty for all. Codes are handed over person by person.
CorpusCounts simulate_all(std::uint64_t seed, unsigned threads, const std::vector<std::size_t>& only,
                          const std::function<void(std::vector<MotionCode>)>& take);

}  // namespace reachcast::simulate
