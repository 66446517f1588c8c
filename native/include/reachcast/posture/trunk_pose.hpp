// SPDX-License-Identifier: GPL-3.0-or-later
/// A decoded posture as numbers that can be averaged over time and still give every segment its length: where l5s1 is,
/// how pelvis and chest are turned, and directions.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "reachcast/posture/whole_body.hpp"

namespace reachcast {

struct TrunkPose {
  Vec3 waist{0.0};                       ///< l5s1, body frame, metres
  std::array<Quat, kPartCount> parts{};  ///< turn of each of Linkage::parts against the body's stand, bent alike
  std::array<Vec3, 4> pointers{};  ///< Linkage::pointers that hang on the chest, in its upper end's frame; unit length
  std::array<LimbPlane, kLimbCount> planes;
  std::array<Vec3, 2> wrist_from_grip{};
  double bend_rad = 0.0;  ///< of the back (spine.hpp)
};

/// Poses as vectors, for weighted sums: zero, and a pose added to a sum. A turn counts as that of its two quaternions
/// which is nearer to what the sum has already; decoded_of makes sums whole again.
[[nodiscard]] TrunkPose no_pose();
void add(const TrunkPose& pose, double weight, TrunkPose& sum);
/// What `pose` lacks of `wanted`, and a share of such a lack made good.
[[nodiscard]] TrunkPose lack_of(const TrunkPose& pose, const TrunkPose& wanted);
void make_good(const TrunkPose& lack, double share, TrunkPose& pose);

[[nodiscard]] TrunkPose trunk_pose_of(const Linkage& linkage, const Body& body, const Decoded& decoded);

/// The inverse. Directions and turns are normalised first.
[[nodiscard]] Decoded decoded_of(const Linkage& linkage, const Body& body, const TrunkPose& pose);

/// Decoded postures at evenly spaced moments as the control points of a uniform cubic B-spline: position, velocity and
/// acceleration are continuous. Stretch-pivot coordinates alone do not give that: the bounds of a stretch (DESIGN: 2004
/// paper, Appendix) change their formulas as the hands come nearer, and the trunk's speed jumps where they do.
class TrunkTrack {
 public:
  /// At least 2 moments, the first at time 0; spacing_s > 0. References must outlive the track.
  TrunkTrack(const Linkage& linkage, const Body& body, std::span<const Decoded> moments, double spacing_s);

  /// time_s is clamped to the track's ends.
  [[nodiscard]] Decoded at(double time_s) const;

 private:
  const Linkage& linkage_;
  const Body& body_;
  std::vector<TrunkPose> poses_;
  double spacing_s_;
};

/// Weights of the control points i - 1 to i + 2 of a uniform cubic B-spline at i + t, t in [0, 1].
[[nodiscard]] std::array<double, 4> cubic_weights(double t);

}  // namespace reachcast
