// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/simulate/effort.hpp"

#include <algorithm>
#include <cmath>

#include "reachcast/posture/rigid_motion.hpp"
#include "reachcast/posture/twist.hpp"

namespace reachcast::simulate {
namespace {

using enum Joint;

constexpr double kDegree = kPi / 180.0;

/// Where a joint is at ease and how far it goes, degrees.
struct Range {
  double neutral, low, high;
};

// How far people go: American Academy of Orthopaedic Surgeons (1965) for hip 120, knee 135, elbow 150, lumbar 75 (here
// all of pelvis to chest), neck 45 each way; with the heel down and the knee bent under the body's weight a shin leans
// forward to about 40. Elbow and wrist were checked in later tables that quote the book, the rest is cited from memory;
// reference values of Soucie et al. (2011) are of the same size. Neutral angles are this project's: chosen so that lifts come out as
// recorded ones do. The neutral elbow is bent, as people carry.
constexpr Range kAnkle{0, -20, 40}, kKnee{8, 2, 135}, kHip{4, -15, 132};
constexpr Range kBackForward{2, -20, 65}, kBackSideways{0, -30, 30}, kBackTwist{0, -40, 40};
constexpr Range kShoulder{12, -10, 170}, kAbduction{10, -10, 80}, kElbow{34, 7, 140}, kWrist{0, -70, 70};
constexpr Range kRaise{0, -8, 30}, kForward{0, -20, 30}, kNeckPitch{4, -45, 50}, kNeckYaw{0, -65, 65};
constexpr Range kKneesApart{9, -2, 35}, kElbowsApart{22, 0, 75}, kPelvisYaw{0, -50, 50};

// An average man's, newton metres: of the size that Chaffin and Andersson's tables give for trunk extension, knee
// extension and shoulder flexion (not checked against the book).
constexpr double kBackStrength = 240.0, kBackSideStrength = 150.0, kKneeStrength = 170.0, kShoulderStrength = 75.0;

// Hamstrings span hip and knee: with a straight knee people raise a leg to some 80 degrees, with a bent one to 120.
constexpr double kHamstringsAtKnee = 0.5, kHamstringsSlack_rad = 45 * kDegree, kHamstrings_rad = 35 * kDegree;

constexpr double kLeanBack = 0.15;     // sine of a lean that costs as much as the half range of a joint
constexpr double kBarrier_rad = 0.07;  // how far beyond its range a joint costs as much as a whole half range
constexpr double kFootFront = 0.072;   // of stature: the balls ahead of the ankles
constexpr double kHeel_m = 0.03;
constexpr double kMiddle = 0.4;  // where between heel and ball people like their weight
constexpr double kGazeScale_rad = 0.35, kHoldScale_m = 0.01, kInTheWay_m = 0.02;
constexpr Vec3 kHalfBox(0.18, 0.14, 0.12);  // task.hpp: 0.36 x 0.28 x 0.24 m, handles half way up

double beyond(double value) {
  return std::max(value, 0.0);
}

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// Writes residuals one after the other.
class Writer {
 public:
  explicit Writer(Residuals& out) : out_(out) {}
  void add(double value) { out_[next_++] = value; }
  /// Discomfort of an angle within its range, and a steep part beyond it.
  void joint(double rad, const Range& range, double flexibility, double weight) {
    const double half = 0.5 * (range.high - range.low) * kDegree * flexibility;
    const double low = range.low * kDegree * flexibility, high = range.high * kDegree * flexibility;
    const double over = (beyond(rad - high) - beyond(low - rad)) / kBarrier_rad;
    add(weight * (rad - range.neutral * kDegree) / half + over);
  }
  [[nodiscard]] Eigen::Index written() const { return next_; }

