// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/simulate/solve.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>

#include "reachcast/posture/twist.hpp"

namespace reachcast::simulate {
namespace {

constexpr double kDifference = 1e-5;
constexpr double kGain = 1e-8;
constexpr double kMostStep = 1.0;  // of any unknown, in one step
constexpr int kStepsAfar = 120, kStepsNear = 40;

/// Upright, half bent and deep: stretches of the chain, the rest at ease.
constexpr std::array<std::array<double, 4>, 3> kStarts{
    {{2.0, 0.0, 0.5, 0.5}, {0.0, 0.0, 0.0, 0.5}, {-1.0, -1.0, 0.0, 1.5}}};

Unknowns start_of(const std::array<double, 4>& stretches, double facing) {
  Unknowns x = Unknowns::Zero();
  for (std::size_t i = 0; i < stretches.size(); ++i) x[static_cast<Eigen::Index>(i)] = stretches[i];
  x[static_cast<Eigen::Index>(Unknown::pelvis_yaw)] = 0.4 * facing;
  x[static_cast<Eigen::Index>(Unknown::chest_yaw)] = 0.8 * facing;
  x[static_cast<Eigen::Index>(Unknown::elbows_apart)] = 0.3;
  x[static_cast<Eigen::Index>(Unknown::hand_pitch)] = 0.5;
  return x;
}

}  // namespace

Jacobian jacobian_of(const ResidualFunction& residuals, const Unknowns& x) {
  Jacobian out;
  for (Eigen::Index i = 0; i < kUnknowns; ++i) {
    Unknowns more = x, less = x;
    more[i] += kDifference;
    less[i] -= kDifference;
    out.col(i) = (residuals(more) - residuals(less)) / (2.0 * kDifference);
  }
  return out;
}

Solution least_squares(const ResidualFunction& residuals, const Unknowns& start, int most_steps) {
  Solution now{start, 0.0, 0};
  Residuals r = residuals(start);
  now.cost = r.squaredNorm();
  double damping = 1e-2;
  while (now.steps < most_steps) {
    const Jacobian j = jacobian_of(residuals, now.x);
    const Eigen::Matrix<double, kUnknowns, kUnknowns> normal = j.transpose() * j;
    const Unknowns slope = j.transpose() * r;
    bool better = false;
    double gain = 0.0;
    for (; damping < 1e6 && !better; damping *= 4.0) {
      auto damped = normal;
      damped.diagonal() += damping * (normal.diagonal().array() + 1e-3).matrix();
      Unknowns step = -damped.llt().solve(slope);
      if (const double longest = step.cwiseAbs().maxCoeff(); longest > kMostStep) step *= kMostStep / longest;
      const Residuals there = residuals(now.x + step);
      gain = now.cost - there.squaredNorm();
      if (gain <= 0.0) continue;
      better = true;
      now = {now.x + step, there.squaredNorm(), now.steps + 1};
      r = there;
    }
    if (!better || gain < kGain * now.cost) break;
    damping = std::max(damping / 40.0, 1e-7);
  }
  return now;
}

Solution least_effort(const Effort& effort, const Holding& holding) {
  const double facing = facing_yaw(holding.anchors);
  const auto residuals = [&](const Unknowns& x) { return effort.residuals(x, holding); };
  Solution best;
  bool first = true;
  for (const auto& stretches : kStarts) {
    const Solution found = least_squares(residuals, start_of(stretches, facing), kStepsAfar);
    if (first || found.cost < best.cost) best = found;
    first = false;
  }
  return best;
}

Solution least_effort(const Effort& effort, const Holding& holding, const Unknowns& start, const Habit& habit) {
  return least_squares([&](const Unknowns& x) { return effort.residuals(x, holding, habit); }, start, kStepsNear);
}

}  // namespace reachcast::simulate
