// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/motion/encode.hpp"

#include <stdexcept>

#include "reachcast/curves/bspline.hpp"
#include "reachcast/posture/free_arm.hpp"
#include "reachcast/posture/twist.hpp"
#include "reachcast/posture/whole_body.hpp"

namespace reachcast {
namespace {

// Layout of MotionCode::coefficients: velocity (6), deviation x, y, z (6 each), Bezier offsets (3 each) and exponents
// (2), separation x, y, z (8 each), then posture coordinates, 8 coefficients each, coordinate by coordinate.
constexpr Eigen::Index kPathLength = 4 * kPathBasisCount;
constexpr Eigen::Index kCurveLength = 8;
constexpr Eigen::Index kSeparationStart = kPathLength + kCurveLength;
constexpr Eigen::Index kSeparationLength = 3 * kBasisCount;
constexpr Eigen::Index kPostureStart = kSeparationStart + kSeparationLength;

/// A hang is kept from the left to the right, as the way between two hands is: to the grip of a right arm, from that of
/// a left one. So a mirror changes both alike.
double hang_sign(Hands hands) {
  return hands == Hands::left ? 1.0 : -1.0;
}

/// Half the way between the hands in statures, or how the free arm hangs.
Vec3 separation(const Posture& posture, Hands hands, double stature_m) {
  if (hands != Hands::both) return hang_sign(hands) * relative_hang(posture, hands);
  const Anchors anchors = anchors_of(posture);
  return turned(0.5 * (anchors.grip[1] - anchors.grip[0]), -facing_yaw(anchors)) / stature_m;
}

/// Two hands are kept at a steady distance at both ends; an arm that swings may still do so.
double separation_time(Hands hands, double t) {
  return hands == Hands::both ? resting_time(t) : t;
}

void check(const Reach& reach) {
  const auto fail = [&](const std::string& what) { throw std::invalid_argument(reach.origin + ": " + what); };
  if (reach.frames() < 4) fail("the reach has " + std::to_string(reach.frames()) + " postures; at least 4 are needed");
  if (!(reach.duration_s >= 0.05 && reach.duration_s <= 60.0)) {
    fail("the duration is " + std::to_string(reach.duration_s) + " s; it must lie between 0.05 and 60 s");
  }
  for (std::size_t f = 0; f < reach.frames(); ++f) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      if (!is_finite(reach.postures[f][j])) {
        fail("joint " + std::string(joint_names()[j]) + " is not finite in posture " + std::to_string(f));
      }
    }
  }
}

}  // namespace

Eigen::Index code_length() {
  return kPostureStart + kBasisCount * posture_coordinate_count(two_handed_linkage());
}

MotionCode encode_reach(const Reach& reach) {
  check(reach);
  MotionCode code;
  code.subject = reach.subject;
  code.phase = reach.phase;
  code.hands = reach.hands;
  code.origin = reach.origin;
  code.duration_s = reach.duration_s;
  code.home = reach.hold_point(0);
  code.target = reach.hold_point(reach.frames() - 1);
  const Posture& first = reach.postures.front();
  if (reach.hands == Hands::both)
    code.grip_distance_m = glm::distance(first[index(Joint::left_grip)], first[index(Joint::right_grip)]);
  code.coefficients.resize(code_length());

  Points holds;
  Eigen::MatrixXd separations(reach.frames(), 3), separation_basis(reach.frames(), kBasisCount);
  Eigen::MatrixXd coordinates(reach.frames(), posture_coordinate_count(two_handed_linkage()));
  for (std::size_t f = 0; f < reach.frames(); ++f) {
    holds.push_back(reach.hold_point(f));
    separations.row(static_cast<Eigen::Index>(f)) =
        to_eigen(separation(reach.postures[f], reach.hands, reach.subject.stature_m)).transpose();
    const double t = static_cast<double>(f) / static_cast<double>(reach.frames() - 1);
    separation_basis.row(static_cast<Eigen::Index>(f)) = bspline_row(separation_time(reach.hands, t));
    coordinates.row(static_cast<Eigen::Index>(f)) =
        encode_posture(two_handed_linkage(), reach.postures[f], 0.0, reach.hands).transpose();
  }
  try {
    set_path(code, fit_endpoint_path(holds));
    set_curve(code, fit_axis_curve(holds));
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(reach.origin + ": hold point: " + error.what());
  }
  code.coefficients.segment<kSeparationLength>(kSeparationStart) =
      solve_smooth(separation_basis, separations).reshaped();
  code.coefficients.tail(code_length() - kPostureStart) = fit_bspline(coordinates).reshaped();
  return code;
}

