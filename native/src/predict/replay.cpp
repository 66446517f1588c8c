// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/replay.hpp"

#include "reachcast/curves/bspline.hpp"
#include "reachcast/motion/encode.hpp"
#include "reachcast/posture/free_arm.hpp"

namespace reachcast {
namespace {

constexpr double kShortest_m = 1.2, kTallest_m = 2.2;  // with published proportions

using Rows = Eigen::Matrix<double, kBasisCount, kReplayTimes>;

double time_of(int i) {
  return static_cast<double>(i) / (kReplayTimes - 1);
}

/// The splines at the times of a replay, and what of them the two ends of a blend have a share in.
struct Basis {
  Rows whole, from, to;
  Basis() {
    for (int i = 0; i < kReplayTimes; ++i) {
      const double share = share_of_target(time_of(i));
      whole.col(i) = bspline_row(time_of(i)).transpose();
      from.col(i) = (1.0 - share) * whole.col(i);
      to.col(i) = share * whole.col(i);
    }
  }
};

const Basis& basis() {
  static const Basis made;
  return made;
}

/// One column of spline coefficients for each posture coordinate; they are the tail of a code.
Eigen::Map<const Eigen::MatrixXd> curves_of(const MotionCode& code) {
  const Eigen::Index count = posture_coordinate_count(two_handed_linkage());
  return {code.coefficients.data() + code.coefficients.size() - kBasisCount * count, kBasisCount, count};
}

}  // namespace

std::optional<Replay> Replay::of(const MotionSummary& motion) {
  if (!(motion.subject.stature_m >= kShortest_m && motion.subject.stature_m <= kTallest_m)) return std::nullopt;
  return Replay(motion);
}

Replay::Replay(const MotionSummary& motion)
    : home_(motion.home),
      target_(motion.target),
      half_grip_(0.5 * motion.grip_distance_m, 0.0, 0.0),
      body_(Body::from_stature(motion.subject.stature_m, motion.subject.sex)),
      anchors_(anchors_of(body_.posture(), motion.hands)),
      linkage_(two_handed_linkage(), body_),
      holder_(two_handed_linkage(), body_, usual_mass_kg(motion.subject.stature_m)) {
  if (motion.hands != Hands::both) half_grip_ = Vec3(0.0);
}

bool Replay::perform(const MotionCode& code, PathForm form, ReplayPostures& postures) const {
  const Coordinates coordinates = curves_of(code).transpose().lazyProduct(basis().whole);
  return perform(code, form, coordinates, postures);
}

bool Replay::perform(const Blend& blend, PathForm form, ReplayPostures& postures) const {
  if (const PoseMean poses(blend); poses.exists()) return perform(blend.whole, form, poses, postures);
  Coordinates coordinates = curves_of(blend.from).transpose().lazyProduct(basis().from);
  coordinates += curves_of(blend.to).transpose().lazyProduct(basis().to);
  return perform(blend.whole, form, coordinates, postures);
}

bool Replay::perform(const MotionCode& code, PathForm form, std::span<const double> times,
                     std::span<Posture> postures) const {
  const EndpointWay way = way_of(code, form);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const Eigen::VectorXd coordinates = curves_of(code).transpose() * bspline_row(times[i]).transpose();
    const Anchors anchors = anchors_at(code, way, times[i]);
    if (!hold_at(anchors, linkage_.decode(coordinates, anchors), postures[i])) return false;
  }
  return true;
}

bool Replay::perform(const MotionCode& code, PathForm form, const Coordinates& coordinates,
                     ReplayPostures& postures) const {
  const EndpointWay way = way_of(code, form);
  for (int i = 0; i < kReplayTimes; ++i) {
    const Anchors anchors = anchors_at(code, way, time_of(i));
    if (!hold_at(anchors, linkage_.decode(coordinates.col(i), anchors), postures[static_cast<std::size_t>(i)]))
      return false;
  }
  return true;
}

bool Replay::perform(const MotionCode& code, PathForm form, const PoseMean& poses, ReplayPostures& postures) const {
  const Linkage& linkage = two_handed_linkage();
  const EndpointWay way = way_of(code, form);
  for (int i = 0; i < kReplayTimes; ++i) {
    const Anchors anchors = anchors_at(code, way, time_of(i));
    const TrunkPose pose = poses.at(time_of(i), anchors, linkage, linkage_, body_);
    if (!hold_at(anchors, decoded_of(linkage, body_, pose), postures[static_cast<std::size_t>(i)])) return false;
  }
  return true;
}

Anchors Replay::anchors_at(const MotionCode& code, const EndpointWay& way, double t) const {
  Anchors anchors = anchors_;
  const Vec3 hold = point_at(way, home_, target_, t);
  anchors.grip = {hold - half_grip_, hold + half_grip_};
  if (anchors.hands != Hands::both) {
    const Eigen::Vector3d hang = hang_curves(code) * bspline_row(t).transpose();
    anchors.hang = hang_on(body_, anchors, {hang[0], hang[1], hang[2]});
  }
  return anchors;
}

bool Replay::hold_at(const Anchors& anchors, const Decoded& decoded, Posture& posture) const {
  HoldReport report;
  posture = holder_.hold(decoded, anchors, {0.5 * (anchors.grip[0] + anchors.grip[1]), 0.0}, report);
  return report.shortfall_m == 0.0;
}

double mean_distance(const ReplayPostures& a, const ReplayPostures& b) {
  double sum = 0.0;
  for (std::size_t f = 0; f < a.size(); ++f) {
    double at_time = 0.0;
    for (std::size_t j = 0; j < kRecordedJointCount; ++j) at_time += glm::distance(a[f][j], b[f][j]);
    sum += f == 0 || f + 1 == a.size() ? 0.5 * at_time : at_time;
  }
  return sum / static_cast<double>((a.size() - 1) * kRecordedJointCount);
}

}  // namespace reachcast
