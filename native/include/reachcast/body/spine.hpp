// SPDX-License-Identifier: GPL-3.0-or-later
/// The back between l5s1 and c7t1, which bends forward evenly in the sagittal plane of the chest: the torso link gets
/// shorter over time (Faraway 2004, section 3.3) because the vertebrae between its ends turn against one another.
///
/// A bend is the angle by which the highest part of the back has turned against the lowest, radians, 0 as in the stand.
/// An arc of length L bent by b has the chord L sin(b/2) / (b/2), and at its upper end it points b/2 beyond that chord.
#pragma once

#include <span>

#include "reachcast/body/body.hpp"

namespace reachcast {

/// What people do: some 60 degrees between L1 and S1 and 30 between T1 and T12 (White and Panjabi 1990). The chord is
/// then 0.90 of the arc.
inline constexpr double kMostBend_rad = 0.5 * kPi;

/// The bend of an arc whose chord is `ratio` of its length; 0 from a ratio of 1 on, at most kMostBend_rad.
[[nodiscard]] double bend_of_ratio(double ratio);
/// Chord over arc.
[[nodiscard]] double ratio_of_bend(double bend_rad);

/// A bent back, seen by its own chord, which keeps the direction that it has in the stand.
struct BentBack {
  Vec3 end{0.0};            ///< from l5s1 to c7t1
  std::vector<Mat3> turns;  ///< of its pieces against the stand; none for an arc
  Mat3 upper{1.0};          ///< of what hangs on its upper end
};

/// `pieces`: from l5s1 to c7t1 in the stand, the stiff parts of the back in their order; each turns as the middle of
/// its part of an evenly bent arc, so that a single piece does not bend. `right`: of the person in the stand.
[[nodiscard]] BentBack bent_back(std::span<const Vec3> pieces, const Vec3& right, double bend_rad);
/// The same of a back that bends everywhere.
[[nodiscard]] BentBack bent_arc(const Vec3& chord, const Vec3& right, double bend_rad);

/// A stand with a bent back, on the feet and the pelvis of the body: what is above c7t1 moves with it as one piece.
struct BentStand {
  Posture posture{};
  Mat3 upper{1.0};  ///< turn of the chest against the body's stand
};
[[nodiscard]] BentStand bent_stand(const Body& body, double bend_rad);

}  // namespace reachcast
