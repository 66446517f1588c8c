// SPDX-License-Identifier: GPL-3.0-or-later
/// Stretch-pivot coordinates of a chain of links whose two ends are given (Faraway 2004, section 2 and Appendix), with
/// a lower reach bound for every sub-chain and joint limits as bounds on reach.
///
/// A chain of n links has joints 0..n. Its ends are given; a pivot m between them splits it into a proximal and a
/// distal sub-chain, each of which is split again. A pivot is described by how far each side is stretched (q in [0, 1]
/// within what is possible, kept as logit q) and by the normal of the plane (start, m, end), whose length is the sine
/// of the bend at m: nearly straight chains, whose normal is noise, weigh little in a mean. Because every q is relative
/// to what is possible, any coordinates at all, also any weighted mean, decode to a chain with exact link lengths.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include "reachcast/conventions.hpp"

namespace reachcast {

/// Distances that the ends of a sub-chain can have, metres, 0 <= lo <= hi.
struct Interval {
  double lo = 0.0;
  double hi = 0.0;
};

/// How far a hinge may bend: 0 is straight, pi is folded. 0 <= min <= max <= pi.
struct FlexionLimit {
  double min_rad = 0.0;
  double max_rad = kPi;
};

/// The pivot of two sides with these lengths between two given points, on the side of the plane with this normal, which
/// need be neither orthogonal to the line between them nor of unit length. Where the sides cannot span the ends they
/// are taken as straight.
[[nodiscard]] Vec3 pivot_point(const Vec3& start, const Vec3& end, double proximal_m, double distal_m,
                               const Vec3& normal);
/// The same for an end that lies `across_m` > 0 from the start in the direction `axis` of unit length.
[[nodiscard]] Vec3 pivot_point(const Vec3& start, const Vec3& axis, double across_m, double proximal_m, double distal_m,
                               const Vec3& normal);

class Chain {
 public:
  /// `lengths`: n >= 1 positive link lengths, metres, at most 1e6. `pivots`: interior joints 1..n-1 in order of
  /// precedence; interior joints not named follow in ascending order. `limits`: by interior joint, allowed where the
  /// joint's two neighbours in its sub-chain are single links (there a limit is a bound on reach). Throws
  /// std::invalid_argument.
  Chain(std::vector<double> lengths, std::vector<std::size_t> pivots,
        const std::map<std::size_t, FlexionLimit>& limits = {});

  [[nodiscard]] std::size_t links() const { return lengths_.size(); }
  [[nodiscard]] std::size_t coordinate_count() const { return coordinate_count_; }
  /// Of any chain with so many links, whatever its pivots: each pivot but the first is one stretch of another one.
  [[nodiscard]] static constexpr std::size_t coordinate_count(std::size_t links) {
    return links < 2 ? 0 : 3 * (links - 1) + (links - 2);
  }
  [[nodiscard]] Interval reach() const { return root_reach_; }
  [[nodiscard]] const std::vector<double>& lengths() const { return lengths_; }

  /// points: n+1 joints, any frame. coordinates: coordinate_count() numbers, out. The points' links are taken as they
  /// are; where they differ from `lengths`, the q are clamped to what `lengths` allow.
  void encode(std::span<const Vec3> points, std::span<double> coordinates) const;

  /// points: n+1 joints, out, from `start` to `end` with every link length exact. The distance of the ends must lie in
  /// reach() to within 1e-9 m (it is then clamped), or std::invalid_argument says by how much it does not.
  void decode(const Vec3& start, const Vec3& end, std::span<const double> coordinates, std::span<Vec3> points) const;

  /// Which pivots must be placed, and in which order, to know where these interior joints are.
  [[nodiscard]] std::vector<std::size_t> steps_to(std::span<const std::size_t> joints) const;
  /// Only these steps; the other interior points stay as they are.
  void decode(const Vec3& start, const Vec3& end, std::span<const double> coordinates,
              std::span<const std::size_t> steps, std::span<Vec3> points) const;

 private:
  struct Node {
    std::size_t first = 0, pivot = 0, last = 0;  ///< joints
    int proximal = -1, distal = -1;              ///< child nodes; -1: a single link
    Interval proximal_reach, distal_reach;
    std::size_t offset = 0;  ///< of the first coordinate: 0 to 2 logits, then the normal
    int stretches = 0;
  };
  void decode_node(const Node& node, std::span<const double> coordinates, std::span<Vec3> points) const;
  void place_ends(const Vec3& start, const Vec3& end, std::span<Vec3> points) const;
  int build(std::size_t first, std::size_t last, const std::vector<std::size_t>& order,
            const std::map<std::size_t, FlexionLimit>& limits, Interval& reach);

  std::vector<double> lengths_;
  std::vector<Node> nodes_;  ///< parents before children
  std::size_t coordinate_count_ = 0;
  Interval root_reach_;
};

}  // namespace reachcast
