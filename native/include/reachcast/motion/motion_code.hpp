// SPDX-License-Identifier: GPL-3.0-or-later
/// A reach as numbers that can be averaged: spline coefficients of stretch-pivot coordinates and endpoint paths.
#pragma once

#include <Eigen/Core>
#include <string>

#include "reachcast/motion/reach.hpp"

namespace reachcast {

/// What the corpus keeps of one reach. Any weighted mean of `coefficients` decodes to a valid body (DESIGN: 2004 paper,
/// sections 2 and 3); `home` and `target` are the hold points (midpoint of the grips) at start and end, body frame.
struct MotionCode {
  Subject subject;
  Phase phase = Phase::transfer;
  Hands hands = Hands::both;
  std::string origin;
  bool is_mirrored = false;  ///< the mirror image of the reach named by `origin`
  double duration_s = 0.0;
  Vec3 home{0.0};
  Vec3 target{0.0};
  double grip_distance_m = 0.0;  ///< between the grips at the start
  Eigen::VectorXd coefficients;  ///< length code_length(), layout in encode.cpp
};

}  // namespace reachcast
