// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/body/body.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace reachcast {
namespace {

/// One landmark of the standing figure as fractions of stature: half distance from the midline, forward, up.
struct Landmark {
  Joint joint;  ///< the right one of a pair, or a midline joint
  double side_female, side_male, forward, up;
};

// Heights and segment lengths: Drillis & Contini (1966) in Winter, Biomechanics and Motor Control (2009), fig. 4.1:
// ankle .039, knee .285, hip .530, shoulder .818 of stature; upper arm .186, forearm .146, hand .108, foot .152.
// Trunk and head landmarks (cervicale .852, suprasternale .815, tragion .926, sellion .934 of stature) and the widths
// of hips and shoulders: mean ratios of the ANSUR II survey (Gordon et al. 2014), moved inwards to the joint centres.
// Depths (forward) are this project's reading of a relaxed stand; they carry no measured authority.
constexpr std::array<Landmark, 9> kLandmarks{{
    {Joint::right_ankle, .052, .052, .000, .039},
    {Joint::right_ball, .058, .058, .072, .012},
    {Joint::right_knee, .052, .051, .010, .285},
    {Joint::right_hip, .053, .050, .012, .530},
    {Joint::l5s1, 0.0, 0.0, -.010, .585},
    {Joint::c7t1, 0.0, 0.0, -.022, .852},
    {Joint::suprasternale, 0.0, 0.0, .030, .815},
    {Joint::tragion, 0.0, 0.0, .012, .926},
    {Joint::nasion, 0.0, 0.0, .066, .934},
}};
constexpr double kShoulderSideFemale = .098, kShoulderSideMale = .107;
constexpr double kShoulderForward = -.004, kShoulderUp = .818;
constexpr double kClavicleRootSide = .014, kClavicleRootForward = .026, kClavicleRootUp = .815;
constexpr double kUpperArm = .186, kForearm = .146, kGripBeyondWrist = .054;  // half of the hand's .108
constexpr double kArmAbduction_rad = 0.44;                                    // the arms of the reference posture
constexpr double kElbowBend_rad = 0.17;

void set_pair(Posture& posture, Joint right, const Vec3& at) {
  posture[index(right)] = at;
  posture[index(mirrored(right))] = Vec3(-at.x, at.y, at.z);
}

void set_arm(Posture& posture, double stature_m) {
  const Vec3 shoulder = posture[index(Joint::right_shoulder)];
  const Vec3 upper(std::sin(kArmAbduction_rad), 0.0, -std::cos(kArmAbduction_rad));
  const Vec3 fore = glm::normalize(upper * std::cos(kElbowBend_rad) + Vec3(0, 1, 0) * std::sin(kElbowBend_rad));
  const Vec3 elbow = shoulder + upper * (kUpperArm * stature_m);
  const Vec3 wrist = elbow + fore * (kForearm * stature_m);
  const Vec3 grip = wrist + fore * (kGripBeyondWrist * stature_m);
  const Vec3 half_hand = fore * (0.25 * kGripBeyondWrist * stature_m);
  set_pair(posture, Joint::right_elbow, elbow);
  set_pair(posture, Joint::right_wrist, wrist);
  set_pair(posture, Joint::right_grip, grip);
  set_pair(posture, Joint::right_hand_front, grip + half_hand);
  set_pair(posture, Joint::right_hand_back, grip - half_hand);
}

/// The segments that lengths() measures and from_lengths() replaces, each from the joint nearer the l5s1 outwards,
/// with the joints that are carried along when its length changes.
struct Segment {
  std::string_view name;
  Joint inner, outer;  ///< the right one of a pair
  bool paired;
};
constexpr std::array<Segment, kLengthCount> kSegments{{
    {"pelvis_width", Joint::left_hip, Joint::right_hip, false},
    {"pelvis", Joint::l5s1, Joint::right_hip, false},
    {"thigh", Joint::right_hip, Joint::right_knee, true},
    {"shank", Joint::right_knee, Joint::right_ankle, true},
    {"foot", Joint::right_ankle, Joint::right_ball, true},
    {"trunk", Joint::l5s1, Joint::c7t1, false},
    {"clavicle", Joint::right_clavicle, Joint::right_shoulder, true},
    {"upper_arm", Joint::right_shoulder, Joint::right_elbow, true},
    {"forearm", Joint::right_elbow, Joint::right_wrist, true},
    {"hand", Joint::right_wrist, Joint::right_grip, true},
    {"neck", Joint::c7t1, Joint::tragion, false},
    {"head", Joint::tragion, Joint::nasion, false},
}};

[[noreturn]] void fail(const std::string& what) {
  throw std::invalid_argument(what);
}

std::string number(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

void check_stature(double stature_m) {
  if (!(stature_m >= 1.2 && stature_m <= 2.2)) {
    fail("stature is " + number(stature_m) + " m; it must lie between 1.2 and 2.2 m");
  }
}

void check_triangle(const Posture& posture, Joint a, Joint b, Joint apex) {
  const Vec3 u = posture[index(b)] - posture[index(a)], v = posture[index(apex)] - posture[index(a)];
  if (glm::length(glm::cross(u, v)) >= 0.01 * glm::length(u) * glm::length(v)) return;
  fail("posture: " + std::string(joint_name(apex)) + " lies on the line from " + std::string(joint_name(a)) + " to " +
       std::string(joint_name(b)) + "; it must stand off it");
}

/// Upright on the origin, facing forward, left on the left.
void check_stand(const Posture& posture, double stature_m) {
  using enum Joint;
  const auto at = [&](Joint j) { return posture[index(j)]; };
  check_triangle(posture, left_hip, right_hip, l5s1);
  check_triangle(posture, l5s1, right_clavicle, c7t1);
  check_triangle(posture, l5s1, left_clavicle, c7t1);
  const Vec3 feet = 0.5 * (at(left_ankle) + at(right_ankle));
  if (std::hypot(feet.x, feet.y) > 0.05 * stature_m) {
    fail("posture: the ankles stand " + number(std::hypot(feet.x, feet.y)) +
         " m from the origin; it lies between them");
  }
  if (at(right_hip).x <= at(left_hip).x) fail("posture: right_hip is left of left_hip; x runs to the right");
  if (at(c7t1).z <= at(l5s1).z) fail("posture: c7t1 is below l5s1; z runs up");
  for (const bool left : {true, false}) {
    const Joint ball = left ? left_ball : right_ball, ankle = left ? left_ankle : right_ankle;
    if (at(ball).y <= at(ankle).y) {
      fail("posture: " + std::string(joint_name(ball)) + " is behind " + std::string(joint_name(ankle)) +
           "; y runs forward");
    }
  }
}

/// A point of the trunk keeps its place relative to the old trunk axis, scaled by the change of the trunk's length.
Posture rebuilt(const Posture& old, const std::map<std::string_view, double>& lengths) {
  Posture fresh = old;
  const auto at = [&](Joint j) -> Vec3& { return fresh[index(j)]; };
  const auto was = [&](Joint j) { return old[index(j)]; };
  const double wide = lengths.at("pelvis_width") / glm::distance(was(Joint::left_hip), was(Joint::right_hip));
  const Vec3 mid_hip = 0.5 * (was(Joint::left_hip) + was(Joint::right_hip));
  for (const Joint hip : {Joint::left_hip, Joint::right_hip}) at(hip) = mid_hip + wide * (was(hip) - mid_hip);
  // l5s1 stays above the hips at the wanted distance from each of them.
  const double half = 0.5 * lengths.at("pelvis_width");
  const double pelvis = lengths.at("pelvis");
  if (pelvis <= half)
    fail("segment pelvis is " + number(pelvis) + " m; it must exceed half of pelvis_width, " + number(half) + " m");
  at(Joint::l5s1) = mid_hip + glm::normalize(was(Joint::l5s1) - mid_hip) * std::sqrt(pelvis * pelvis - half * half);
  const double tall = lengths.at("trunk") / glm::distance(was(Joint::l5s1), was(Joint::c7t1));
  for (const Joint j : {Joint::c7t1, Joint::suprasternale, Joint::left_clavicle, Joint::right_clavicle}) {
    at(j) = at(Joint::l5s1) + tall * (was(j) - was(Joint::l5s1));
  }
  const auto place = [&](Joint inner, Joint outer, double length) {
    at(outer) = at(inner) + glm::normalize(was(outer) - was(inner)) * length;
  };
  for (const Segment& s : kSegments) {
    if (s.name == "pelvis_width" || s.name == "pelvis" || s.name == "trunk") continue;
    place(s.inner, s.outer, lengths.at(s.name));
    if (s.paired) place(mirrored(s.inner), mirrored(s.outer), lengths.at(s.name));
  }
  for (const Joint grip : {Joint::left_grip, Joint::right_grip}) {
    const bool left = grip == Joint::left_grip;
    for (const Joint j : {left ? Joint::left_hand_front : Joint::right_hand_front,
                          left ? Joint::left_hand_back : Joint::right_hand_back}) {
      at(j) = at(grip) + (was(j) - was(grip));
    }
  }
  const Vec3 drop =
      0.5 * (at(Joint::left_ball) + at(Joint::right_ball) - was(Joint::left_ball) - was(Joint::right_ball));
  const Vec3 ankles = 0.5 * (at(Joint::left_ankle) + at(Joint::right_ankle));
  for (Vec3& p : fresh) p -= Vec3(ankles.x, ankles.y, drop.z);
  return fresh;
}

}  // namespace

Posture mirrored(const Posture& posture) {
  Posture out;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const Vec3& other = posture[index(mirrored(static_cast<Joint>(j)))];
    out[j] = Vec3(-other.x, other.y, other.z);
  }
  return out;
}

