// SPDX-License-Identifier: GPL-3.0-or-later
/// The other mean of neighbours: each is decoded on this body, between these hands and feet, and what comes out is
/// averaged: place and turn of pelvis and chest, directions, planes of limbs. The 2004 paper averages stretch-pivot
/// coordinates before decoding; both means keep every segment's length. Cross-validation chooses (Scheme::postures).
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "reachcast/posture/trunk_pose.hpp"
#include "reachcast/predict/blend.hpp"

namespace reachcast {

class PoseMean {
 public:
  /// `blend` must outlive the mean.
  explicit PoseMean(const Blend& blend) : parts_(&blend.parts) {}

  /// False where the coordinates themselves were averaged.
  [[nodiscard]] bool exists() const { return !parts_->empty(); }

  /// At scaled time t. `exists()` is required.
  [[nodiscard]] TrunkPose at(double t, const Anchors& anchors, const Linkage& linkage, const BodyLinkage& body_linkage,
                             const Body& body) const;

  /// Makes the mean begin and end with these poses, by a correction that fades from either end to the other.
  void meet(const TrunkPose& first_lacks, const TrunkPose& last_lacks);

 private:
  const std::vector<PosturePart>* parts_;
  std::optional<std::array<TrunkPose, 2>> lacks_;
};

}  // namespace reachcast
