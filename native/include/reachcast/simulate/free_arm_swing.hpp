// SPDX-License-Identifier: GPL-3.0-or-later
/// What the arm does that has nothing to do: it hangs, and goes back a little while the other reaches out.
#pragma once

#include <cstdint>

#include "reachcast/body/body.hpp"

namespace reachcast::simulate {

/// Of a left arm. The angles are this project's, none is published for it.
class FreeArmSwing {
 public:
  FreeArmSwing(std::uint64_t seed, const Body& body);

  /// relative_hang (posture/free_arm.hpp) at a share of the working hand's way; that of standing at ease where the
  /// motion begins, or ends, at rest.
  [[nodiscard]] Vec3 at(double share, bool begins_at_rest, bool ends_at_rest) const;

 private:
  [[nodiscard]] Vec3 hang(double forward_rad) const;

  Vec3 at_ease_;
  double back_rad_, wave_rad_, outward_rad_, stretch_;
};

}  // namespace reachcast::simulate
