// SPDX-License-Identifier: GPL-3.0-or-later
/// Paths of endpoints among the coefficients of a code, in both forms, from a place of code_layout.hpp on.
#pragma once

#include <Eigen/Core>

#include "reachcast/curves/axis_curve.hpp"
#include "reachcast/curves/endpoint_path.hpp"

namespace reachcast::layout {

[[nodiscard]] EndpointPath path_at(const Eigen::VectorXd& coefficients, Eigen::Index at);
void put_path(const EndpointPath& path, Eigen::VectorXd& coefficients, Eigen::Index at);
[[nodiscard]] AxisCurve curve_at(const Eigen::VectorXd& coefficients, Eigen::Index at);
void put_curve(const AxisCurve& curve, Eigen::VectorXd& coefficients, Eigen::Index at);

}  // namespace reachcast::layout
