// SPDX-License-Identifier: GPL-3.0-or-later
/// The part of a performance that knows where hands begin and end.
#include "reachcast/predict/performance.hpp"
#include "reachcast/predict/stand.hpp"

namespace reachcast {

Vec3 hold_point(const Grips& grips) {
  return 0.5 * (grips[0] + grips[1]);
}

Grips grips_on(const Task& task, Place place) {
  const BoxPose pose =
      place == Place::home ? BoxPose{task.home, task.home_yaw_rad} : BoxPose{task.target, task.target_yaw_rad};
  const Box held = held_by(task.object, task.hands);
  return {grip_of(held, pose, true), grip_of(held, pose, false)};
}

HandEnds hand_ends(const Stage& stage, const Task& task, const Body& body) {
  const Grips here = grips_on(task, stage.object);
  Grips hanging = anchors_of(standing_at_ease(body)).grip;
  if (task.hands != Hands::both) hanging[free_side(task.hands)] = hanging[working_side(task.hands)];
  if (stage.phase == Phase::reach) return {hanging, here};
  if (stage.phase == Phase::return_) return {here, hanging};
  return {here, grips_on(task, other(stage.object))};
}

}  // namespace reachcast
