// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/corpus/task_index.hpp"

#include <algorithm>
#include <numeric>

namespace reachcast {
namespace {

constexpr std::uint32_t kLeaf = 16;  // most places of a leaf

TaskIndex::Place place_of(const Vec3& home, const Vec3& target) {
  return {home.x, home.y, home.z, target.x, target.y, target.z};
}

/// For a heap with the nearest on top.
constexpr auto by_falling_least = [](const auto& a, const auto& b) { return a.least > b.least; };

}  // namespace

double squared_task_distance(const std::array<double, 6>& d, const EndWeights& weights) {
  return weights.home * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) +
         weights.target * (d[3] * d[3] + d[4] * d[4] + d[5] * d[5]);
}

TaskIndex::TaskIndex(std::span<const Vec3> homes, std::span<const Vec3> targets) {
  std::vector<Place> places;
  places.reserve(homes.size());
  for (std::size_t i = 0; i < homes.size(); ++i) places.push_back(place_of(homes[i], targets[i]));
  position_.resize(places.size());
  std::iota(position_.begin(), position_.end(), 0u);
  if (!places.empty()) build(places, 0, static_cast<std::uint32_t>(places.size()));
  places_.reserve(places.size());
  for (const std::uint32_t at : position_) places_.push_back(places[at]);
}

/// Halves the longest side of the box. Returns the number of the node.
std::uint32_t TaskIndex::build(std::span<const Place> places, std::uint32_t first, std::uint32_t last) {
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  Node node{places[position_[first]], places[position_[first]], first, last};
  for (std::uint32_t i = first + 1; i < last; ++i) {
    for (std::size_t axis = 0; axis < 6; ++axis) {
      node.lowest[axis] = std::min(node.lowest[axis], places[position_[i]][axis]);
      node.highest[axis] = std::max(node.highest[axis], places[position_[i]][axis]);
    }
  }
  nodes_.push_back(node);
  if (last - first <= kLeaf) return number;
  std::size_t longest = 0;
  for (std::size_t axis = 1; axis < 6; ++axis) {
    if (node.highest[axis] - node.lowest[axis] > node.highest[longest] - node.lowest[longest]) longest = axis;
  }
  const std::uint32_t middle = first + (last - first) / 2;
  const auto begin = position_.begin();
  std::nth_element(begin + first, begin + middle, begin + last,
                   [&](std::uint32_t a, std::uint32_t b) { return places[a][longest] < places[b][longest]; });
  const std::uint32_t left = build(places, first, middle), right = build(places, middle, last);
  nodes_[number].left = left;
  nodes_[number].right = right;
  return number;
}

TaskWalk::TaskWalk(const TaskIndex& index, const Vec3& home, const Vec3& target, const EndWeights& weights)
    : index_(&index), wanted_(place_of(home, target)), weights_(weights) {
  if (!index.nodes_.empty()) push(0);
}

/// Per axis no place of the box is nearer than the clamped one, and rounding keeps that order: the bound is exact.
double TaskWalk::least_distance(const TaskIndex::Node& node) const {
  std::array<double, 6> d;
  for (std::size_t axis = 0; axis < 6; ++axis) {
    d[axis] = std::clamp(wanted_[axis], node.lowest[axis], node.highest[axis]) - wanted_[axis];
  }
  return squared_task_distance(d, weights_);
}

void TaskWalk::push(std::uint32_t node) {
  unopened_.push_back({least_distance(index_->nodes_[node]), node});
  std::push_heap(unopened_.begin(), unopened_.end(), by_falling_least);
}

void TaskWalk::open_nearest() {
  const TaskIndex::Node& node = index_->nodes_[unopened_.front().node];
  std::pop_heap(unopened_.begin(), unopened_.end(), by_falling_least);
  unopened_.pop_back();
  if (node.right != 0) {
    push(node.left);
    push(node.right);
    return;
  }
  for (std::uint32_t i = node.first; i < node.last; ++i) {
    std::array<double, 6> d;
    for (std::size_t axis = 0; axis < 6; ++axis) d[axis] = index_->places_[i][axis] - wanted_[axis];
    seen_.push_back({squared_task_distance(d, weights_), index_->position_[i]});
  }
}

/// Opens nodes until some of what was seen is nearer than all that was not. More in each round, so that what remains is
/// not looked through too often.
void TaskWalk::make_ready() {
  while (ready_.empty() && !(unopened_.empty() && seen_.empty())) {
    const std::size_t wanted = seen_.size() + batch_;
    while (!unopened_.empty() && seen_.size() < wanted) open_nearest();
    batch_ += batch_ / 2;
    const auto hidden = [&](const Step& step) {
      return !unopened_.empty() && step.squared_distance > unopened_.front().least;
    };
    const auto first_ready = std::partition(seen_.begin(), seen_.end(), hidden);
    ready_.assign(first_ready, seen_.end());
    seen_.erase(first_ready, seen_.end());
  }
  std::sort(ready_.begin(), ready_.end(),
            [](const Step& a, const Step& b) { return a.squared_distance > b.squared_distance; });
}

std::optional<TaskWalk::Step> TaskWalk::next() {
  if (ready_.empty()) make_ready();
  if (ready_.empty()) return std::nullopt;
  const Step nearest = ready_.back();
  ready_.pop_back();
  return nearest;
}

}  // namespace reachcast