const std::array<std::string_view, kLengthCount>& segment_names() {
  static const auto names = [] {
    std::array<std::string_view, kLengthCount> out;
    for (std::size_t i = 0; i < kSegments.size(); ++i) out[i] = kSegments[i].name;
    return out;
  }();
  return names;
}

std::array<double, kLengthCount> segment_lengths(const Posture& posture) {
  const auto distance = [&](Joint a, Joint b) { return glm::distance(posture[index(a)], posture[index(b)]); };
  std::array<double, kLengthCount> out{};
  for (std::size_t i = 0; i < kLengthCount; ++i) {
    const Segment& s = kSegments[i];
    const double right = distance(s.inner, s.outer);
    out[i] = s.paired ? 0.5 * (right + distance(mirrored(s.inner), mirrored(s.outer))) : right;
  }
  return out;
}

Body Body::from_stature(double stature_m, std::optional<Sex> sex) {
  check_stature(stature_m);
  const double male = sex ? (*sex == Sex::male ? 1.0 : 0.0) : 0.5;
  const auto mix = [&](double f, double m) { return f + male * (m - f); };
  Posture posture{};
  for (const Landmark& mark : kLandmarks) {
    set_pair(posture, mark.joint, stature_m * Vec3(mix(mark.side_female, mark.side_male), mark.forward, mark.up));
  }
  set_pair(posture, Joint::right_shoulder,
           stature_m * Vec3(mix(kShoulderSideFemale, kShoulderSideMale), kShoulderForward, kShoulderUp));
  set_pair(posture, Joint::right_clavicle, stature_m * Vec3(kClavicleRootSide, kClavicleRootForward, kClavicleRootUp));
  set_arm(posture, stature_m);
  return from_posture(posture, stature_m);
}

