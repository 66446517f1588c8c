// SPDX-License-Identifier: GPL-3.0-or-later
/// The part of a performance that minds edges and obstacles.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <stdexcept>
#include <string>

#include "reachcast/predict/performance.hpp"

namespace reachcast {
namespace {

constexpr int kLooks = 64;          // along a way
constexpr double kTouch_m = 0.004;  // what stands on a surface may seem to lie in it by so much
constexpr double kNear_m = 0.10;    // of its place, where the clearance shrinks to nothing
constexpr double kHand_m = 0.09;    // a closed hand

}  // namespace

void Performance::raise_over_edges() {
  for (Act& act : acts_) {
    if (!is_loaded(act.stage->phase)) continue;
    const auto place_at = [&](double t) { return point_at(act.path, act.from.position, act.to.position, t); };
    act.clearance = EdgeClearance(place_at, task_.object);
  }
}

double Performance::raised_m() const {
  double most = 0.0;
  for (const Act& act : acts_) most = std::max(most, act.clearance.largest_m());
  return most;
}

std::vector<std::size_t> Performance::go_round(const Obstacles& obstacles, double clearance_m,
                                               const std::vector<std::size_t>& first_shapes) {
  for (const Act& act : acts_) {
    require_free_place(act.stage->object, obstacles);
    if (is_loaded(act.stage->phase)) require_free_place(other(act.stage->object), obstacles);
  }
  std::vector<std::size_t> taken = first_shapes;
  for (std::size_t i = 0; i < acts_.size(); ++i) {
    for (;; ++taken[i]) {
      if (taken[i] == path_shapes().size()) {
        throw std::invalid_argument("no way past the obstacles was found for the " +
                                    std::string(is_loaded(acts_[i].stage->phase) ? "box" : "hands") + " in phase " +
                                    std::string(phase_name(acts_[i].stage->phase)));
      }
      acts_[i].shape = path_shapes()[taken[i]];
      if (is_free(acts_[i], obstacles, clearance_m)) break;
    }
  }
  return taken;
}

void Performance::require_free_place(Place place, const Obstacles& obstacles) const {
  const Box& box = task_.object;
  const BoxPose pose = place_pose(place);
  const Vec3 size = Vec3(box.width_m, box.depth_m, box.height_m) - 2.0 * kTouch_m;
  if (!obstacles.meet({pose.position + Vec3(0, 0, 0.5 * box.height_m), glm::max(size, 0.001), pose.yaw_rad})) return;
  throw std::invalid_argument(std::string("the box would stand in an obstacle at the ") +
                              (place == Place::home ? "home" : "target") + ", by more than " +
                              std::to_string(std::lround(1000.0 * kTouch_m)) + " mm");
}

bool Performance::is_free(const Act& act, const Obstacles& obstacles, double clearance_m) const {
  const Box& box = task_.object;
  const bool loaded = is_loaded(act.stage->phase);
  const Vec3 first = hold_point(act.hands.first), last = hold_point(act.hands.last);
  for (int i = 1; i < kLooks; ++i) {
    const double t = static_cast<double>(i) / kLooks;
    const BoxPose pose = loaded ? carried_object(act, t) : BoxPose{};
    const Grips grips = loaded ? Grips{grip_of(box, pose, true), grip_of(box, pose, false)} : empty_grips(act, t);
    const Vec3 hold = hold_point(grips);
    const double away = std::min(glm::distance(hold, first), glm::distance(hold, last));
    const double keep = 2.0 * (clearance_m * std::min(1.0, away / kNear_m) - kTouch_m);
    const auto meets = [&](const Vec3& centre, const Vec3& size) {
      return obstacles.meet({centre, glm::max(size + keep, 0.001), pose.yaw_rad});
    };
    if (loaded && meets(pose.position + Vec3(0, 0, 0.5 * box.height_m), {box.width_m, box.depth_m, box.height_m}))
      return false;
    if (away > kNear_m && (meets(grips[0], Vec3(kHand_m)) || meets(grips[1], Vec3(kHand_m)))) return false;
  }
  return true;
}

Vec3 Performance::towards_person(const Vec3& from, const Vec3& to) const {
  const Vec3 middle = 0.5 * (from + to);
  const Vec3 level(between_ankles_.x - middle.x, between_ankles_.y - middle.y, 0.0);
  return glm::length(level) > 1e-6 ? glm::normalize(level) : Vec3(0, -1, 0);
}

Vec3 Performance::way(const Act& act, const Vec3& from, const Vec3& to, double t) const {
  return shaped_point_at(act.path, from, to, act.shape, towards_person(from, to), t);
}

double Performance::bent_m() const {
  double most = 0.0;
  for (const Act& act : acts_) {
    const Vec3 from = hold_point(act.hands.first), to = hold_point(act.hands.last);
    most = std::max(most, bend_of(act.path, from, to, act.shape, towards_person(from, to)));
  }
  return most;
}

}  // namespace reachcast
