// SPDX-License-Identifier: GPL-3.0-or-later
/// What the body does over a stage, as curves: posture coordinates and, where one hand works, how the other arm hangs.
#pragma once

#include "reachcast/motion/encode.hpp"
#include "reachcast/posture/free_arm.hpp"

namespace reachcast {

/// posture_curves(code); for one hand three rows more, of relative_hang.
[[nodiscard]] PostureCurves body_curves(const MotionCode& code);

/// The same values of a posture.
[[nodiscard]] Eigen::VectorXd body_coordinates(const Posture& posture, Hands hands);

/// How many of them are posture coordinates.
[[nodiscard]] inline Eigen::Index posture_rows() {
  return posture_coordinate_count(two_handed_linkage());
}

}  // namespace reachcast
