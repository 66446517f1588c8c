// SPDX-License-Identifier: GPL-3.0-or-later
/// What is to be done: an object held by both hands, or by one, goes from home to target.
#pragma once

#include "reachcast/body/hands.hpp"
#include "reachcast/conventions.hpp"

namespace reachcast {

/// A box. Its origin is the centre of its base, its x axis runs from the left handle to the right one. The handles are
/// `handle_height_m` above the base, `grip_distance_m` apart. One hand alone holds it in its middle, at that height; a
/// cylinder is a box as wide and as deep as its diameter.
struct Box {
  double width_m = 0.36;          ///< along x, > 0
  double depth_m = 0.28;          ///< along y, > 0
  double height_m = 0.24;         ///< > 0
  double handle_height_m = 0.12;  ///< 0 to height_m
  double grip_distance_m = 0.40;  ///< between the grips; at least 0.02
  double mass_kg = 5.0;           ///< 0 to 200
};

struct Task {
  Vec3 home{0.0};             ///< origin of the box at the start, body frame
  Vec3 target{0.0};           ///< origin of the box at the end, body frame
  double home_yaw_rad = 0.0;  ///< turn of the box about the vertical; 0: its x is the subject's right
  double target_yaw_rad = 0.0;
  Box object;
  Hands hands = Hands::both;  ///< which hold it, come for it and leave it
};

/// Where the box is at some moment. It stays level.
struct BoxPose {
  Vec3 position{0.0};
  double yaw_rad = 0.0;
};

/// Centre of the left or right grip for a box there.
[[nodiscard]] Vec3 grip_of(const Box& box, const BoxPose& pose, bool left);

/// The object as these hands hold it: one hand has both grips in the middle.
[[nodiscard]] Box held_by(const Box& box, Hands hands);

/// Throws std::invalid_argument naming the field, its value and the limit.
void check(const Task& task);

}  // namespace reachcast
