// SPDX-License-Identifier: GPL-3.0-or-later
/// Turns from rest of arms and legs over time: the direction of each link exactly, the roll about it from the hinge.
///
/// Elbow and knee are hinges: both links share its axis, the normal of their plane. Where a limb is nearly straight
/// that normal is noise; it is carried there from bent frames. All spans of one call are as long as the motion.
#pragma once

#include <span>
#include <vector>

#include "reachcast/body/body.hpp"
#include "reachcast/rig/segments.hpp"

namespace reachcast {

inline constexpr double kFullBend = 0.2;          ///< sine of the bend from which a limb's own plane alone decides
inline constexpr double kMaxHandTwist_rad = 2.6;  ///< pronation from the forearm's neutral

using Postures = std::span<const Posture>;  ///< one per frame, world
using Turns = std::span<const Mat3>;        ///< one per frame: from a bone's rest orientation to its posed one

/// Unit normals across the unit `axes`, continuous in time. `raw` is across the axis, its length the sine of the bend.
/// From kFullBend on it decides alone. Below, it gives way to the normals of the nearest bent frames before and after,
/// each carried by the smallest turn of the axis; if no frame is bent, to `fallback`.
[[nodiscard]] Points carried_normals(std::span<const Vec3> raw, std::span<const Vec3> axes,
                                     std::span<const Vec3> fallback);

/// Adds whole turns so that no step is longer than half a turn (numpy.unwrap).
void unwrap(std::span<double> angles_rad);

/// A hinged limb at rest: unit directions of its links and its hinge.
struct HingeRest {
  Vec3 upper, lower, normal;
};
struct HingeJoints {
  Joint root, hinge, end;
};

/// Turns of the upper and the lower link. `above`: the turn of the bone above, which a limb that never bends follows.
void turn_hinge(const HingeRest& rest, const HingeJoints& joints, Postures postures, Turns above, std::span<Mat3> upper,
                std::span<Mat3> lower);

/// A hand at rest: unit directions from the wrist to the grip and out of the palm.
struct HandRest {
  Vec3 hand, palm;
};

/// The palm faces the other grip; half of the twist that this needs goes to `forearm` (given without it), half to the
/// hand. The twist is how far the palm turns about the hand from where the forearm alone would bring it. The hand's
/// direction is exact; its palm gives way where the twist would be more than kMaxHandTwist_rad.
void turn_hand(const HandRest& rest, const ArmNames& arm, Postures postures, std::span<Mat3> forearm,
               std::span<Mat3> hand);

/// A foot at rest: unit direction from the ankle to the ball, unit sideways axis of its level sole, up.
struct FootRest {
  Vec3 foot, side, up;
};

/// The foot lies along ankle -> ball with its sole level, and the toe keeps its rest slope. A foot that points straight
/// down has no level side; it takes that of the shin. A foot that swings past straight down comes out with its level
/// axis reversed, so each run of level frames has a sign: the first, in which the person stands, is right; later ones
/// agree with the shin.
void turn_foot(const FootRest& rest, const LegNames& leg, Postures postures, Turns shin, std::span<Mat3> foot,
               std::span<Mat3> toe);

}  // namespace reachcast
