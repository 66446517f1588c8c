// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/capsules.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/common.hpp>

namespace reachcast {
namespace {

/// A point of the body: a weighted sum of joints, the weights adding up to 1.
struct Weighted {
  Joint joint;
  double weight;
};
using Mark = std::array<Weighted, 4>;

struct Shape {
  std::string_view name;
  Mark a, b;
  double radius;  ///< share of stature
};

constexpr Mark at(Joint joint) {
  return {{{joint, 1.0}, {joint, 0.0}, {joint, 0.0}, {joint, 0.0}}};
}

/// `along` of the way from l5s1 to c7t1, then `forward` of that from c7t1 to suprasternale, given as joints whose
/// shares add up; the fourth joint takes a share of the whole to one side.
constexpr Mark in_chest(double along, double forward, double aside, Joint shoulder) {
  return {{{Joint::l5s1, (1.0 - along) * (1.0 - aside)},
           {Joint::c7t1, (along - forward) * (1.0 - aside)},
           {Joint::suprasternale, forward * (1.0 - aside)},
           {shoulder, aside}}};
}

constexpr Mark in_pelvis(double toward, Joint hip, Joint other_hip) {
  return {{{hip, 0.5 + 0.5 * toward}, {other_hip, 0.5 - 0.5 * toward}, {hip, 0.0}, {hip, 0.0}}};
}

/// On the line from c7t1 through the tragion, a little towards the face.
constexpr Mark in_head(double along, double forward) {
  return {
      {{Joint::c7t1, 1.0 - along}, {Joint::tragion, along - forward}, {Joint::nasion, forward}, {Joint::nasion, 0.0}}};
}

// Radii. Girths and depths are means of women and men over mean stature in the ANSUR II survey (Gordon et al. 2014),
// rounded: thigh .38 of stature at the groin and lower thigh .24, calf .224, ankle .131, upper arm .18, forearm .17,
// wrist .098, neck .214 round; waist .137, chest .146, buttocks .141 deep; head .113 long and .088 wide; hand .05 wide.
// A limb is as thick as its mean girth over 2 pi. The trunk's capsules are half its depth less a centimetre of flesh
// that gives way, set apart sideways by what the breadths of waist (.185), chest (.165) and hips (.20) want.
constexpr double kPelvis = 0.062, kWaist = 0.062, kChest = 0.064, kNeck = 0.034, kHead = 0.048;
constexpr double kThigh = 0.045, kShank = 0.029, kUpperArm = 0.028, kForearm = 0.022, kHand = 0.018;

constexpr std::array<Shape, kBodyPartCount> kShapes = [] {
  using enum Joint;
  return std::array<Shape, kBodyPartCount>{
      {{"trunk", in_pelvis(0.75, left_hip, right_hip), in_pelvis(-0.75, left_hip, right_hip), kPelvis},
       {"trunk", in_pelvis(0.5, left_hip, right_hip), in_chest(0.45, 0.5, 0.2, left_shoulder), kWaist},
       {"trunk", in_pelvis(-0.5, left_hip, right_hip), in_chest(0.45, 0.5, 0.2, right_shoulder), kWaist},
       {"trunk", in_chest(0.40, 0.5, 0.2, left_shoulder), in_chest(0.80, 0.35, 0.2, left_shoulder), kChest},
       {"trunk", in_chest(0.40, 0.5, 0.2, right_shoulder), in_chest(0.80, 0.35, 0.2, right_shoulder), kChest},
       {"neck", at(c7t1), at(tragion), kNeck},
       {"head", in_head(0.85, 0.2), in_head(1.25, 0.2), kHead},
       {"left thigh", at(left_hip), at(left_knee), kThigh},
       {"right thigh", at(right_hip), at(right_knee), kThigh},
       {"left shank", at(left_knee), at(left_ankle), kShank},
       {"right shank", at(right_knee), at(right_ankle), kShank},
       {"left upper arm", at(left_shoulder), at(left_elbow), kUpperArm},
       {"right upper arm", at(right_shoulder), at(right_elbow), kUpperArm},
       {"left forearm", at(left_elbow), at(left_wrist), kForearm},
       {"right forearm", at(right_elbow), at(right_wrist), kForearm},
       {"left hand", at(left_wrist), at(left_hand_front), kHand},
       {"right hand", at(right_wrist), at(right_hand_front), kHand}}};
}();

constexpr double kNothing_m = 1e-9;
constexpr double kFurthest_m = 2.0, kWayOut_m = 1e-4;
constexpr int kHalvings = 44;  // of a segment: to 1e-13 of its length

Vec3 point_at(const Mark& mark, const Posture& posture) {
  Vec3 sum(0.0);
  for (const auto& [joint, weight] : mark) {
    if (weight != 0.0) sum += weight * posture[index(joint)];
  }
  return sum;
}

/// Any direction across a line.
Vec3 across(const Vec3& line) {
  const Vec3 off = std::abs(line.z) < std::max(std::abs(line.x), std::abs(line.y)) ? Vec3(0, 0, 1) : Vec3(0, 1, 0);
  const Vec3 out = glm::cross(line, off);
  return glm::length(out) > kNothing_m ? glm::normalize(out) : Vec3(0, 1, 0);
}

/// Nearest points of two segments. Ericson, Real-Time Collision Detection (2005), section 5.1.9.
std::pair<Vec3, Vec3> nearest_points(const Capsule& first, const Capsule& second) {
  const Vec3 u = first.b - first.a, v = second.b - second.a, between = first.a - second.a;
  const double uu = glm::dot(u, u), vv = glm::dot(v, v), uv = glm::dot(u, v);
  const double ub = glm::dot(u, between), vb = glm::dot(v, between);
  const double whole = uu * vv - uv * uv;
  double s = 0.0, t = 0.0;
  if (whole > kNothing_m * uu * vv && whole > 0.0) s = std::clamp((uv * vb - ub * vv) / whole, 0.0, 1.0);
  if (vv > 0.0) t = (uv * s + vb) / vv;
  if (t < 0.0 || t > 1.0 || vv == 0.0) {
    t = std::clamp(t, 0.0, 1.0);
    s = uu > 0.0 ? std::clamp((uv * t - ub) / uu, 0.0, 1.0) : 0.0;
  }
  return {first.a + s * u, second.a + t * v};
}

/// The segment as the box sees it.
Capsule in_frame(const OrientedBox& box, const Capsule& capsule) {
  const Mat3 own = glm::transpose(box.axes);
  return {own * (capsule.a - box.centre), own * (capsule.b - box.centre), capsule.radius_m};
}

/// The point of the segment nearest to the box. The squared distance is convex: its slope changes sign once.
Vec3 nearest_to_box(const Capsule& local, const Vec3& half) {
  const Vec3 line = local.b - local.a;
  const auto outside = [&](const Vec3& p) { return p - glm::clamp(p, -half, half); };
  double first = 0.0, last = 1.0;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (first + last);
    (glm::dot(outside(local.a + middle * line), line) > 0.0 ? last : first) = middle;
  }
  return local.a + 0.5 * (first + last) * line;
}

/// A segment that passes through the box: the nearest face of all points between the two, which is a face of the box
/// or one that an edge and the segment span.
Penetration through_box(const Capsule& local, const Vec3& half) {
  const Vec3 line = local.b - local.a;
  Penetration out{4.0 * (glm::length(half) + glm::length(line)) + local.radius_m, Vec3(1, 0, 0)};
  const auto look = [&](const Vec3& normal) {
    const double way =
        glm::dot(half, glm::abs(normal)) - std::min(glm::dot(normal, local.a), glm::dot(normal, local.b));
    if (way + local.radius_m < out.depth_m) out = {way + local.radius_m, -normal};
  };
  for (int i = 0; i < 3; ++i) {
    Vec3 axis(0.0);
    axis[i] = 1.0;
    Vec3 spanned = glm::cross(axis, line);
    const double size = glm::length(spanned);
    for (const double sign : {1.0, -1.0}) {
      look(sign * axis);
      if (size > kNothing_m) look(sign / size * spanned);
    }
  }
  return out;
}

template <class First>
double way_out_of(First first, const Capsule& second, const Vec3& direction,
                  const std::function<void(First&, const Vec3&)>& move) {
  const auto meets = [&](double way) {
    First there = first;
    move(there, way * direction);
    return penetration(there, second).depth_m > 0.0;
  };
  if (!meets(0.0)) return 0.0;
  double in = 0.0, out = 0.05;
  while (out < kFurthest_m && meets(out)) in = out, out *= 2.0;
  out = std::min(out, kFurthest_m);
  while (out - in > kWayOut_m) (meets(0.5 * (in + out)) ? in : out) = 0.5 * (in + out);
  return out;
}

}  // namespace

