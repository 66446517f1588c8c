// SPDX-License-Identifier: GPL-3.0-or-later
/// Which joints hang together, as data: another task or another creature is another table, not other code.
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "reachcast/body/joints.hpp"
#include "reachcast/posture/chain.hpp"

namespace reachcast {

/// A chain whose two ends are placed before it is decoded.
struct ChainSpec {
  std::string_view name;
  std::vector<Joint> joints;                            ///< first to last
  std::vector<Joint> pivots;                            ///< order of precedence
  std::vector<std::pair<Joint, FlexionLimit>> limits;   ///< hinges
};

/// A rigid part of which two joints are placed by a chain; one angle about the line through them places `apex`, and
/// the riders follow.
struct RigidSpec {
  std::string_view name;
  Joint a, b, apex;
  std::vector<Joint> riders;
};

/// A link with a free end, as a direction in the frame of a rigid part.
struct PointerSpec {
  Joint from, to;
  std::size_t part;  ///< index into Linkage::parts
};

/// Coordinates are kept in the order primary chain, parts, other chains, pointers.
struct Linkage {
  ChainSpec primary;
  std::vector<RigidSpec> parts;
  std::vector<ChainSpec> limbs;
  std::vector<PointerSpec> pointers;

};

/// Two hands on one object, both feet on the floor. The 2004 paper's chains (p. 547-549) with three differences:
/// the chest is rigid from l5s1 to the clavicle roots, as it is on a rig, so the primary chain runs l5s1 ->
/// right_clavicle and c7t1 is the apex of the chest; wrist and ankle are pivots before elbow and knee, so that these
/// two hinges stand between two single links, where a limit holds by construction; and the pivot c7t1 is therefore
/// the clavicle root.
[[nodiscard]] const Linkage& two_handed_linkage();

}  // namespace reachcast
