// SPDX-License-Identifier: GPL-3.0-or-later
/// From a recording to one labelled phase in the body frame. Nothing is smoothed.
///
/// Clips here are canonical (see to_canonical): exactly the joints of joint_names(), in order, metres, z up.
/// Frame ranges include both ends. Every function throws std::invalid_argument for a clip that is not canonical and for
/// frames outside it.
#pragma once

#include <optional>
#include <string>

#include "reachcast/mocap/clip.hpp"
#include "reachcast/motion/reach.hpp"

namespace reachcast {

struct FrameRange {
  std::size_t first = 0;
  std::size_t last = 0;
};

/// Where the body frame lies in the world of a recording.
struct BodyFrame {
  Vec3 origin_world{0.0};
  Mat3 axes_world{1.0};  ///< columns: right, forward, up

  [[nodiscard]] Vec3 to_body(const Vec3& point_world) const {
    return glm::transpose(axes_world) * (point_world - origin_world);
  }
};

/// The body frame at a frame: origin below the middle of the ankles at height floor_z, up vertical, right the
/// horizontal direction from left to right of hips and ankles, which count alike. Throws when those points are missing
/// or hips and ankles face opposite ways.
[[nodiscard]] BodyFrame body_frame(const Clip& clip, std::size_t frame, double floor_z);

/// Height of the floor that the feet stand on: the lowest of the balls less 0.02 statures and the ankles less 0.039,
/// over the range. Throws when no foot is seen.
[[nodiscard]] double estimate_floor(const Clip& clip, const FrameRange& range, double stature_m);

struct CutOptions {
  std::optional<double> floor_z;  ///< metres in the world of the recording; empty: estimate_floor over the range
  double longest_gap_s = 0.1;     ///< gaps up to this long are bridged by straight lines; 0 allows none
};

/// Frames first to last as a Reach. `origin` is kept as given; empty, it becomes "source:first-last". Throws
/// std::invalid_argument when the range has fewer than 4 frames, when stature is not 0.5 to 2.6 m, and when a joint is
/// missing for longer than allowed, or at an end of the clip: joint, frames and length of the gap are named.
[[nodiscard]] Reach cut_reach(const Clip& clip, std::size_t first, std::size_t last, const Subject& subject,
                              Phase phase, const std::string& origin = {}, const CutOptions& options = {});

/// The part of the range between the first and the last frame at which the hold point (midpoint of the grips) moves at
/// least at `fraction` (0 to 1) of its peak speed in the range. Speeds are central differences; frames without a hold
/// point count as still. Throws when the hold point never moves.
[[nodiscard]] FrameRange trim_by_hand_speed(const Clip& clip, std::size_t first, std::size_t last,
                                            double fraction = 0.1);

}  // namespace reachcast
