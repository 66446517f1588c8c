// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/motion/encode.hpp"

#include <algorithm>
#include <stdexcept>

#include "reachcast/curves/bspline.hpp"
#include "reachcast/motion/code_layout.hpp"
#include "reachcast/motion/code_ways.hpp"
#include "reachcast/motion/endpoint_move.hpp"
#include "reachcast/posture/twist.hpp"
#include "reachcast/posture/whole_body.hpp"

namespace reachcast {
namespace {

Vec3 separation(const Posture& posture) {
  const Anchors anchors = anchors_of(posture);
  return turned(0.5 * (anchors.grip[1] - anchors.grip[0]), -facing_yaw(anchors));
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

/// The torso's length over time as a share of its longest, and how long the segments are.
void measure_body(const Reach& reach, MotionCode& code) {
  const auto names = segment_names();
  const std::size_t trunk = static_cast<std::size_t>(std::find(names.begin(), names.end(), "trunk") - names.begin());
  std::array<double, kLengthCount> mean{};
  Eigen::MatrixXd torso(reach.frames(), 1);
  for (std::size_t f = 0; f < reach.frames(); ++f) {
    const std::array<double, kLengthCount> now = segment_lengths(reach.postures[f]);
    torso(static_cast<Eigen::Index>(f), 0) = now[trunk];
    for (std::size_t i = 0; i < kLengthCount; ++i) mean[i] += now[i] / static_cast<double>(reach.frames());
  }
  mean[trunk] = torso.maxCoeff();
  code.coefficients.segment<kBasisCount>(layout::kTorso) = fit_bspline(torso / mean[trunk]);
  for (std::size_t i = 0; i < kLengthCount; ++i)
    code.coefficients[layout::kLengths + static_cast<Eigen::Index>(i)] = mean[i] / reach.subject.stature_m;
}

}  // namespace

Eigen::Index code_length() {
  return layout::kPosture + kBasisCount * posture_coordinate_count(two_handed_linkage());
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
  code.grip_distance_m = glm::distance(first[index(Joint::left_grip)], first[index(Joint::right_grip)]);
  code.coefficients.resize(code_length());

  Points holds;
  Eigen::MatrixXd separations(reach.frames(), 3), resting_basis(reach.frames(), kBasisCount);
  Eigen::MatrixXd coordinates(reach.frames(), posture_coordinate_count(two_handed_linkage()));
  for (std::size_t f = 0; f < reach.frames(); ++f) {
    holds.push_back(reach.hold_point(f));
    separations.row(static_cast<Eigen::Index>(f)) =
        to_eigen(separation(reach.postures[f]) / reach.subject.stature_m).transpose();
    resting_basis.row(static_cast<Eigen::Index>(f)) =
        bspline_row(resting_time(static_cast<double>(f) / static_cast<double>(reach.frames() - 1)));
    coordinates.row(static_cast<Eigen::Index>(f)) = encode_posture(two_handed_linkage(), reach.postures[f]).transpose();
  }
  try {
    set_path(code, fit_endpoint_path(holds));
    set_curve(code, fit_axis_curve(holds));
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(reach.origin + ": hold point: " + error.what());
  }
  code.coefficients.segment<3 * kBasisCount>(layout::kSeparation) = solve_smooth(resting_basis, separations).reshaped();
  set_foot_moves(code, foot_moves_of(reach));
  set_pelvis_move(code, pelvis_move_of(reach));
  measure_body(reach, code);
  code.coefficients.tail(code_length() - layout::kPosture) = fit_bspline(coordinates).reshaped();
  return code;
}

EndpointPath path_of(const MotionCode& code) {
  return layout::path_at(code.coefficients, layout::kHoldWay);
}

void set_path(MotionCode& code, const EndpointPath& path) {
  layout::put_path(path, code.coefficients, layout::kHoldWay);
}

AxisCurve curve_of(const MotionCode& code) {
  return layout::curve_at(code.coefficients, layout::kHoldWay + layout::kPathLength);
}

void set_curve(MotionCode& code, const AxisCurve& curve) {
  layout::put_curve(curve, code.coefficients, layout::kHoldWay + layout::kPathLength);
}

double torso_at(const MotionCode& code, double t) {
  const LocalBasis local = bspline_local(t);
  double share = 0.0;
  for (std::size_t i = 0; i < local.values.size(); ++i)
    share += local.values[i] * code.coefficients[layout::kTorso + local.first + static_cast<Eigen::Index>(i)];
  return share;
}

std::array<double, kLengthCount> lengths_of(const MotionCode& code) {
  std::array<double, kLengthCount> lengths{};
  for (std::size_t i = 0; i < kLengthCount; ++i)
    lengths[i] = code.coefficients[layout::kLengths + static_cast<Eigen::Index>(i)];
  return lengths;
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
  turn_round(layout::kSeparation, kBasisCount, 3);
  std::array<EndpointMove, 2> feet = foot_moves_of(code);
  for (EndpointMove& move : feet) move = reversed(move);
  set_foot_moves(back, feet);
  set_pelvis_move(back, reversed(pelvis_move_of(code)));
  turn_round(layout::kTorso, kBasisCount, 1);
  turn_round(layout::kPosture, kBasisCount, (code.coefficients.size() - layout::kPosture) / kBasisCount);
  return back;
}

Vec3 separation_at(const MotionCode& code, double t) {
  const LocalBasis local = bspline_local(resting_time(t));
  const double* curves = code.coefficients.data() + layout::kSeparation + local.first;
  Vec3 out(0.0);
  for (int k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < local.values.size(); ++i)
      out[k] += local.values[i] * curves[static_cast<std::size_t>(k * kBasisCount) + i];
  }
  return out;
}

PostureCurves posture_curves(const MotionCode& code) {
  const Eigen::Index count = posture_coordinate_count(two_handed_linkage());
  const double* start = code.coefficients.data() + layout::kPosture;
  return Eigen::Map<const Eigen::MatrixXd>(start, kBasisCount, count).transpose();
}

Eigen::VectorXd coordinates_at(const MotionCode& code, double t) {
  const Eigen::Index count = posture_coordinate_count(two_handed_linkage());
  const Eigen::Map<const Eigen::MatrixXd> curves(code.coefficients.data() + layout::kPosture, kBasisCount, count);
  return (bspline_row(t) * curves).transpose();
}

}  // namespace reachcast