 private:
  Residuals& out_;
  Eigen::Index next_ = 0;
};

/// How deep a ball lies in the box, smoothly: 0 outside.
double depth_in_box(const Vec3& centre, double radius_m, const BoxPlace& box) {
  const Vec3 away = centre - box.hold;
  const double c = std::cos(box.yaw_rad), s = std::sin(box.yaw_rad);
  const Vec3 local(c * away.x + s * away.y, -s * away.x + c * away.y, away.z);
  const double across = kHalfBox.x + radius_m - std::abs(local.x);
  const double back = local.y + kHalfBox.y + radius_m;  // the body is behind the box: only that side counts
  const double tall = kHalfBox.z + radius_m - std::abs(local.z);
  if (across <= 0.0 || back <= 0.0 || tall <= 0.0) return 0.0;
  return 1.0 / (1.0 / across + 1.0 / back + 1.0 / tall);
}

void add_box_depths(const Posture& p, const BoxPlace& box, Writer& out) {
  const auto add = [&](const Vec3& centre, double radius) { out.add(depth_in_box(centre, radius, box) / kInTheWay_m); };
  for (const bool left : {true, false}) {
    const Vec3 hip = p[index(left ? left_hip : right_hip)], knee = p[index(left ? left_knee : right_knee)];
    add(knee, 0.06);
    add(glm::mix(hip, knee, 0.6), 0.07);
  }
  for (const double along : {0.05, 0.5, 0.95}) add(glm::mix(p[index(l5s1)], p[index(suprasternale)], along), 0.11);
}

}  // namespace

EffortWeights weights_of(const Person& person) {
  EffortWeights w;
  const double squat = person.squatting;
  w.back = 1.15 * std::exp(0.45 * squat);
  w.trunk_bend = 1.1 * std::exp(0.35 * squat);
  w.hamstrings = 1.3 * std::exp(0.3 * squat);
  w.knees = 0.9 * std::exp(-0.45 * squat);
  w.knee_bend = 0.85 * std::exp(-0.35 * squat);
  w.shoulders = 0.8;
  return w;
}

JointAngles joint_angles(const Pose& pose) {
  const Posture& p = pose.posture;
  const Mat3 &pelvis = pose.frames.pelvis, &chest = pose.frames.chest;
  JointAngles out;
  for (const std::size_t side : {0u, 1u}) {
    const auto of = [&](Joint left) { return p[index(side == 0 ? left : mirrored(left))]; };
    const Vec3 shank = of(left_knee) - of(left_ankle), thigh = of(left_knee) - of(left_hip);
    const Vec3 upper = of(left_elbow) - of(left_shoulder), fore = of(left_wrist) - of(left_elbow);
    const Vec3 foot = of(left_ball) - of(left_ankle);
    const double forward = std::hypot(foot.x, foot.y);
    out.ankle[side] = std::atan2((shank.x * foot.x + shank.y * foot.y) / forward, shank.z);
    out.knee[side] = angle_between(thigh, -shank);
    out.hip[side] = std::atan2(glm::dot(thigh, pelvis[1]), -glm::dot(thigh, pelvis[2]));
    const Vec3 arm = glm::normalize(upper);
    out.shoulder[side] = angle_between(arm, -chest[2]);
    out.abduction[side] = std::asin(std::clamp((side == 0 ? -1.0 : 1.0) * glm::dot(arm, chest[0]), -1.0, 1.0));
    out.elbow[side] = angle_between(upper, fore);
    out.wrist[side] = angle_between(fore, of(left_grip) - of(left_wrist));
  }
  const Vec3 turn = rotation_vector(glm::quat_cast(glm::transpose(pelvis) * chest));
  out.back = {-turn.x, turn.y, turn.z};
  return out;
}

Effort::Effort(const Person& person, const PoseModel& model, const EffortWeights& weights)
    : model_(model), weights_(weights), strength_(person.strength), flexibility_(person.flexibility) {}

Residuals Effort::residuals(const Unknowns& x, const Holding& holding, const Habit& habit) const {
  const Pose pose = model_.pose(x, holding.anchors, holding.load);
  const Posture& p = pose.posture;
  const EffortWeights& w = weights_;
  Residuals out = Residuals::Zero();
  Writer write(out);

  const JointAngles angles = joint_angles(pose);
  const double f = flexibility_, d = w.discomfort;
  for (const std::size_t side : {0u, 1u}) {
    write.joint(angles.ankle[side], kAnkle, f, 0.6 * d * w.knee_bend);
    write.joint(angles.knee[side], kKnee, f, 0.7 * d * w.knee_bend);
    write.joint(angles.hip[side], kHip, f, 0.5 * d * w.trunk_bend);
    write.joint(angles.shoulder[side], kShoulder, f, 0.7 * d);
    write.joint(angles.abduction[side], kAbduction, f, 0.5 * d);
    write.joint(angles.elbow[side], kElbow, f, 0.9 * d);
    write.joint(angles.wrist[side], kWrist, f, 0.6 * d);
  }
  for (const std::size_t side : {0u, 1u}) {
    const double pull = angles.hip[side] - kHamstringsAtKnee * angles.knee[side] - kHamstringsSlack_rad * f;
    write.add(0.9 * d * w.hamstrings * beyond(pull) / kHamstrings_rad);
  }
  write.joint(angles.back.x, kBackForward, f, 1.1 * d * w.trunk_bend);
  write.joint(angles.back.y, kBackSideways, f, 0.7 * d);
  write.joint(angles.back.z, kBackTwist, f, 0.7 * d);
  write.joint(at(x, Unknown::shoulder_raise), kRaise, f, 0.5 * d);
  write.joint(at(x, Unknown::shoulder_forward), kForward, f, 0.5 * d);
  write.joint(at(x, Unknown::neck_pitch), kNeckPitch, f, 0.45 * d);
  write.joint(at(x, Unknown::neck_yaw), kNeckYaw, f, 0.45 * d);
  write.joint(at(x, Unknown::knees_apart), kKneesApart, f, 0.5 * d);
  write.joint(at(x, Unknown::elbows_apart), kElbowsApart, f, 0.5 * d);
  write.joint(at(x, Unknown::pelvis_yaw), kPelvisYaw, f, 0.7 * d);

  // Nobody leans back to balance what is held out ahead by more than a little.
  const Vec3 ahead_of_person = turned(Vec3(0, 1, 0), facing_yaw(holding.anchors));
  write.add(1.2 * d * beyond(-glm::dot(pose.frames.chest[2], ahead_of_person)) / kLeanBack);

  const JointMoments moments = joint_moments(pose, model_.body_mass_kg(), holding);
  write.add(w.back * moments.back_forward / (kBackStrength * strength_));
  write.add(w.back * moments.back_sideways / (kBackSideStrength * strength_));
  for (const std::size_t side : {0u, 1u}) {
    write.add(w.knees * moments.knee[side] / (kKneeStrength * strength_));
    write.add(w.shoulders * moments.shoulder[side] / (kShoulderStrength * strength_));
  }

  const Vec3 centre = centre_of_mass(p, model_.body_mass_kg(), holding.load);
  const double front = kFootFront * model_.body().stature_m();
  const double ahead = (centre.y - kMiddle * (front - kHeel_m)) / (0.5 * (front + kHeel_m));
  const double aside = centre.x / std::abs(holding.anchors.ankle[1].x);
  for (const double off : {ahead, aside}) {
    write.add(0.6 * w.balance * off);
    write.add(5.0 * (beyond(off - 0.8) - beyond(-0.8 - off)));
  }

  const Vec3 wanted = glm::normalize(holding.looked_at - p[index(nasion)]);
  for (const std::size_t off_axis : {0u, 2u}) {
    write.add(0.35 * w.gaze * glm::dot(wanted, pose.frames.head[static_cast<int>(off_axis)]) / kGazeScale_rad);
  }
  write.add(pose.held.trunk_shift_m / kHoldScale_m);
  if (holding.box) add_box_depths(p, *holding.box, write);
  out.tail<kUnknowns>() = habit.weight * (x - habit.towards);
  return out;
}

}  // namespace reachcast::simulate
