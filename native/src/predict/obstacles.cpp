// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <stdexcept>
#include <string>

namespace reachcast {
namespace {

constexpr std::size_t kMostTriangles = 1'000'000;
constexpr std::size_t kLeaf = 4;

Vec3 absolute(const Vec3& v) {
  return {std::abs(v.x), std::abs(v.y), std::abs(v.z)};
}

/// A triangle and a box of half sizes `half` about the origin, by separating axes: the box's own, the triangle's
/// normal, and the products of their edges (Akenine-Moeller 2001).
bool overlap(const Triangle& t, const Vec3& half) {
  const auto apart_along = [&](const Vec3& axis) {
    const double a = glm::dot(t[0], axis), b = glm::dot(t[1], axis), c = glm::dot(t[2], axis);
    const double reach = glm::dot(half, absolute(axis));
    return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
  };
  constexpr std::array<std::array<double, 3>, 3> kAxes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const std::array<Vec3, 3> edges{t[1] - t[0], t[2] - t[1], t[0] - t[2]};
  for (const auto& a : kAxes) {
    const Vec3 axis(a[0], a[1], a[2]);
    if (apart_along(axis)) return false;
    for (const Vec3& edge : edges) {
      if (apart_along(glm::cross(axis, edge))) return false;
    }
  }
  return !apart_along(glm::cross(edges[0], edges[1]));
}

}  // namespace

Obstacles::Obstacles(std::vector<Triangle> triangles) : triangles_(std::move(triangles)) {
  if (triangles_.size() > kMostTriangles) {
    throw std::invalid_argument("obstacles have " + std::to_string(triangles_.size()) + " triangles; at most " +
                                std::to_string(kMostTriangles) + " are allowed");
  }
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    for (const Vec3& corner : triangles_[i]) {
      if (!is_finite(corner))
        throw std::invalid_argument("obstacles: triangle " + std::to_string(i) + " has a corner that is not finite");
    }
  }
  if (!triangles_.empty()) build(0, triangles_.size());
}

std::size_t Obstacles::build(std::size_t first, std::size_t count) {
  const std::size_t self = nodes_.size();
  Node node{triangles_[first][0], triangles_[first][0], first, count, 0};
  for (std::size_t i = first; i < first + count; ++i) {
    for (const Vec3& corner : triangles_[i])
      node.low = glm::min(node.low, corner), node.high = glm::max(node.high, corner);
  }
  nodes_.push_back(node);
  if (count <= kLeaf) return self;
  const Vec3 size = node.high - node.low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto middle = [axis](const Triangle& t) { return t[0][axis] + t[1][axis] + t[2][axis]; };
  const auto begin = triangles_.begin() + static_cast<std::ptrdiff_t>(first);
  const std::size_t half = count / 2;
  std::nth_element(begin, begin + static_cast<std::ptrdiff_t>(half), begin + static_cast<std::ptrdiff_t>(count),
                   [&](const Triangle& a, const Triangle& b) { return middle(a) < middle(b); });
  build(first, half);
  const std::size_t right = build(first + half, count - half);
  nodes_[self].right = right;
  nodes_[self].count = 0;
  return self;
}

bool Obstacles::meet(const LevelBox& box) const {
  if (triangles_.empty()) return false;
  const double c = std::cos(box.yaw_rad), s = std::sin(box.yaw_rad);
  const Vec3 half = 0.5 * box.size;
  const Vec3 around(std::abs(c) * half.x + std::abs(s) * half.y, std::abs(s) * half.x + std::abs(c) * half.y, half.z);
  const Vec3 low = box.centre - around, high = box.centre + around;
  const auto into_box = [&](const Vec3& p) {
    const Vec3 d = p - box.centre;
    return Vec3(c * d.x + s * d.y, -s * d.x + c * d.y, d.z);
  };
  std::vector<std::size_t> pending{0};
  while (!pending.empty()) {
    const std::size_t at = pending.back();
    const Node& node = nodes_[at];
    pending.pop_back();
    if (glm::any(glm::greaterThan(node.low, high)) || glm::any(glm::lessThan(node.high, low))) continue;
    if (node.count == 0) {
      pending.push_back(node.right);
      pending.push_back(at + 1);
      continue;
    }
    for (std::size_t i = node.first; i < node.first + node.count; ++i) {
      const Triangle& t = triangles_[i];
      if (overlap({into_box(t[0]), into_box(t[1]), into_box(t[2])}, half)) return true;
    }
  }
  return false;
}

}  // namespace reachcast
