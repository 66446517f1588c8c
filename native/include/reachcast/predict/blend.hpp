// SPDX-License-Identifier: GPL-3.0-or-later
/// The neighbours' codes as one (Faraway 2004, section 3.4).
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "reachcast/motion/motion_code.hpp"
#include "reachcast/predict/neighbours.hpp"

namespace reachcast {

/// What the neighbours do where the motion begins and where it ends. The posture passes from the one to the other.
struct Blend {
  MotionCode from, to;                ///< means over the neighbours of the home and of the target
  MotionCode whole;                   ///< mean over all of them: path of the hold point and duration
  std::vector<Neighbour> neighbours;  ///< both sets; a motion of both has the mean of its two weights; heaviest first
};

/// Finds a motion's code by its id.
using CodeOf = std::function<std::shared_ptr<const MotionCode>(std::int64_t)>;

/// Paths are carried onto the wanted axis before they are averaged. Throws std::invalid_argument for k < 1, no motion
/// of the phase, or codes of another length than this version's.
[[nodiscard]] Blend blend_neighbours(const MotionTable& table, const Query& query, int k, const CodeOf& code_of,
                                     const LeftOut& left_out = {});

/// Posture coordinates at scaled time t in [0, 1].
[[nodiscard]] Eigen::VectorXd coordinates_at(const Blend& blend, double t);

}  // namespace reachcast
