// SPDX-License-Identifier: GPL-3.0-or-later
/// Surfaces that what is carried must not touch.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "reachcast/conventions.hpp"

namespace reachcast {

using Triangle = std::array<Vec3, 3>;

/// A box that stands level. Sizes are whole widths, metres.
struct LevelBox {
  Vec3 centre{0.0};
  Vec3 size{0.0};  ///< along its own x, its own y, z
  double yaw_rad = 0.0;
};

/// Triangles in a tree of bounding boxes. Not changed once made.
class Obstacles {
 public:
  Obstacles() = default;
  /// Body frame, metres; at most 1e6. Throws std::invalid_argument for a corner that is not finite.
  explicit Obstacles(std::vector<Triangle> triangles);

  [[nodiscard]] bool empty() const { return triangles_.empty(); }
  [[nodiscard]] std::size_t size() const { return triangles_.size(); }
  /// Whether a triangle lies in the box or passes through it.
  [[nodiscard]] bool meet(const LevelBox& box) const;

 private:
  struct Node {
    Vec3 low{0.0}, high{0.0};
    std::size_t first = 0, count = 0;  ///< triangles of a leaf
    std::size_t right = 0;             ///< of an inner node; the left child follows it
  };
  std::size_t build(std::size_t first, std::size_t count);

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace reachcast
