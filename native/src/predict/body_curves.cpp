// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/body_curves.hpp"

namespace reachcast {

PostureCurves body_curves(const MotionCode& code) {
  if (code.hands == Hands::both) return posture_curves(code);
  PostureCurves curves(posture_rows() + 3, kBasisCount);
  curves.topRows(posture_rows()) = posture_curves(code);
  curves.bottomRows<3>() = hang_curves(code);
  return curves;
}

Eigen::VectorXd body_coordinates(const Posture& posture, Hands hands) {
  const Eigen::VectorXd coordinates = encode_posture(two_handed_linkage(), posture, 0.0, hands);
  if (hands == Hands::both) return coordinates;
  Eigen::VectorXd all(coordinates.size() + 3);
  all << coordinates, to_eigen(relative_hang(posture, hands));
  return all;
}

}  // namespace reachcast
