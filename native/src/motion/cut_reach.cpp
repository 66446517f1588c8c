// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/motion/cut_reach.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace reachcast {
namespace {

using enum Joint;

constexpr std::size_t kFewestFrames = 4;
constexpr double kShortest_m = 0.5;
constexpr double kTallest_m = 2.6;
constexpr double kBallHeight = 0.02;    // of stature, above the floor
constexpr double kAnkleHeight = 0.039;  // of stature (Drillis & Contini 1966)

template <typename... Parts>
[[noreturn]] void fail(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  throw std::invalid_argument(text.str());
}

void check_range(const Clip& clip, std::size_t first, std::size_t last, std::size_t fewest) {
  const auto& names = joint_names();
  if (!std::equal(clip.names.begin(), clip.names.end(), names.begin(), names.end())) {
    fail(clip.source, ": the clip is not in the canonical joints; convert it first");
  }
  if (!(clip.rate_hz > 0.0)) fail(clip.source, ": the rate must be over 0 Hz, not ", clip.rate_hz);
  if (clip.frames() == 0) fail(clip.source, ": the clip holds no frames");
  if (first > last || last >= clip.frames()) {
    fail(clip.source, ": frames ", first, " to ", last, " do not lie within 0 to ", clip.frames() - 1);
  }
  if (last - first + 1 < fewest) {
    fail(clip.source, ": frames ", first, " to ", last, " are fewer than the ", fewest, " needed");
  }
}

const Vec3& at(const Clip& clip, std::size_t frame, Joint joint) {
  return clip.at(frame, index(joint));
}

Vec3 level(const Vec3& v) {
  return glm::normalize(Vec3(v.x, v.y, 0.0));
}

Vec3 hold_point(const Clip& clip, std::size_t frame) {
  return (at(clip, frame, left_grip) + at(clip, frame, right_grip)) * 0.5;
}

/// Metres per second at each frame of the range; 0 where a neighbour is missing.
std::vector<double> hand_speeds(const Clip& clip, std::size_t first, std::size_t last) {
  std::vector<double> speeds;
  for (std::size_t frame = first; frame <= last; ++frame) {
    const std::size_t before = frame == first ? frame : frame - 1;
    const std::size_t after = frame == last ? frame : frame + 1;
    const double step_s = static_cast<double>(after - before) / clip.rate_hz;
    const double speed = glm::distance(hold_point(clip, after), hold_point(clip, before)) / step_s;
    speeds.push_back(std::isfinite(speed) ? speed : 0.0);
  }
  return speeds;
}

/// The joint at a frame, bridged by a straight line between its neighbours in the whole clip when it is missing.
Vec3 point_or_bridge(const Clip& clip, std::size_t frame, std::size_t joint, double longest_gap_s) {
  if (is_finite(clip.at(frame, joint))) return clip.at(frame, joint);
  std::size_t before = frame;
  while (before > 0 && !is_finite(clip.at(before, joint))) --before;
  std::size_t after = frame;
  while (after + 1 < clip.frames() && !is_finite(clip.at(after, joint))) ++after;
  const bool has_ends = is_finite(clip.at(before, joint)) && is_finite(clip.at(after, joint));
  const double gap_s = static_cast<double>(after - before - (has_ends ? 1 : 0)) / clip.rate_hz;
  if (!has_ends)
    fail(clip.source, ": ", joint_names()[joint], " is missing from frame ", before, " to ", after,
         ", at an end of the recording");
  // Half a frame of slack: 0.1 s at 30 Hz is 3 frames, whatever the rounding of the rate.
  if (gap_s > longest_gap_s + 0.5 / clip.rate_hz || longest_gap_s <= 0.0) {
    fail(clip.source, ": ", joint_names()[joint], " is missing in frames ", before + 1, " to ", after - 1, ", for ",
         gap_s, " s; at most ", longest_gap_s, " s can be bridged");
  }
  const double share = static_cast<double>(frame - before) / static_cast<double>(after - before);
  return glm::mix(clip.at(before, joint), clip.at(after, joint), share);
}

}  // namespace

