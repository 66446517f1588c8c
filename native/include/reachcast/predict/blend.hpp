// SPDX-License-Identifier: GPL-3.0-or-later
/// The neighbours' codes as one (Faraway 2004, section 3.4).
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "reachcast/curves/endpoint_way.hpp"
#include "reachcast/motion/encode.hpp"
#include "reachcast/motion/motion_code.hpp"
#include "reachcast/predict/neighbours.hpp"

namespace reachcast {

/// The posture coordinates of one neighbour over time, and its weights in the means for home and target.
struct PosturePart {
  PostureCurves curves;
  double at_home = 0.0, at_target = 0.0;
};

/// What the neighbours do where the motion begins and where it ends. The posture passes from the one to the other.
struct Blend {
  MotionCode from, to;                ///< means over the neighbours of the home and of the target
  MotionCode whole;                   ///< half of each: path of the hold point and duration
  std::vector<PosturePart> parts;     ///< where poses are averaged and there are several neighbours; else empty
  std::vector<Neighbour> neighbours;  ///< both sets; a motion of both has the mean of its two weights; heaviest first
};

/// Finds a motion's code by its id.
using CodeOf = std::function<std::shared_ptr<const MotionCode>(std::int64_t)>;

/// Paths are carried onto the wanted axis before they are averaged. The duration stays within the neighbours' own,
/// which negative weights could leave. Throws std::invalid_argument as Search does, and for codes of another length
/// than this version's.
[[nodiscard]] Blend blend_neighbours(const MotionTable& table, const Query& query, const Scheme& scheme,
                                     const CodeOf& code_of, const LeftOut& left_out = {});

/// A code and its share of a mean.
struct WeightedCode {
  const MotionCode* code = nullptr;
  double weight = 0.0;
};

/// from, to, whole and parts of a blend, the same for both ends where `at_target` is empty. Memory of `blend` is used again;
/// its neighbours are not touched.
void blend_codes(std::span<const WeightedCode> at_home, std::span<const WeightedCode> at_target, const Query& query,
                 Average postures, Blend& blend);

/// How motions vary about their mean, as one draw of a normal distribution with their covariance (Faraway, Reed, Wang
/// 2007, section 4, of all coefficients at once): normal numbers times each code's difference from the mean, so that no
/// covariance need be made. At least 2 codes, as many numbers. The logarithm of the duration varies alike, but the
/// duration stays within the codes' own.
void vary(std::span<const std::shared_ptr<const MotionCode>> codes, std::span<const double> normal, const Query& query,
          Blend& blend);

/// All but the neighbours played backwards.
void reverse(Blend& blend);

/// The path of the hold point in a code, in this form.
[[nodiscard]] EndpointWay way_of(const MotionCode& code, PathForm form);

/// How much of the posture at scaled time t is that of `to`; the rest is that of `from`.
[[nodiscard]] double share_of_target(double t);

/// Posture coordinates at scaled time t in [0, 1].
[[nodiscard]] Eigen::VectorXd coordinates_at(const Blend& blend, double t);

}  // namespace reachcast
