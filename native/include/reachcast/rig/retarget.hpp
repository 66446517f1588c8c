// SPDX-License-Identifier: GPL-3.0-or-later
/// Joint centres over time -> how far each bone of a rig has turned from rest and where it is; and forward again.
///
/// The joints come from a body with this rig's own measures, so pelvis (l5s1 and both hips) and chest (c7t1 and the
/// clavicle roots, and l5s1 while the back is straight) are rigid and every link has its length: then the posed bones
/// pass through the joints exactly. Of the nasion only the direction is kept, for the head bone does not turn about the
/// tragion; the front and back of the hands give way to the palms, which are turned to face each other.
#pragma once

#include <span>
#include <vector>

#include "reachcast/rig/limbs.hpp"
#include "reachcast/rig/rest_rig.hpp"

namespace reachcast {

/// The keyed bones of a rig over time, bone by bone in the order of RestRig::keyed. World. A turn carries a bone's rest
/// orientation to its posed one: posed = turn * rest.
struct RigPose {
  std::size_t frames = 0;
  std::vector<Mat3> turns;  ///< [slot * frames + frame]
  Points heads;             ///< [slot * frames + frame]
  bool is_bent = false;     ///< whether the bones of the back ever turn against one another

  [[nodiscard]] Turns turns_of(int slot) const {
    return std::span(turns).subspan(static_cast<std::size_t>(slot) * frames, frames);
  }
  [[nodiscard]] std::span<const Vec3> heads_of(int slot) const {
    return std::span(heads).subspan(static_cast<std::size_t>(slot) * frames, frames);
  }
};

/// The pose for joint centres in the world, one posture per frame. Bones that are not mapped follow their parents;
/// those above the pelvis stay at rest. `bends_rad`: of the back (spine.hpp), one per posture or none for a straight
/// one; the bones of the back share it evenly. Throws std::invalid_argument without frames, for another number of
/// bends, or when a joint or a bend is not finite.
[[nodiscard]] RigPose retarget(const RestRig& rest, Postures postures, std::span<const double> bends_rad = {});

/// Forward kinematics: the joint centres that the posed bones carry, world. The inverse of `retarget`.
[[nodiscard]] std::vector<Posture> posed_joints(const RestRig& rest, const RigPose& pose);

/// Rotation of a keyed bone in its own rest frame against its parent, one per frame: what Blender calls its basis.
/// With R the rest orientations and D the turns: R^T D_parent^T D R.
[[nodiscard]] std::vector<Mat3> local_rotations(const RestRig& rest, const RigPose& pose, int bone);

}  // namespace reachcast
