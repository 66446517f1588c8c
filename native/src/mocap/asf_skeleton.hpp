// SPDX-License-Identifier: GPL-3.0-or-later
/// The skeleton in an .asf file. Private to mocap/.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "reachcast/conventions.hpp"

namespace reachcast {

/// 0 to 2: rotation about x, y, z; 3 to 5: translation along them.
using AsfChannel = unsigned char;

struct AsfBone {
  std::string name;
  int parent = -1;                   ///< index, smaller than the bone's own; 0 is the root, whose parent is -1
  Vec3 along{0.0};                   ///< from start to end at rest, root's axes, file units
  Mat3 axes{1.0};                    ///< C: the bone's own axes at rest
  std::vector<AsfChannel> channels;  ///< as listed, in a motion's order
  bool has_child = false;
};

struct AsfSkeleton {
  std::vector<AsfBone> bones;  ///< [0] is the root; parents before children
  Vec3 position{0.0};          ///< of the root at rest
  double radians_per_unit = kPi / 180.0;
  std::optional<double> metres_per_unit;  ///< from :units length

  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;
};

/// Rotations about x, y, z by angles in the order given; the first is applied first, about fixed axes.
[[nodiscard]] Mat3 rotation_in_order(const std::vector<AsfChannel>& order, const double* angles_rad);

/// Throws std::invalid_argument, worded `source:line: expected X, found Y`.
[[nodiscard]] AsfSkeleton read_asf_skeleton(std::string_view text, const std::string& source);

}  // namespace reachcast
