// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/task.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

namespace reachcast {
namespace {

void require(bool good, const char* name, double value, const char* limit) {
  if (good) return;
  std::ostringstream out;
  out << "object: " << name << " is " << value << "; it must be " << limit;
  throw std::invalid_argument(out.str());
}

void require_place(const char* name, const Vec3& at) {
  constexpr double kFarthest_m = 100.0, kLowest_m = -0.02;
  if (is_finite(at) && glm::length(at) <= kFarthest_m && at.z >= kLowest_m) return;
  std::ostringstream out;
  out << name << " is (" << at.x << ", " << at.y << ", " << at.z
      << "); it must be finite, within 100 m of the feet and not below the floor";
  throw std::invalid_argument(out.str());
}

}  // namespace

Vec3 grip_of(const Box& box, const BoxPose& pose, bool left) {
  const double half = (left ? -0.5 : 0.5) * box.grip_distance_m;
  return pose.position + Vec3(half * std::cos(pose.yaw_rad), half * std::sin(pose.yaw_rad), box.handle_height_m);
}

Box held_by(const Box& box, Hands hands) {
  Box held = box;
  if (hands != Hands::both) held.grip_distance_m = 0.0;
  return held;
}

void check(const Task& task) {
  require_place("home", task.home);
  require_place("target", task.target);
  for (const auto& [name, yaw] : {std::pair{"home_yaw", task.home_yaw_rad}, {"target_yaw", task.target_yaw_rad}}) {
    if (!(std::abs(yaw) <= 1000.0)) {
      throw std::invalid_argument(std::string(name) + " is " + std::to_string(yaw) +
                                  "; it must lie within 1000 radians");
    }
  }
  const Box& box = task.object;
  require(box.width_m > 0.0 && box.width_m <= 3.0, "width", box.width_m, "positive and at most 3 m");
  require(box.depth_m > 0.0 && box.depth_m <= 3.0, "depth", box.depth_m, "positive and at most 3 m");
  require(box.height_m > 0.0 && box.height_m <= 3.0, "height", box.height_m, "positive and at most 3 m");
  require(box.handle_height_m >= 0.0 && box.handle_height_m <= box.height_m, "handle_height", box.handle_height_m,
          "between 0 and the height, metres");
  require(box.grip_distance_m >= 0.02 && box.grip_distance_m <= 2.0, "grip_distance", box.grip_distance_m,
          "between 0.02 and 2 m");
  require(box.mass_kg >= 0.0 && box.mass_kg <= 200.0, "mass", box.mass_kg, "between 0 and 200 kg");
}

}  // namespace reachcast
