// SPDX-License-Identifier: GPL-3.0-or-later
/// Canonical joints from recorded points, and estimates of those that recordings leave out.
///
/// The estimates are fixed distances from recorded joints, in units of a segment's median length over the clip, so that
/// derived links keep their length. They come from published averages, as fractions of stature H:
/// - trunk, mid hips to mid shoulders 0.288, shank 0.246, forearm 0.146, hand 0.108, ankle height 0.039
///   (Drillis & Contini 1966);
/// - L5/S1 about 0.058 above and 0.02 behind the hips; C7/T1 0.03 above the shoulders; suprasternale level with the
///   shoulders and 0.025 in front (de Leva 1996: suprasternale 0.296, cervicale 0.347 above the hips; Reed et al.
///   1999: the C7/T1 centre lies halfway from the skin over C7 to the suprasternale, a little above that line);
/// - tragion 0.07 above C7/T1 and a little in front; nasion 0.055 in front of the tragion.
#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include "joint_sources.hpp"
#include "units.hpp"

namespace reachcast {
namespace {

using enum Joint;
using Flags = std::array<bool, kJointCount>;

// Along trunk lengths of 0.288 H.
constexpr double kL5s1Up = 0.20;
constexpr double kL5s1Back = 0.06;
constexpr double kC7t1Up = 0.10;
constexpr double kSuprasternaleForward = 0.085;
constexpr double kTragionUp = 0.24;
constexpr double kTragionForward = 0.05;
constexpr double kNasionUp = 0.03;
constexpr double kNasionForward = 0.19;
// Along forearm lengths of 0.146 H: knuckles 0.067 H beyond the wrist; the grip is half a hand, 0.0575 H, beyond it.
constexpr double kKnuckles = 0.46;
constexpr double kHandBack = 0.33;
constexpr double kHandBackOnHand = 0.7;  // of the way from the wrist to recorded knuckles
// Along shank lengths of 0.246 H: the ball 0.089 H ahead of the ankle and 0.025 H below it.
constexpr double kBallForward = 0.36;
constexpr double kBallDown = 0.10;

struct Segments {
  double trunk_m, shank_m, forearm_m;
};

struct Axes {
  Vec3 right, forward, up;
};

/// `up` is kept; `right` is turned to be perpendicular to it. NaN when the two are parallel.
Axes axes_from(const Vec3& right, const Vec3& up) {
  const Vec3 unit_up = glm::normalize(up);
  const Vec3 unit_right = glm::normalize(right - unit_up * glm::dot(right, unit_up));
  return {unit_right, glm::cross(unit_up, unit_right), unit_up};
}

/// One frame of the result, while it is being completed.
class Pose {
 public:
  Pose(Clip& clip, std::size_t frame, const Flags& recorded, const Segments& segments)
      : points_(&clip.at(frame, 0)), recorded_(recorded), segments_(segments) {}

  void complete() {
    derive_trunk();
    derive_head();
    derive_side(left_ankle, left_elbow, left_wrist, left_hand_front, left_hand_back, left_grip, left_ball);
    derive_side(right_ankle, right_elbow, right_wrist, right_hand_front, right_hand_back, right_grip, right_ball);
  }

 private:
  Vec3& at(Joint joint) { return points_[index(joint)]; }
  Vec3 middle(Joint a, Joint b) { return (at(a) + at(b)) * 0.5; }
  [[nodiscard]] bool has(Joint joint) const { return recorded_[index(joint)]; }
  void set(Joint joint, const Vec3& point) {
    if (!has(joint)) at(joint) = point;
  }

  void derive_trunk() {
    const Vec3 hips = middle(left_hip, right_hip);
    const Vec3 shoulders = middle(left_shoulder, right_shoulder);
    const double trunk = segments_.trunk_m;
    const Axes pelvis = axes_from(at(right_hip) - at(left_hip), shoulders - hips);
    set(l5s1, hips + trunk * (kL5s1Up * pelvis.up - kL5s1Back * pelvis.forward));

    const bool has_collar = has(left_clavicle) && has(right_clavicle);
    const Vec3 base = has_collar ? middle(left_clavicle, right_clavicle) : shoulders;
    const Vec3 right = has_collar ? at(right_clavicle) - at(left_clavicle) : at(right_shoulder) - at(left_shoulder);
    chest_ = axes_from(right, has_collar && has(c7t1) ? at(c7t1) - base : shoulders - hips);
    set(c7t1, base + trunk * kC7t1Up * chest_.up);
    set(suprasternale, base + trunk * kSuprasternaleForward * chest_.forward);
    at(left_clavicle) = at(right_clavicle) = at(suprasternale);
  }

  void derive_head() {
    const double trunk = segments_.trunk_m;
    set(tragion, at(c7t1) + trunk * (kTragionUp * chest_.up + kTragionForward * chest_.forward));
    const Axes head = axes_from(chest_.right, at(tragion) - at(c7t1));
    set(nasion, at(tragion) + trunk * (kNasionUp * head.up + kNasionForward * head.forward));
  }