Body Body::from_posture(const Posture& posture, double stature_m) {
  if (!(stature_m >= 0.5 && stature_m <= 2.6)) {
    fail("stature is " + number(stature_m) + " m; it must lie between 0.5 and 2.6 m");
  }
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!is_finite(posture[j])) fail("posture: joint " + std::string(joint_names()[j]) + " is not finite");
  }
  const Body body(posture, stature_m);
  const auto check = [&](std::string_view name, Joint inner, Joint outer) {
    const double length = body.distance(inner, outer);
    if (length < 0.01) {
      fail("posture: segment " + std::string(name) + " from " + std::string(joint_name(inner)) + " to " +
           std::string(joint_name(outer)) + " is " + number(length) + " m; it must be at least 0.01 m");
    }
  };
  for (const Segment& s : kSegments) {
    check(s.name, s.inner, s.outer);
    if (s.paired) check(s.name, mirrored(s.inner), mirrored(s.outer));
  }
  check_stand(posture, stature_m);
  return body;
}

Body Body::from_lengths(double stature_m, const std::map<std::string, double>& lengths_m) {
  const Body base = from_stature(stature_m);
  std::map<std::string_view, double> wanted;
  const auto measured = base.lengths();
  for (const Segment& s : kSegments) wanted[s.name] = measured.at(std::string(s.name));
  for (const auto& [name, value] : lengths_m) {
    const auto found = wanted.find(name);
    if (found == wanted.end()) fail("lengths: there is no segment named " + name);
    if (!(value >= 0.01 && value <= 1.5)) {
      fail("lengths: segment " + name + " is " + number(value) + " m; it must lie between 0.01 and 1.5 m");
    }
    found->second = value;
  }
  return from_posture(rebuilt(base.posture(), wanted), stature_m);
}

Body Body::bending_at(const Points& points) const {
  Body out = *this;
  Points& pieces = out.spine_.emplace();
  Vec3 below = at(Joint::l5s1);
  for (const Vec3& point : points) {
    if (!is_finite(point)) fail("spine: point " + std::to_string(pieces.size()) + " is not finite");
    pieces.push_back(point - below);
    below = point;
  }
  pieces.push_back(at(Joint::c7t1) - below);
  return out;
}

Body mirrored(const Body& body) {
  const Body image = Body::from_posture(mirrored(body.posture()), body.stature_m());
  if (!body.spine()) return image;
  Points points;
  Vec3 at = image.at(Joint::l5s1);
  for (const Vec3& piece : *body.spine()) points.push_back(at += Vec3(-piece.x, piece.y, piece.z));
  points.pop_back();
  return image.bending_at(points);
}

std::map<std::string, double> Body::lengths() const {
  std::map<std::string, double> out;
  const auto measured = segment_lengths(posture_);
  for (std::size_t i = 0; i < kLengthCount; ++i) out[std::string(segment_names()[i])] = measured[i];
  return out;
}

}  // namespace reachcast
