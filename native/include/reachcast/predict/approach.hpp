// SPDX-License-Identifier: GPL-3.0-or-later
/// What stands on a surface leaves it upwards and comes to it from above.
#pragma once

#include <functional>

#include "reachcast/predict/task.hpp"

namespace reachcast {

/// How far a path is raised at scaled time t: one smooth bump for each end, zero in value and slope at both ends of the
/// path, together at most 0.10 m, which clears most edges and keeps the path that of a person.
class EdgeClearance {
 public:
  EdgeClearance() = default;

  /// The rise, as far as the bound allows, with which the box stays above its place while its centre is level within
  /// half its depth and 15 cm of that place, or within 60 % of the way where the two places are close. `place_at`: the
  /// box's origin at scaled time t; it is looked at at fixed times, so that the rise does not depend on a frame rate.
  EdgeClearance(const std::function<Vec3(double)>& place_at, const Box& box);

  /// Takes back the rise towards the end of the path.
  void leave_end() { late_m_ = 0.0; }

  [[nodiscard]] double rise_m(double t) const;
  [[nodiscard]] double largest_m() const;

 private:
  double early_m_ = 0.0, late_m_ = 0.0;
};

}  // namespace reachcast
