// SPDX-License-Identifier: GPL-3.0-or-later
/// A body that goes smoothly along with its hands through postures that were each found alone.
#pragma once

#include <Eigen/Core>
#include <span>

#include "reachcast/body/body.hpp"
#include "reachcast/posture/trunk_pose.hpp"

namespace reachcast::simulate {

/// Polynomials of degree kTrackDegree, by least squares, of what a TrunkPose holds: places, turns and directions. (The
/// logits of stretches are no numbers to be smoothed: near a straight limb they run away.) The ends count more than the
/// moments between.
class BodyTrack {
 public:
  static constexpr int kDegree = 4;

  /// Moments at evenly spaced shares of the hands' path, more than kDegree of them. `body` must outlive the track.
  BodyTrack(const Body& body, std::span<const Decoded> moments);

  /// share in [0, 1]
  [[nodiscard]] Decoded at(double share) const;

 private:
  const Body& body_;
  Eigen::MatrixXd coefficients_;  ///< a row per polynomial, a column per number of a pose
};

}  // namespace reachcast::simulate
