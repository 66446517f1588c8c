// SPDX-License-Identifier: GPL-3.0-or-later
/// The trunk as one rigid body on its way to where all limbs reach: turned about its l5s1 and shifted from where it was
/// decoded. Only hold.cpp needs it.
#pragma once

#include "reachcast/posture/hold.hpp"
#include "reachcast/posture/rigid_motion.hpp"

namespace reachcast {

class MovedTrunk {
 public:
  MovedTrunk(const Decoded& decoded, const std::array<LimbSpec, kLimbCount>& limbs, const Stance& stance = {})
      : learned_waist_(decoded.trunk[index(Joint::l5s1)]),
        waist_(learned_waist_ + stance.shift),
        turn_(rotation_by(stance.turn_rad)) {
    for (std::size_t i = 0; i < kLimbCount; ++i) learned_roots_[i] = decoded.trunk[index(limbs[i].root)];
    place_roots();
  }

  [[nodiscard]] const Corners& roots() const { return roots_; }  ///< of the limbs, in the order of Linkage::limbs
  [[nodiscard]] Vec3 shift() const { return waist_ - learned_waist_; }
  [[nodiscard]] const Quat& turn() const { return turn_; }

  void shift_by(const Vec3& by) {
    waist_ += by;
    for (Vec3& root : roots_) root += by;
  }

  /// About the middle of the roots, as far as the whole turn does not exceed the limit.
  void turn_about_roots_by(const Quat& by, double most_rad) {
    const Vec3 middle = 0.25 * (roots_[0] + roots_[1] + roots_[2] + roots_[3]);
    turn_ = glm::normalize(by * turn_);
    const Vec3 whole = rotation_vector(turn_);
    if (const double angle = glm::length(whole); angle > most_rad) turn_ = rotation_by(whole * (most_rad / angle));
    place_roots();
    shift_by(middle - 0.25 * (roots_[0] + roots_[1] + roots_[2] + roots_[3]));
  }

  /// The joints that move with the trunk.
  void place(const Decoded& decoded, Posture& posture) const {
    using enum Joint;
    const Mat3 rotation = glm::mat3_cast(turn_);
    for (const Joint j : {left_hip, right_hip, l5s1, c7t1, suprasternale, left_clavicle, right_clavicle, left_shoulder,
                          right_shoulder, tragion, nasion})
      posture[index(j)] = waist_ + rotation * (decoded.trunk[index(j)] - learned_waist_);
  }

 private:
  void place_roots() {
    const Mat3 rotation = glm::mat3_cast(turn_);
    for (std::size_t i = 0; i < kLimbCount; ++i) roots_[i] = waist_ + rotation * (learned_roots_[i] - learned_waist_);
  }

  Corners learned_roots_{}, roots_{};
  Vec3 learned_waist_, waist_;
  Quat turn_;
};

}  // namespace reachcast
