// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/simulate/body_track.hpp"

#include <Eigen/Cholesky>

namespace reachcast::simulate {
namespace {

constexpr Eigen::Index kNumbers = 3 + 4 * kPartCount + 3 * 4 + 6 * kLimbCount + 3 * 2;
constexpr double kEndWeight = 3.0;

using Row = Eigen::Matrix<double, 1, BodyTrack::kDegree + 1>;
using Numbers = Eigen::Matrix<double, kNumbers, 1>;

/// Every number of a pose, in a fixed order.
template <class Pose, class Visit>
void visit(Pose& pose, const Visit& each) {
  const auto vector = [&](auto& v) {
    for (int k = 0; k < 3; ++k) each(v[k]);
  };
  vector(pose.waist);
  for (auto& turn : pose.parts) {
    each(turn.w), each(turn.x), each(turn.y), each(turn.z);
  }
  for (auto& pointer : pose.pointers) vector(pointer);
  for (auto& plane : pose.planes) {
    vector(plane.normal);
    vector(plane.axis);
  }
  for (auto& wrist : pose.wrist_from_grip) vector(wrist);
}

Numbers numbers_of(const TrunkPose& pose) {
  Numbers out;
  Eigen::Index next = 0;
  visit(pose, [&](const double& value) { out[next++] = value; });
  return out;
}

/// Bernstein polynomials.
Row polynomials(double share) {
  Row row = Row::Zero();
  row[0] = 1.0;
  for (int degree = 1; degree <= BodyTrack::kDegree; ++degree) {  // De Casteljau's triangle, read the other way
    for (int i = degree; i > 0; --i) row[i] = (1.0 - share) * row[i] + share * row[i - 1];
    row[0] *= 1.0 - share;
  }
  return row;
}

}  // namespace

BodyTrack::BodyTrack(const Body& body, std::span<const Decoded> moments) : body_(body) {
  const auto count = static_cast<Eigen::Index>(moments.size());
  Eigen::MatrixXd basis(count, kDegree + 1), values(count, kNumbers);
  std::array<Quat, kPartCount> turns{};
  for (Eigen::Index i = 0; i < count; ++i) {
    TrunkPose pose = trunk_pose_of(two_handed_linkage(), body, moments[static_cast<std::size_t>(i)]);
    for (std::size_t part = 0; part < kPartCount; ++part) {
      if (i > 0 && glm::dot(turns[part], pose.parts[part]) < 0.0) pose.parts[part] = -pose.parts[part];
      turns[part] = pose.parts[part];
    }
    const double weight = i == 0 || i + 1 == count ? kEndWeight : 1.0;
    basis.row(i) = weight * polynomials(static_cast<double>(i) / static_cast<double>(count - 1));
    values.row(i) = weight * numbers_of(pose).transpose();
  }
  coefficients_ = (basis.transpose() * basis).llt().solve(basis.transpose() * values);
}

Decoded BodyTrack::at(double share) const {
  const Numbers numbers = (polynomials(share) * coefficients_).transpose();
  TrunkPose pose;
  Eigen::Index next = 0;
  visit(pose, [&](double& value) { value = numbers[next++]; });
  return decoded_of(two_handed_linkage(), body_, pose);
}

}  // namespace reachcast::simulate
