// SPDX-License-Identifier: GPL-3.0-or-later
/// A reach in, its motion code out (Faraway 2004, sections 3.1-3.3), and the parts of a code by name.
#pragma once

#include <array>

#include "reachcast/body/body.hpp"
#include "reachcast/curves/bspline.hpp"
#include "reachcast/curves/endpoint_way.hpp"
#include "reachcast/motion/motion_code.hpp"

namespace reachcast {

/// Number of coefficients of a code: the path of the hold point, both as in the 2004 paper and as in that of 2007, how
/// the hands part, what the feet do, how long torso and segments are, then eight per posture coordinate
/// (code_layout.hpp).
[[nodiscard]] Eigen::Index code_length();

/// Throws std::invalid_argument naming the origin of the reach when it has fewer than 4 postures, a value that is not
/// finite, a duration outside 0.05 to 60 s, or a hold point that ends within 1 cm of where it began.
[[nodiscard]] MotionCode encode_reach(const Reach& reach);

/// The path of the hold point kept in a code.
[[nodiscard]] EndpointPath path_of(const MotionCode& code);
void set_path(MotionCode& code, const EndpointPath& path);
/// The same path as a Bezier curve.
[[nodiscard]] AxisCurve curve_of(const MotionCode& code);
void set_curve(MotionCode& code, const AxisCurve& curve);

/// The same motion played backwards, as encode_reach(reversed(reach)) has it: splines are the same from either end.
[[nodiscard]] MotionCode reversed(const MotionCode& code);

/// Half the way from the left grip to the right one at scaled time t, in statures, as seen by a person who faces the
/// hold point (facing_yaw). With the path of the hold point between them it is the path of either hand; on a box that
/// both hold it is how the box turns.
[[nodiscard]] Vec3 separation_at(const MotionCode& code, double t);

/// Length of the torso, l5s1 to c7t1, at scaled time t, as a share of its longest in the motion.
[[nodiscard]] double torso_at(const MotionCode& code, double t);

/// The segments' lengths in the order of segment_names, in statures; of the torso its longest.
[[nodiscard]] std::array<double, kLengthCount> lengths_of(const MotionCode& code);

/// Control points of the posture coordinates (two_handed_linkage): a column for each of the eight B-splines.
using PostureCurves = Eigen::Matrix<double, Eigen::Dynamic, kBasisCount>;
[[nodiscard]] PostureCurves posture_curves(const MotionCode& code);

/// Posture coordinates (two_handed_linkage) at scaled time t.
[[nodiscard]] Eigen::VectorXd coordinates_at(const MotionCode& code, double t);

}  // namespace reachcast