  void derive_side(Joint ankle, Joint elbow, Joint wrist, Joint front, Joint back, Joint grip, Joint ball) {
    const Vec3 along = glm::normalize(at(wrist) - at(elbow)) * segments_.forearm_m;
    set(front, at(wrist) + kKnuckles * along);
    set(back, has(front) ? glm::mix(at(wrist), at(front), kHandBackOnHand) : at(wrist) + kHandBack * along);
    set(grip, middle(front, back));
    set(ball, at(ankle) + segments_.shank_m * (kBallForward * heading() - Vec3(0.0, 0.0, kBallDown)));
  }

  /// Horizontal and forward: perpendicular to hips and ankles, which count alike.
  Vec3 heading() {
    const auto level = [](Vec3 v) { return glm::normalize(Vec3(v.x, v.y, 0.0)); };
    const Vec3 right = level(at(right_hip) - at(left_hip)) + level(at(right_ankle) - at(left_ankle));
    return glm::cross(Vec3(0.0, 0.0, 1.0), glm::normalize(right));
  }

  Vec3* points_;
  const Flags& recorded_;
  const Segments& segments_;
  Axes chest_{};
};

/// Median of the finite values; NaN when there are none.
template <typename Length>
double median_over_frames(std::size_t frames, Length length_at) {
  std::vector<double> lengths;
  for (std::size_t frame = 0; frame < frames; ++frame) lengths.push_back(length_at(frame));
  return median_of(lengths);
}

Segments measure(const Clip& clip) {
  const auto point = [&](std::size_t frame, Joint joint) { return clip.at(frame, index(joint)); };
  const auto link = [&](Joint a, Joint b, Joint c, Joint d) {
    return 0.5 * median_over_frames(clip.frames(), [&](std::size_t frame) {
             return glm::distance(point(frame, a), point(frame, b)) + glm::distance(point(frame, c), point(frame, d));
           });
  };
  const double trunk_m = median_over_frames(clip.frames(), [&](std::size_t frame) {
    return 0.5 * glm::length(point(frame, left_shoulder) + point(frame, right_shoulder) - point(frame, left_hip) -
                             point(frame, right_hip));
  });
  return {trunk_m, link(left_knee, left_ankle, right_knee, right_ankle),
          link(left_elbow, left_wrist, right_elbow, right_wrist)};
}

/// F * 27 flags: see to_canonical. Empty where nothing was filled.
std::vector<std::uint8_t> filled_joints(const Clip& clip, const JointSources& sources) {
  if (clip.filled.empty()) return {};
  std::vector<std::uint8_t> filled(clip.frames() * kJointCount, 0);
  for (std::size_t frame = 0; frame < clip.frames(); ++frame) {
    std::uint8_t* const flags = &filled[frame * kJointCount];
    for (std::size_t joint = 0; joint < kJointCount; ++joint) {
      for (const std::size_t point : sources[joint].points) flags[joint] |= clip.filled[frame * clip.joints() + point];
    }
    const bool is_any = std::any_of(flags, flags + kJointCount, [](std::uint8_t flag) { return flag != 0; });
    for (std::size_t joint = 0; joint < kJointCount; ++joint) {
      if (sources[joint].empty() && is_any) flags[joint] = 1;
    }
  }
  return filled;
}

}  // namespace

Clip to_canonical(const Clip& clip, const JointMap& map) {
  check_joint_map(map);
  const JointSources sources = find_sources(clip, map);
  if (const std::string missing = missing_joints(sources); !missing.empty()) {
    throw std::invalid_argument(clip.source + ": the joint map '" + map.name + "' finds no point for " + missing);
  }
  Clip result{clip.source, clip.rate_hz, {}, {}, Points(clip.frames() * kJointCount), clip.channels};
  result.filled = filled_joints(clip, sources);
  Flags recorded{};
  for (std::size_t joint = 0; joint < kJointCount; ++joint) {
    const FoundSource& source = sources[joint];
    recorded[joint] = !source.empty();
    result.names.emplace_back(joint_names()[joint]);
    result.derived.push_back(source.points.size() != 1 || source.has_offset() ||
                             clip.derived.at(source.points.front()));
  }
  result.derived[index(left_clavicle)] = result.derived[index(right_clavicle)] = true;
  for (std::size_t frame = 0; frame < clip.frames(); ++frame) {
    for (std::size_t joint = 0; joint < kJointCount; ++joint) {
      result.at(frame, joint) = joint_centre(clip, frame, sources[joint]);
    }
  }
  const Segments segments = measure(result);
  for (std::size_t frame = 0; frame < clip.frames(); ++frame) Pose(result, frame, recorded, segments).complete();
  return result;
}

}  // namespace reachcast
