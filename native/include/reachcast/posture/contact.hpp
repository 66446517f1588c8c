// SPDX-License-Identifier: GPL-3.0-or-later
/// Which hand, forearm or box is in the body, and how deep.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "reachcast/posture/capsules.hpp"

namespace reachcast {

/// What moves about and shall not go through the body.
enum class Mover : std::size_t { left_forearm, right_forearm, left_hand, right_hand, box };
inline constexpr std::size_t kMoverCount = 5;
[[nodiscard]] constexpr std::size_t index(Mover mover) {
  return static_cast<std::size_t>(mover);
}
[[nodiscard]] std::string_view mover_name(Mover mover);  ///< "left forearm", ..., "box"
[[nodiscard]] inline bool is_forearm(Mover mover) {
  return mover == Mover::left_forearm || mover == Mover::right_forearm;
}

/// Trunk, neck, head, thighs and shanks: what forearms, hands and box are looked at against. Upper arms, which belong
/// to all of them, are no part of it; neither are feet.
inline constexpr std::size_t kFirstArm = index(BodyPart::left_upper_arm);

struct Contact {
  Mover mover = Mover::box;
  BodyPart part = BodyPart::pelvis;
  double depth_m = 0.0;
  Vec3 direction{0.0};  ///< unit length, body frame: which way the mover leaves the part
};

/// All that lie deeper than `least_depth_m`.
[[nodiscard]] std::vector<Contact> contacts_of(const BodyCapsules& body, const OrientedBox& box,
                                               double least_depth_m = 0.0);
/// Those of one mover that is a capsule.
void add_contacts(Mover mover, const Capsule& capsule, const BodyCapsules& body, double least_depth_m,
                  std::vector<Contact>& contacts);
[[nodiscard]] const Capsule& capsule_of(Mover mover, const BodyCapsules& body);  ///< not of the box

/// How deep each mover is in the body; 0 where it is not.
using Depths = std::array<double, kMoverCount>;
[[nodiscard]] Depths depths_of(const BodyCapsules& body, const OrientedBox& box);

}  // namespace reachcast
