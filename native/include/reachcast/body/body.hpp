// SPDX-License-Identifier: GPL-3.0-or-later
/// The body that moves: who it is in segment lengths, and where its feet stand.
///
/// A Body is one reference posture, an upright stand in the body frame with the feet flat on the floor. Everything
/// else (segment lengths, the shape of pelvis and chest, the stance) is read off that posture, so a body measured on a
/// rig and a body from published proportions are the same kind of thing.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>

#include "reachcast/body/joints.hpp"
#include "reachcast/body/subject.hpp"
#include "reachcast/conventions.hpp"

namespace reachcast {

using Posture = std::array<Vec3, kJointCount>;  ///< indexed by index(Joint); metres

/// The mirror image: x changes sign, left and right change names.
[[nodiscard]] Posture mirrored(const Posture& posture);

class Body {
 public:
  /// Published proportions (Drillis & Contini 1966 as given by Winter 2009, with trunk landmarks of ANSUR), see
  /// body.cpp. `stature_m` in [1.2, 2.2]; without a sex the mean of the two. Throws std::invalid_argument.
  [[nodiscard]] static Body from_stature(double stature_m, std::optional<Sex> sex = std::nullopt);

  /// A standing posture as measured, body frame. Every value must be finite and every segment longer than 1 cm, the
  /// person must stand upright on the origin and face forward, and pelvis and chest must be triangles; else
  /// std::invalid_argument names the joint. Left and right may differ. `stature_m` in [0.5, 2.6].
  [[nodiscard]] static Body from_posture(const Posture& posture, double stature_m);

  /// The proportions of `stature_m` with some segments replaced: names of segment_names(), metres, both sides alike.
  [[nodiscard]] static Body from_lengths(double stature_m, const std::map<std::string, double>& lengths_m);

  [[nodiscard]] const Posture& posture() const { return posture_; }
  [[nodiscard]] const Vec3& at(Joint joint) const { return posture_[index(joint)]; }
  [[nodiscard]] double stature_m() const { return stature_m_; }

  /// The same body with a back that bends only at these points between l5s1 and c7t1, lowest first, standing; with none
  /// of them it does not bend. Bodies bend everywhere unless told otherwise. Throws std::invalid_argument for a point
  /// that is not finite.
  [[nodiscard]] Body bending_at(const Points& points) const;
  /// Stiff pieces of the back from l5s1 to c7t1, standing (spine.hpp); nothing where it bends everywhere.
  [[nodiscard]] const std::optional<Points>& spine() const { return spine_; }

  /// Distance of two joints in the reference posture: a segment length where both belong to one segment.
  [[nodiscard]] double distance(Joint a, Joint b) const { return glm::distance(at(a), at(b)); }

  /// Lengths by segment name; those of limbs are the mean of left and right.
  [[nodiscard]] std::map<std::string, double> lengths() const;

 private:
  Body(const Posture& posture, double stature_m) : posture_(posture), stature_m_(stature_m) {}
  Posture posture_{};
  double stature_m_ = 0.0;
  std::optional<Points> spine_;
};

inline constexpr std::size_t kLengthCount = 12;

/// The mirror image of a body.
[[nodiscard]] Body mirrored(const Body& body);

/// Names that from_lengths takes: foot, shank, thigh, pelvis_width, pelvis, trunk, clavicle, upper_arm, forearm, hand,
/// neck, head.
[[nodiscard]] const std::array<std::string_view, kLengthCount>& segment_names();

/// Lengths in the order of segment_names, metres; those of limbs are the mean of left and right.
[[nodiscard]] std::array<double, kLengthCount> segment_lengths(const Posture& posture);

}  // namespace reachcast
