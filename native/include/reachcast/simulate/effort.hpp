// SPDX-License-Identifier: GPL-3.0-or-later
/// What a posture costs a person: a sum of squares of joint discomfort, joint moments, loss of balance, a head turned
/// away from what is handled, and a body in the way of the box.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "reachcast/simulate/person.hpp"
#include "reachcast/simulate/pose.hpp"

namespace reachcast::simulate {

/// A box that is somewhere: the body keeps out of it. Its sides are those of the add-on's default box.
struct BoxPlace {
  Vec3 hold{0.0};  ///< midway between the handles, body frame, metres
  double yaw_rad = 0.0;
};

/// What must be held at some moment.
struct Holding {
  Anchors anchors;
  Load load;            ///< what the hands carry of the box
  Vec3 looked_at{0.0};  ///< body frame
  std::optional<BoxPlace> box;
};

/// Where the unknowns are drawn to, and how strongly: weakly to an upright nothing, so that what costs no effort is
/// settled, or to the smooth motion that a posture is a moment of.
struct Habit {
  Unknowns towards{Unknowns::Zero()};
  double weight = 0.03;
};

/// How much each kind of effort counts; multiplies residuals, before they are squared.
struct EffortWeights {
  double back = 1.0, knees = 1.0, shoulders = 1.0;  ///< moments relative to strength
  double trunk_bend = 1.0, knee_bend = 1.0;         ///< discomfort of hips and back, of knees and ankles
  double hamstrings = 1.0;                          ///< bent hips over straight knees
  double discomfort = 1.0, balance = 1.0, gaze = 1.0;
};

/// Stoopers spare their knees and squatters their backs.
[[nodiscard]] EffortWeights weights_of(const Person& person);

/// Joint angles that discomfort is about, radians, 0 in an upright stand with hanging arms. Left, right where paired.
struct JointAngles {
  std::array<double, 2> ankle{};      ///< shank forward of the vertical
  std::array<double, 2> knee{};       ///< flexion
  std::array<double, 2> hip{};        ///< flexion of the thigh against the pelvis
  Vec3 back{0.0};                     ///< chest against pelvis: forward, to the right, to the left about the length
  std::array<double, 2> shoulder{};   ///< upper arm against the trunk's length
  std::array<double, 2> abduction{};  ///< upper arm outward of the sagittal plane of the chest
  std::array<double, 2> elbow{};      ///< flexion
  std::array<double, 2> wrist{};      ///< hand against forearm, either way
};
[[nodiscard]] JointAngles joint_angles(const Pose& pose);

/// Moments of weight and load that muscles must balance, newton metres, statics only. Segment masses and centres:
/// Winter (2009), table 4.1.
struct JointMoments {
  double back_forward = 0.0, back_sideways = 0.0;  ///< at L5/S1, bending the trunk forward and sideways
  std::array<double, 2> knee{};                    ///< bending the knee; the feet carry equal shares
  std::array<double, 2> shoulder{};                ///< lowering the arm
};
[[nodiscard]] JointMoments joint_moments(const Pose& pose, double body_mass_kg, const Holding& holding);

inline constexpr Eigen::Index kResiduals = 62;
using Residuals = Eigen::Matrix<double, kResiduals, 1>;

/// Twice differentiable almost everywhere, continuous with its gradient.
class Effort {
 public:
  Effort(const Person& person, const PoseModel& model, const EffortWeights& weights);
  explicit Effort(const Person& person, const PoseModel& model) : Effort(person, model, weights_of(person)) {}

  [[nodiscard]] Residuals residuals(const Unknowns& x, const Holding& holding, const Habit& habit = {}) const;
  [[nodiscard]] double cost(const Unknowns& x, const Holding& holding) const {
    return residuals(x, holding).squaredNorm();
  }
  [[nodiscard]] const PoseModel& model() const { return model_; }

 private:
  const PoseModel& model_;
  EffortWeights weights_;
  double strength_, flexibility_;
};

}  // namespace reachcast::simulate