std::string_view body_part_name(BodyPart part) {
  return kShapes[index(part)].name;
}

BodyCapsules capsules_of(const Posture& posture, double stature_m) {
  BodyCapsules out;
  for (std::size_t i = 0; i < kBodyPartCount; ++i) {
    out[i] = {point_at(kShapes[i].a, posture), point_at(kShapes[i].b, posture), kShapes[i].radius * stature_m};
  }
  return out;
}

Penetration penetration(const Capsule& first, const Capsule& second) {
  const auto [p, q] = nearest_points(first, second);
  const double apart = glm::distance(p, q), radii = first.radius_m + second.radius_m;
  if (apart > kNothing_m) return {radii - apart, (p - q) / apart};
  const Vec3 normal = glm::cross(first.b - first.a, second.b - second.a);
  const double size = glm::length(normal);
  return {radii, size > kNothing_m ? normal / size : across(second.b - second.a)};
}

Penetration penetration(const OrientedBox& first, const Capsule& second) {
  const Capsule local = in_frame(first, second);
  const Vec3 nearest = nearest_to_box(local, first.half);
  const Vec3 gap = nearest - glm::clamp(nearest, -first.half, first.half);
  const double apart = glm::length(gap);
  Penetration out =
      apart > kNothing_m ? Penetration{local.radius_m - apart, -gap / apart} : through_box(local, first.half);
  out.direction = first.axes * out.direction;
  return out;
}

double way_out(const Capsule& first, const Capsule& second, const Vec3& direction) {
  return way_out_of<Capsule>(first, second, direction, [](Capsule& c, const Vec3& by) { c.a += by, c.b += by; });
}

double way_out(const OrientedBox& first, const Capsule& second, const Vec3& direction) {
  return way_out_of<OrientedBox>(first, second, direction, [](OrientedBox& b, const Vec3& by) { b.centre += by; });
}

bool are_far(const Capsule& first, const Capsule& second, double margin_m) {
  const Vec3 apart = 0.5 * (first.a + first.b - second.a - second.b);
  const double near = 0.5 * (glm::distance(first.a, first.b) + glm::distance(second.a, second.b)) + first.radius_m +
                      second.radius_m + margin_m;
  return glm::dot(apart, apart) > near * near;
}

bool are_far(const OrientedBox& first, const Capsule& second, double margin_m) {
  const Vec3 apart = first.centre - 0.5 * (second.a + second.b);
  const double near = glm::length(first.half) + 0.5 * glm::distance(second.a, second.b) + second.radius_m + margin_m;
  return glm::dot(apart, apart) > near * near;
}

}  // namespace reachcast
