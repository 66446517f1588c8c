// SPDX-License-Identifier: GPL-3.0-or-later
/// What a neighbour search looks at: every motion of a corpus without its coefficients, and each phase by columns.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "reachcast/motion/reach.hpp"

namespace reachcast {

/// A stored motion without its coefficients.
struct MotionSummary {
  std::int64_t id = 0;
  std::int64_t subject_id = 0;  ///< equal for motions whose Subject has the same four values
  Subject subject;
  Phase phase = Phase::transfer;
  std::string origin;
  bool is_mirrored = false;
  double duration_s = 0.0;
  Vec3 home{0.0};    ///< body frame, metres
  Vec3 target{0.0};  ///< body frame, metres
  double grip_distance_m = 0.0;
};

/// The motions of one phase, in id order.
struct PhaseColumns {
  std::vector<std::uint32_t> rows;  ///< into MotionTable::motions
  std::vector<Vec3> home, target;
  std::vector<double> stature_m;
  std::vector<double> sorted_stature_m;

  [[nodiscard]] std::size_t size() const { return rows.size(); }
};

/// In id order. Not changed once made.
class MotionTable {
 public:
  explicit MotionTable(std::vector<MotionSummary> motions);

  [[nodiscard]] const std::vector<MotionSummary>& motions() const { return motions_; }
  [[nodiscard]] const PhaseColumns& of(Phase phase) const { return phases_[static_cast<std::size_t>(phase)]; }

 private:
  std::vector<MotionSummary> motions_;
  std::array<PhaseColumns, kPhaseCount> phases_;
};

}  // namespace reachcast