EndpointPath path_of(const MotionCode& code) {
  EndpointPath path;
  path.velocity = code.coefficients.head<kPathBasisCount>();
  path.deviation = code.coefficients.segment<3 * kPathBasisCount>(kPathBasisCount).reshaped(kPathBasisCount, 3);
  return path;
}

void set_path(MotionCode& code, const EndpointPath& path) {
  code.coefficients.head<kPathBasisCount>() = path.velocity;
  code.coefficients.segment<3 * kPathBasisCount>(kPathBasisCount) = path.deviation.reshaped();
}

AxisCurve curve_of(const MotionCode& code) {
  const double* next = code.coefficients.data() + kPathLength;
  AxisCurve curve;
  for (Vec3& offset : curve.offsets) {
    for (int k = 0; k < 3; ++k) offset[k] = *next++;
  }
  curve.speed = {next[0], next[1]};
  return curve;
}

void set_curve(MotionCode& code, const AxisCurve& curve) {
  double* next = code.coefficients.data() + kPathLength;
  for (const Vec3& offset : curve.offsets) {
    for (int k = 0; k < 3; ++k) *next++ = offset[k];
  }
  next[0] = curve.speed.alpha;
  next[1] = curve.speed.beta;
}

MotionCode reversed(const MotionCode& code) {
  MotionCode back = code;
  back.phase = opposite(code.phase);
  back.origin += kBackwards;
  std::swap(back.home, back.target);
  const AxisCurve curve = curve_of(code);
  const auto turn_round = [&](Eigen::Index start, Eigen::Index length, Eigen::Index count) {
    for (Eigen::Index i = 0; i < count; ++i, start += length) {
      back.coefficients.segment(start, length) = code.coefficients.segment(start, length).reverse();
    }
  };
  turn_round(0, kPathBasisCount, 4);
  set_curve(back, {{curve.offsets[1], curve.offsets[0]}, {curve.speed.beta, curve.speed.alpha}});
  turn_round(kSeparationStart, kBasisCount, (code.coefficients.size() - kSeparationStart) / kBasisCount);
  return back;
}

Vec3 separation_at(const MotionCode& code, double t) {
  const LocalBasis local = bspline_local(resting_time(t));
  const double* curves = code.coefficients.data() + kSeparationStart + local.first;
  Vec3 out(0.0);
  for (int k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < local.values.size(); ++i)
      out[k] += local.values[i] * curves[static_cast<std::size_t>(k * kBasisCount) + i];
  }
  return out;
}

HangCurves hang_curves(const MotionCode& code) {
  const double* start = code.coefficients.data() + kSeparationStart;
  return hang_sign(code.hands) * Eigen::Map<const Eigen::Matrix<double, kBasisCount, 3>>(start).transpose();
}

void set_hang(MotionCode& code, const Vec3& relative_hang) {
  for (int k = 0; k < 3; ++k)
    code.coefficients.segment<kBasisCount>(kSeparationStart + k * kBasisCount)
        .setConstant(hang_sign(code.hands) * relative_hang[k]);
}

PostureCurves posture_curves(const MotionCode& code) {
  const Eigen::Index count = posture_coordinate_count(two_handed_linkage());
  const double* start = code.coefficients.data() + kPostureStart;
  return Eigen::Map<const Eigen::MatrixXd>(start, kBasisCount, count).transpose();
}

Eigen::VectorXd coordinates_at(const MotionCode& code, double t) {
  const Eigen::Index count = posture_coordinate_count(two_handed_linkage());
  const Eigen::Map<const Eigen::MatrixXd> curves(code.coefficients.data() + kPostureStart, kBasisCount, count);
  return (bspline_row(t) * curves).transpose();
}

}  // namespace reachcast
