// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/approach.hpp"

#include <algorithm>
#include <cmath>

namespace reachcast {
namespace {

constexpr double kHalfShelf_m = 0.15;  // of a usual shelf's depth, beyond the box's own
constexpr double kClearance_m = 0.02;
constexpr double kOverEdge_m = 0.10;  // within this distance of its place the box sinks from the clearance to zero
constexpr double kMostRise_m = 0.15;

/// t^4 (1 - t)^2, scaled to a peak of 1 at t = 2/3.
double late_bump(double t) {
  return t * t * t * t * (1.0 - t) * (1.0 - t) * 45.5625;
}

double level_distance(const Vec3& a, const Vec3& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

double rise_for(std::span<const BoxPose> path, const Vec3& place, double radius, bool at_end) {
  double rise = 0.0;
  for (std::size_t f = 1; f + 1 < path.size(); ++f) {
    const double away = level_distance(path[f].position, place);
    if (away >= radius || away < 1e-3) continue;
    const double t = static_cast<double>(f) / static_cast<double>(path.size() - 1);
    const double missing = place.z + kClearance_m * std::min(1.0, away / kOverEdge_m) - path[f].position.z;
    const double bump = late_bump(at_end ? t : 1.0 - t);
    if (missing > 0.0 && bump > 1e-3) rise = std::max(rise, missing / bump);
  }
  return std::min(rise, kMostRise_m);
}

}  // namespace

double clear_edges(std::span<BoxPose> path, const Box& box) {
  if (path.size() < 3) return 0.0;
  const Vec3 home = path.front().position, target = path.back().position;
  const double radius = std::min(0.5 * box.depth_m + kHalfShelf_m, 0.6 * level_distance(home, target));
  const double late = rise_for(path, target, radius, true), early = rise_for(path, home, radius, false);
  double most = 0.0;
  for (std::size_t f = 1; f + 1 < path.size(); ++f) {
    const double t = static_cast<double>(f) / static_cast<double>(path.size() - 1);
    const double rise = late * late_bump(t) + early * late_bump(1.0 - t);
    path[f].position.z += rise;
    most = std::max(most, rise);
  }
  return most;
}

}  // namespace reachcast
