// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/task.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace reachcast {
namespace {

void require(bool good, const char* name, double value, const char* limit) {
  if (good) return;
  std::ostringstream out;
  out << "object: " << name << " is " << value << "; it must be " << limit;
  throw std::invalid_argument(out.str());
}

void require_place(const char* name, const Vec3& at) {
  if (is_finite(at)) return;
  std::ostringstream out;
  out << name << " is (" << at.x << ", " << at.y << ", " << at.z << "); it must be finite";
  throw std::invalid_argument(out.str());
}

}  // namespace

Vec3 grip_of(const Box& box, const BoxPose& pose, bool left) {
  const double half = (left ? -0.5 : 0.5) * box.grip_distance_m;
  return pose.position + Vec3(half * std::cos(pose.yaw_rad), half * std::sin(pose.yaw_rad), box.handle_height_m);
}

void check(const Task& task) {
  require_place("home", task.home);
  require_place("target", task.target);
  if (!std::isfinite(task.home_yaw_rad)) throw std::invalid_argument("home_yaw is not finite");
  if (!std::isfinite(task.target_yaw_rad)) throw std::invalid_argument("target_yaw is not finite");
  const Box& box = task.object;
  require(box.width_m > 0.0 && std::isfinite(box.width_m), "width", box.width_m, "positive, metres");
  require(box.depth_m > 0.0 && std::isfinite(box.depth_m), "depth", box.depth_m, "positive, metres");
  require(box.height_m > 0.0 && std::isfinite(box.height_m), "height", box.height_m, "positive, metres");
  require(box.handle_height_m >= 0.0 && box.handle_height_m <= box.height_m, "handle_height", box.handle_height_m,
          "between 0 and the height, metres");
  require(box.grip_distance_m >= 0.02 && box.grip_distance_m <= 2.0, "grip_distance", box.grip_distance_m,
          "between 0.02 and 2 m");
  require(box.mass_kg >= 0.0 && std::isfinite(box.mass_kg), "mass", box.mass_kg, "zero or more, kilograms");
}

}  // namespace reachcast
