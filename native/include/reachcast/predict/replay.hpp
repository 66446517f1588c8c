// SPDX-License-Identifier: GPL-3.0-or-later
/// What a code comes to on the body of a stature, between the ends that another motion had.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>

#include "reachcast/curves/endpoint_way.hpp"
#include "reachcast/posture/hold.hpp"
#include "reachcast/posture/linkage.hpp"
#include "reachcast/predict/blend.hpp"
#include "reachcast/predict/pose_mean.hpp"

namespace reachcast {

inline constexpr int kReplayTimes = 11;  ///< evenly spaced from start to end
using ReplayPostures = std::array<Posture, kReplayTimes>;

/// The stage of one motion: published proportions of its subject's stature ("link lengths predicted using the height of
/// the actual subject and not their actual link lengths", Faraway 2004, p. 549), its home and target, its hands'
/// distance, or its one hand. A level pair of grips, or that hand's, goes along the path of a code, in either form; the
/// body follows.
class Replay {
 public:
  /// Nothing for a stature without published proportions.
  [[nodiscard]] static std::optional<Replay> of(const MotionSummary& motion);

  /// False where the body cannot hold the box somewhere on the way; `postures` are then of no use.
  [[nodiscard]] bool perform(const MotionCode& code, PathForm form, ReplayPostures& postures) const;
  [[nodiscard]] bool perform(const Blend& blend, PathForm form, ReplayPostures& postures) const;
  /// At any scaled times in [0, 1], one posture for each.
  [[nodiscard]] bool perform(const MotionCode& code, PathForm form, std::span<const double> times,
                             std::span<Posture> postures) const;

 private:
  using Coordinates = Eigen::Matrix<double, Eigen::Dynamic, kReplayTimes>;
  explicit Replay(const MotionSummary& motion);
  /// Along the way of `code`, and with its free arm if there is one.
  [[nodiscard]] bool perform(const MotionCode& code, PathForm form, const Coordinates& coordinates,
                             ReplayPostures& postures) const;
  [[nodiscard]] bool perform(const MotionCode& code, PathForm form, const PoseMean& poses,
                             ReplayPostures& postures) const;
  [[nodiscard]] Anchors anchors_at(const MotionCode& code, const EndpointWay& way, double t) const;
  /// One posture; false where the body cannot hold the box.
  [[nodiscard]] bool hold_at(const Anchors& anchors, const Decoded& decoded, Posture& posture) const;

  Vec3 home_, target_, half_grip_;
  Body body_;
  Anchors anchors_;
  BodyLinkage linkage_;
  Holder holder_;
};

/// Mean over time, by the trapezoidal rule, and the paper's 23 joints of the distance, metres. On recorded lifts it is
/// within 1 mm of the mean over 201 times.
[[nodiscard]] double mean_distance(const ReplayPostures& a, const ReplayPostures& b);

}  // namespace reachcast
