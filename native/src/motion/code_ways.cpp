// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/motion/code_ways.hpp"

namespace reachcast::layout {

EndpointPath path_at(const Eigen::VectorXd& coefficients, Eigen::Index at) {
  EndpointPath path;
  path.velocity = coefficients.segment<kPathBasisCount>(at);
  path.deviation = coefficients.segment<3 * kPathBasisCount>(at + kPathBasisCount).reshaped(kPathBasisCount, 3);
  return path;
}

void put_path(const EndpointPath& path, Eigen::VectorXd& coefficients, Eigen::Index at) {
  coefficients.segment<kPathBasisCount>(at) = path.velocity;
  coefficients.segment<3 * kPathBasisCount>(at + kPathBasisCount) = path.deviation.reshaped();
}

AxisCurve curve_at(const Eigen::VectorXd& coefficients, Eigen::Index at) {
  const double* next = coefficients.data() + at;
  AxisCurve curve;
  for (Vec3& offset : curve.offsets) {
    for (int k = 0; k < 3; ++k) offset[k] = *next++;
  }
  curve.speed = {next[0], next[1]};
  return curve;
}

void put_curve(const AxisCurve& curve, Eigen::VectorXd& coefficients, Eigen::Index at) {
  double* next = coefficients.data() + at;
  for (const Vec3& offset : curve.offsets) {
    for (int k = 0; k < 3; ++k) *next++ = offset[k];
  }
  next[0] = curve.speed.alpha;
  next[1] = curve.speed.beta;
}

}  // namespace reachcast::layout
