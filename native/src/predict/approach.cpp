// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/approach.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace reachcast {
namespace {

constexpr int kTimes = 64;
constexpr double kHalfShelf_m = 0.15;  // of a usual shelf's depth, beyond the box's own
constexpr double kClearance_m = 0.02;
constexpr double kOverEdge_m = 0.10;  // within this distance of its place the box sinks from the clearance to zero
constexpr double kMostRise_m = 0.10;
constexpr double kLeastBump = 0.25;  // nearer to its end a bump cannot raise the box without raising all of the path

/// t^4 (1 - t)^2, scaled to a peak of 1 at t = 2/3.
double late_bump(double t) {
  return t * t * t * t * (1.0 - t) * (1.0 - t) * 45.5625;
}

double level_distance(const Vec3& a, const Vec3& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

/// Places at t = 0, 1 / kTimes, ..., 1.
using Path = std::array<Vec3, kTimes + 1>;

double rise_for(const Path& path, const Vec3& place, double radius, bool at_end) {
  double rise = 0.0;
  for (std::size_t i = 1; i < kTimes; ++i) {
    const double t = static_cast<double>(i) / kTimes, bump = late_bump(at_end ? t : 1.0 - t);
    const Vec3 at = path[i];
    if (bump < kLeastBump) continue;
    const double away = level_distance(at, place);
    if (away >= radius) continue;
    const double missing = place.z + kClearance_m * std::min(1.0, away / kOverEdge_m) - at.z;
    rise = std::max(rise, missing / bump);
  }
  return std::min(rise, kMostRise_m);
}

}  // namespace

EdgeClearance::EdgeClearance(const std::function<Vec3(double)>& place_at, const Box& box) {
  Path path;
  for (std::size_t i = 0; i <= kTimes; ++i) path[i] = place_at(static_cast<double>(i) / kTimes);
  const Vec3 home = path.front(), target = path.back();
  const double radius = std::min(0.5 * box.depth_m + kHalfShelf_m, 0.6 * level_distance(home, target));
  early_m_ = rise_for(path, home, radius, false);
  late_m_ = rise_for(path, target, radius, true);
  const double together = largest_m();
  if (together > kMostRise_m) early_m_ *= kMostRise_m / together, late_m_ *= kMostRise_m / together;
}

double EdgeClearance::rise_m(double t) const {
  return early_m_ * late_bump(1.0 - t) + late_m_ * late_bump(t);
}

double EdgeClearance::largest_m() const {
  double largest = 0.0;
  for (int i = 1; i < kTimes; ++i) largest = std::max(largest, rise_m(static_cast<double>(i) / kTimes));
  return largest;
}

}  // namespace reachcast
