// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/simulate/free_arm_swing.hpp"

#include <algorithm>
#include <cmath>

#include "reachcast/curves/normal_numbers.hpp"
#include "reachcast/posture/free_arm.hpp"
#include "reachcast/predict/plan.hpp"
#include "reachcast/predict/stand.hpp"
#include "reachcast/simulate/person.hpp"

namespace reachcast::simulate {
namespace {

constexpr std::uint64_t kOwnDraws = 2000;  // far from the seeds of the hand's path
constexpr double kForward_rad = 0.06, kBack_rad = 0.10, kWave_rad = 0.05, kOutward_rad = 0.13, kStretch = 0.975;
constexpr double kVaries_rad = 0.04;

}  // namespace

FreeArmSwing::FreeArmSwing(std::uint64_t seed, const Body& body)
    : at_ease_(relative_hang(standing_at_ease(body), Hands::right)) {
  const Eigen::VectorXd normal = normal_numbers(derived_seed(seed, kOwnDraws), 4);
  back_rad_ = kBack_rad + kVaries_rad * normal[0];
  wave_rad_ = kWave_rad + kVaries_rad * normal[1];
  outward_rad_ = std::max(0.06, kOutward_rad + 0.5 * kVaries_rad * normal[2]);
  stretch_ = std::clamp(kStretch + 0.006 * normal[3], 0.95, 0.985);
}

Vec3 FreeArmSwing::hang(double forward_rad) const {
  const Vec3 down(-std::sin(outward_rad_), std::sin(forward_rad), -std::cos(forward_rad));
  return stretch_ * glm::normalize(down);
}

/// Back while the hand is out, and to and fro once on the way.
Vec3 FreeArmSwing::at(double share, bool begins_at_rest, bool ends_at_rest) const {
  const double out = begins_at_rest ? eased(0.0, 1.0, share) : ends_at_rest ? 1.0 - eased(0.0, 1.0, share) : 1.0;
  const double wave = wave_rad_ * std::sin(2.0 * kPi * share) * std::sin(kPi * share);
  return glm::mix(at_ease_, hang(kForward_rad - back_rad_ * out + wave), out);
}

}  // namespace reachcast::simulate
