// SPDX-License-Identifier: GPL-3.0-or-later
/// Where the weight is, and where the feet can carry it.
#pragma once

#include "reachcast/posture/whole_body.hpp"

namespace reachcast {

/// What the hands carry.
struct Load {
  Vec3 centre{0.0};      ///< body frame, metres
  double mass_kg = 0.0;  ///< >= 0
};

/// Where a subject's mass is not known: that of a body mass index of 24 kg/m^2.
[[nodiscard]] inline double usual_mass_kg(double stature_m) {
  return 24.0 * stature_m * stature_m;
}

/// Centre of mass of person and load. Segment masses and centres: Winter, Biomechanics and Motor Control (2009),
/// table 4.1. body_mass_kg > 0.
[[nodiscard]] Vec3 centre_of_mass(const Posture& posture, double body_mass_kg, const Load& load);

/// How far, horizontally, the centre of mass lies outside the area that two flat feet carry: between the ankles
/// sideways, from just behind the ankles to the balls forward. Zero inside; z is zero.
[[nodiscard]] Vec3 beyond_support(const Vec3& centre, const Anchors& feet);

}  // namespace reachcast
