// SPDX-License-Identifier: GPL-3.0-or-later
/// The body as capsules, and how deep one lies in another or in a box.
#pragma once

#include <array>
#include <string_view>

#include "reachcast/body/body.hpp"

namespace reachcast {

/// All points within `radius_m` of the line from `a` to `b`.
struct Capsule {
  Vec3 a{0.0}, b{0.0};
  double radius_m = 0.0;
};

/// A box that is turned anyhow. Columns of `axes` are its own axes, of unit length; `half` is half its size along them.
struct OrientedBox {
  Vec3 centre{0.0}, half{0.0};
  Mat3 axes{1.0};
};

/// Pelvis, waist and chest make up the trunk; waist and chest are two capsules each, side by side, since people are
/// wider than deep.
enum class BodyPart : std::size_t {
  pelvis,
  waist_left,
  waist_right,
  chest_left,
  chest_right,
  neck,
  head,
  left_thigh,
  right_thigh,
  left_shank,
  right_shank,
  left_upper_arm,
  right_upper_arm,
  left_forearm,
  right_forearm,
  left_hand,
  right_hand,
};
inline constexpr std::size_t kBodyPartCount = 17;
[[nodiscard]] constexpr std::size_t index(BodyPart part) {
  return static_cast<std::size_t>(part);
}
/// As people say it: "trunk", "head", "left thigh", ...
[[nodiscard]] std::string_view body_part_name(BodyPart part);

using BodyCapsules = std::array<Capsule, kBodyPartCount>;  ///< indexed by index(BodyPart)

/// Radii are shares of stature from published girths and depths, see capsules.cpp.
[[nodiscard]] BodyCapsules capsules_of(const Posture& posture, double stature_m);

/// How deep something lies in a capsule: moved by depth_m along `direction` it just touches, and no shorter way does
/// that. Negative: so far apart.
struct Penetration {
  double depth_m = 0.0;
  Vec3 direction{0.0};  ///< unit length; which way the first leaves the second
};
[[nodiscard]] Penetration penetration(const Capsule& first, const Capsule& second);
[[nodiscard]] Penetration penetration(const OrientedBox& first, const Capsule& second);

/// How far the first must go along `direction`, of unit length, until it no longer meets the second; 0 when it does not
/// meet it. To within 0.1 mm, never too short; at most 2 m are looked at.
[[nodiscard]] double way_out(const Capsule& first, const Capsule& second, const Vec3& direction);
[[nodiscard]] double way_out(const OrientedBox& first, const Capsule& second, const Vec3& direction);

/// Whether spheres round both lie further apart than `margin_m`: then the shapes do.
[[nodiscard]] bool are_far(const Capsule& first, const Capsule& second, double margin_m = 0.0);
[[nodiscard]] bool are_far(const OrientedBox& first, const Capsule& second, double margin_m = 0.0);

}  // namespace reachcast
