// SPDX-License-Identifier: GPL-3.0-or-later
/// The posture of least effort: Levenberg's damped Gauss-Newton steps (1944) on the residuals, with central
/// differences.
#pragma once

#include <functional>

#include "reachcast/simulate/effort.hpp"

namespace reachcast::simulate {

using ResidualFunction = std::function<Residuals(const Unknowns&)>;
using Jacobian = Eigen::Matrix<double, kResiduals, kUnknowns>;

/// Central differences.
[[nodiscard]] Jacobian jacobian_of(const ResidualFunction& residuals, const Unknowns& x);

struct Solution {
  Unknowns x{Unknowns::Zero()};
  double cost = 0.0;
  int steps = 0;
};

/// From `start`; ends when a step promises or brings less than 1e-8 of the cost, or after `most_steps`.
[[nodiscard]] Solution least_squares(const ResidualFunction& residuals, const Unknowns& start, int most_steps);

/// Of several starts the cheapest end; ties go to the first.
[[nodiscard]] Solution least_effort(const Effort& effort, const Holding& holding);
/// From where a neighbouring moment's solution is.
[[nodiscard]] Solution least_effort(const Effort& effort, const Holding& holding, const Unknowns& start,
                                    const Habit& habit = {});

}  // namespace reachcast::simulate
