// SPDX-License-Identifier: GPL-3.0-or-later
/// Motions in the order in which their tasks are near to a wanted one, without looking at all of them: a k-d tree over
/// where motions begin and end (Bentley 1975), walked best first (Hjaltason & Samet 1999).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "reachcast/conventions.hpp"

namespace reachcast {

/// How much each end of a motion counts in the square of the distance between two tasks.
struct EndWeights {
  double home = 1.0, target = 1.0;
};

/// weights.home |home difference|^2 + weights.target |target difference|^2, always summed in this order.
[[nodiscard]] double squared_task_distance(const std::array<double, 6>& difference, const EndWeights& weights);

/// Not changed once made.
class TaskIndex {
 public:
  using Place = std::array<double, 6>;  ///< home, then target

  TaskIndex() = default;
  /// As many homes as targets, fewer than 2^32, all finite.
  TaskIndex(std::span<const Vec3> homes, std::span<const Vec3> targets);

 private:
  friend class TaskWalk;
  struct Node {
    Place lowest, highest;  ///< the box of the places below
    std::uint32_t first = 0, last = 0;
    std::uint32_t left = 0, right = 0;  ///< children; both 0 at a leaf
  };
  std::uint32_t build(std::span<const Place> places, std::uint32_t first, std::uint32_t last);

  std::vector<Node> nodes_;
  std::vector<Place> places_;            ///< as the leaves have them
  std::vector<std::uint32_t> position_;  ///< of those places in what was given
};

/// One walk through an index, which must outlive it.
class TaskWalk {
 public:
  struct Step {
    double squared_distance = 0.0;
    std::uint32_t at = 0;  ///< position in what the index was made of
  };

  TaskWalk(const TaskIndex& index, const Vec3& home, const Vec3& target, const EndWeights& weights);

  /// The next nearest; every position once, squared distances never fall, equal ones come in any order. Nothing at the
  /// end.
  [[nodiscard]] std::optional<Step> next();

 private:
  struct Unopened {
    double least;  ///< no place below the node is nearer
    std::uint32_t node;
  };
  [[nodiscard]] double least_distance(const TaskIndex::Node& node) const;
  void push(std::uint32_t node);
  void open_nearest();
  void make_ready();

  const TaskIndex* index_;
  TaskIndex::Place wanted_;
  EndWeights weights_;
  std::vector<Unopened> unopened_;  ///< a heap, nearest on top
  std::vector<Step> seen_;          ///< of opened leaves; an unopened node may hide nearer ones
  std::vector<Step> ready_;         ///< farthest first: the next ones of the walk
  std::size_t batch_ = 32;          ///< how many places to see before the next are made ready
};

}  // namespace reachcast
