// SPDX-License-Identifier: GPL-3.0-or-later
/// The HIERARCHY section of a BVH file. Private to mocap/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reachcast/conventions.hpp"
#include "text_scanner.hpp"

namespace reachcast {

/// 0 to 2: position along x, y, z; 3 to 5: rotation about x, y, z in degrees.
using BvhChannel = unsigned char;

struct BvhJoint {
  std::string name;  ///< unique
  int parent = -1;   ///< index, smaller than the joint's own; -1 for a root
  Vec3 offset{0.0};  ///< in the parent's frame, file units
  std::vector<BvhChannel> channels;
};

struct BvhSkeleton {
  std::vector<BvhJoint> joints;   ///< joints and end sites in file order: parents before children
  std::size_t channel_count = 0;  ///< numbers per frame

  [[nodiscard]] std::vector<std::string> names() const;
  /// Length of the stretched body: along the bones from the farthest ankle or foot to the root and on to the farthest
  /// neck or head. The same in any pose. Where names do not tell, the largest extent of the skeleton at rest.
  [[nodiscard]] double height() const;
};

/// Reads from HIERARCHY up to and including the word MOTION. Throws std::invalid_argument.
[[nodiscard]] BvhSkeleton read_bvh_skeleton(TextScanner& scanner);

}  // namespace reachcast
