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
    if (!is_loaded(act.stage->phase) || act.way.form == WayForm::given) continue;
    const auto place_at = [&](double t) { return point_at(act.way.way, act.from.position, act.to.position, t); };
    act.clearance = EdgeClearance(place_at, task_.object);
    if (act.way.approach) act.clearance.leave_end();
  }
}

double Performance::raised_m() const {
  double most = 0.0;
  for (const Act& act : acts_) most = std::max(most, act.clearance.largest_m());
  return most;
}

std::vector<std::size_t> Performance::go_round(const Obstacles& obstacles, double clearance_m,
                                               const std::vector<std::size_t>& first_manners) {
  for (const Act& act : acts_) {
    require_free_place(act.stage->object, obstacles);
    if (is_loaded(act.stage->phase)) require_free_place(other(act.stage->object), obstacles);
  }
  std::vector<std::size_t> taken = first_manners;
  for (std::size_t i = 0; i < acts_.size(); ++i) {
    Act& act = acts_[i];
    if (act.way.form == WayForm::given) continue;
    const std::vector<CurveBend> bends = bends_of(act);
    const std::size_t manners = bends.empty() ? path_shapes().size() : bends.size();
    for (;; ++taken[i]) {
      if (taken[i] >= manners) {
        throw std::invalid_argument("no way past the obstacles was found for the " +
                                    std::string(is_loaded(act.stage->phase) ? "box" : "hands") + " in phase " +
                                    std::string(phase_name(act.stage->phase)));
      }
      if (bends.empty()) {
        act.shape = path_shapes()[taken[i]];
      } else {
        AxisCurve curve = std::get<AxisCurve>(ways_[i].way);
        for (std::size_t k = 0; k < 2; ++k) curve.offsets[k] += bends[taken[i]][k];
        act.way.way = curve;
      }
      act.is_bent = taken[i] > 0;
      if (is_free(act, obstacles, clearance_m)) break;
    }
  }
  return taken;
}

/// None for a way that is bent in another manner.
std::vector<CurveBend> Performance::bends_of(const Act& act) const {
  if (!std::holds_alternative<AxisCurve>(act.way.way)) return {};
  return curve_bends(towards_person(hold_point(act.hands.first), hold_point(act.hands.last)), act.way.approach);
}

std::size_t Performance::frames_touching(const Obstacles& obstacles, double clearance_m) const {
  std::size_t frames = 0;
  for (const Act& act : acts_) {
    if (act.way.form != WayForm::given) continue;
    for (std::size_t frame = act.stage->first + 1; frame < act.stage->last; ++frame) {
      frames += is_free_at(act, time_in(act, static_cast<double>(frame)), obstacles, clearance_m) ? 0 : 1;
    }
  }
  return frames;
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
  for (int i = 1; i < kLooks; ++i) {
    if (!is_free_at(act, static_cast<double>(i) / kLooks, obstacles, clearance_m)) return false;
  }
  return true;
}

bool Performance::is_free_at(const Act& act, double t, const Obstacles& obstacles, double clearance_m) const {
  const Box& box = task_.object;
  const bool loaded = is_loaded(act.stage->phase);
  const Vec3 first = hold_point(act.hands.first), last = hold_point(act.hands.last);
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
  return away <= kNear_m || (!meets(grips[0], Vec3(kHand_m)) && !meets(grips[1], Vec3(kHand_m)));
}

Vec3 Performance::towards_person(const Vec3& from, const Vec3& to) const {
  return level_direction(0.5 * (from + to), between_ankles_);
}

Vec3 Performance::point_of(const Act& act, const Vec3& from, const Vec3& to, double t) const {
  const auto* path = std::get_if<EndpointPath>(&act.way.way);
  if (!path) return point_at(act.way.way, from, to, t);
  return shaped_point_at(*path, from, to, act.shape, towards_person(from, to), t);
}

std::vector<std::optional<std::array<Vec3, 4>>> Performance::curves() const {
  std::vector<std::optional<std::array<Vec3, 4>>> out;
  for (const Act& act : acts_) {
    const auto* curve = std::get_if<AxisCurve>(&act.way.way);
    out.push_back(curve
                      ? std::optional(control_between(*curve, hold_point(act.hands.first), hold_point(act.hands.last)))
                      : std::nullopt);
  }
  return out;
}

double Performance::bent_m() const {
  double most = 0.0;
  for (std::size_t i = 0; i < acts_.size(); ++i) {
    const Act& act = acts_[i];
    if (!act.is_bent) continue;
    const Vec3 from = hold_point(act.hands.first), to = hold_point(act.hands.last);
    most = std::max(most, bend_of([&](double t) { return point_of(act, from, to, t); },
                                  [&](double t) { return point_at(ways_[i].way, from, to, t); }));
  }
  return most;
}

}  // namespace reachcast