BodyFrame body_frame(const Clip& clip, std::size_t frame, double floor_z) {
  check_range(clip, frame, frame, 1);
  const Vec3 hips = level(at(clip, frame, right_hip) - at(clip, frame, left_hip));
  const Vec3 ankles = level(at(clip, frame, right_ankle) - at(clip, frame, left_ankle));
  const Vec3 right = hips + ankles;
  constexpr double least = 0.1;  // two unit vectors more than 174 degrees apart say nothing about facing
  if (!(glm::length(right) > least)) {
    fail(clip.source, ": frame ", frame, ": hips and ankles are missing or face opposite ways, so there is no facing");
  }
  const Vec3 up(0.0, 0.0, 1.0);
  const Vec3 x = glm::normalize(right);
  BodyFrame body;
  body.origin_world = (at(clip, frame, left_ankle) + at(clip, frame, right_ankle)) * 0.5;
  body.origin_world.z = floor_z;
  body.axes_world = Mat3(x, glm::cross(up, x), up);
  return body;
}

double estimate_floor(const Clip& clip, const FrameRange& range, double stature_m) {
  check_range(clip, range.first, range.last, 1);
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t frame = range.first; frame <= range.last; ++frame) {
    const auto lower_to = [&](Joint joint, double height) {
      const Vec3& point = at(clip, frame, joint);
      if (is_finite(point)) lowest = std::min(lowest, point.z - height * stature_m);
    };
    lower_to(left_ball, kBallHeight);
    lower_to(right_ball, kBallHeight);
    lower_to(left_ankle, kAnkleHeight);
    lower_to(right_ankle, kAnkleHeight);
  }
  if (!std::isfinite(lowest)) fail(clip.source, ": no foot is seen in frames ", range.first, " to ", range.last);
  return lowest;
}

Reach cut_reach(const Clip& clip, std::size_t first, std::size_t last, const Subject& subject, Phase phase,
                const std::string& origin, const CutOptions& options) {
  check_range(clip, first, last, kFewestFrames);
  if (!(subject.stature_m >= kShortest_m && subject.stature_m <= kTallest_m)) {
    fail("stature must be ", kShortest_m, " to ", kTallest_m, " m, not ", subject.stature_m);
  }
  if (options.floor_z && !std::isfinite(*options.floor_z)) fail("floor_z must be a finite number");
  Clip part{clip.source, clip.rate_hz, clip.names, clip.derived, {}, {}};
  for (std::size_t frame = first; frame <= last; ++frame) {
    for (std::size_t joint = 0; joint < kJointCount; ++joint) {
      part.positions.push_back(point_or_bridge(clip, frame, joint, options.longest_gap_s));
    }
  }
  const FrameRange whole{0, last - first};
  const double floor_z = options.floor_z ? *options.floor_z : estimate_floor(part, whole, subject.stature_m);
  const BodyFrame body = body_frame(part, 0, floor_z);

  Reach reach;
  reach.subject = subject;
  reach.phase = phase;
  reach.origin = origin.empty() ? clip.source + ':' + std::to_string(first) + '-' + std::to_string(last) : origin;
  reach.duration_s = static_cast<double>(last - first) / clip.rate_hz;
  reach.postures.resize(whole.last + 1);
  for (std::size_t joint = 0; joint < kJointCount; ++joint) {
    reach.derived[joint] = clip.derived[joint];
    for (std::size_t frame = 0; frame <= whole.last; ++frame) {
      reach.postures[frame][joint] = body.to_body(part.at(frame, joint));
    }
  }
  return reach;
}

FrameRange trim_by_hand_speed(const Clip& clip, std::size_t first, std::size_t last, double fraction) {
  check_range(clip, first, last, 2);
  if (!(fraction >= 0.0 && fraction <= 1.0)) fail("fraction must be 0 to 1, not ", fraction);
  const std::vector<double> speeds = hand_speeds(clip, first, last);
  const double peak = *std::max_element(speeds.begin(), speeds.end());
  if (!(peak > 0.0)) fail(clip.source, ": the hands do not move in frames ", first, " to ", last);
  const auto moves = [&](double speed) { return speed >= fraction * peak; };
  const auto begin = std::find_if(speeds.begin(), speeds.end(), moves);
  const auto end = std::find_if(speeds.rbegin(), speeds.rend(), moves);
  return {first + static_cast<std::size_t>(begin - speeds.begin()),
          last - static_cast<std::size_t>(end - speeds.rbegin())};
}

}  // namespace reachcast
