// SPDX-License-Identifier: GPL-3.0-or-later
/// Which joints hang together, as data: another task or another creature is another table, not other code.
#pragma once

#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "reachcast/body/joints.hpp"
#include "reachcast/posture/chain.hpp"

namespace reachcast {

/// A chain whose two ends are placed before it is decoded.
struct ChainSpec {
  std::string_view name;
  std::vector<Joint> joints;                           ///< first to last
  std::vector<Joint> pivots;                           ///< order of precedence
  std::vector<std::pair<Joint, FlexionLimit>> limits;  ///< hinges
};

inline constexpr std::size_t kPartCount = 2;
inline constexpr std::size_t kChest = 1;  ///< index into Linkage::parts

/// A rigid part of which two joints are placed by a chain; one angle about the line through them places `apex`, and
/// the riders follow. The mirror image of a part is
/// a part again, made of the joints on the other side.
struct RigidSpec {
  std::string_view name;
  Joint a, b, apex;
  std::vector<Joint> riders;
};

/// A link that is known by its direction relative to a rigid part, as turned from an upright stand, or relative to the
/// held object, whose x runs level from the left grip to the right one.
struct PointerSpec {
  static constexpr std::size_t kObject = static_cast<std::size_t>(-1);
  Joint from, to;
  std::size_t part;  ///< index into Linkage::parts, or kObject
};

/// Two links from the trunk to what is held or stood on, spanned last: between ends that are given, only the plane in
/// which the hinge bends is free.
struct LimbSpec {
  Joint root, hinge, end;
  FlexionLimit limit;
  double turn;  ///< share of a turn to the side that the plane makes (twist.hpp): 1 for arms, little for legs
};
inline constexpr std::size_t kLimbCount = 4;

/// The primary chain with the parts places the trunk. It runs from one foot to the opposite hand, so it is used twice,
/// on the posture and on its mirror image, and the trunk is the mean of the two; otherwise a reach to the left would
/// differ from a reach to the right. Pointers and limbs then say where the other joints are. Coordinates are kept in
/// the order primary chain and parts, the same of the mirror image, pointers, limbs; decoded in this order too.
struct Linkage {
  ChainSpec primary;
  std::array<RigidSpec, kPartCount> parts;
  std::vector<PointerSpec> pointers;
  std::array<LimbSpec, kLimbCount> limbs;  ///< left leg, right leg, left arm, right arm
};

/// Two hands on one object, both feet on the floor. The 2004 paper's chains (p. 547-549) with three differences.
/// The chest is one part from l5s1 to the clavicle roots, whose shape depends on how the back is bent alone: the
/// primary chain runs l5s1 -> right_clavicle, which is its first pivot, and c7t1 is the apex of the chest. Wrist and
/// ankle are pivots before elbow and knee, so that these two hinges stand between two single links, where a limit holds
/// by construction. Shoulders are kept relative to the chest and hands relative to the object, against which they move
/// little; as pivots of a chain from chest to hand they swing about when the hand comes close.
[[nodiscard]] const Linkage& two_handed_linkage();

}  // namespace reachcast
