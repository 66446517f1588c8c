// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/pose_mean.hpp"

namespace reachcast {

TrunkPose PoseMean::at(double t, const Anchors& anchors, const Linkage& linkage, const BodyLinkage& body_linkage,
                       const Body& body) const {
  const double share = share_of_target(t);
  const LocalBasis local = bspline_local(t);
  TrunkPose mean = no_pose();
  for (const PosturePart& part : *parts_) {
    const double weight = (1.0 - share) * part.at_home + share * part.at_target;
    if (weight == 0.0) continue;
    Eigen::VectorXd coordinates = Eigen::VectorXd::Zero(part.curves.rows());
    for (Eigen::Index i = 0; i < 4; ++i)
      coordinates += local.values[static_cast<std::size_t>(i)] * part.curves.col(local.first + i);
    add(trunk_pose_of(linkage, body, body_linkage.decode(coordinates, anchors)), weight, mean);
  }
  if (lacks_) {
    make_good((*lacks_)[0], 1.0 - share, mean);
    make_good((*lacks_)[1], share, mean);
  }
  return mean;
}

void PoseMean::meet(const TrunkPose& first_lacks, const TrunkPose& last_lacks) {
  lacks_ = {first_lacks, last_lacks};
}

}  // namespace reachcast
