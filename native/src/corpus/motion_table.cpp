// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/corpus/motion_table.hpp"

#include <algorithm>
#include <utility>

namespace reachcast {

MotionTable::MotionTable(std::vector<MotionSummary> motions) : motions_(std::move(motions)) {
  std::stable_sort(motions_.begin(), motions_.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  for (std::size_t row = 0; row < motions_.size(); ++row) {
    const MotionSummary& motion = motions_[row];
    PhaseColumns& columns = phases_[static_cast<std::size_t>(motion.phase)];
    columns.rows.push_back(static_cast<std::uint32_t>(row));
    columns.home.push_back(motion.home);
    columns.target.push_back(motion.target);
    columns.stature_m.push_back(motion.subject.stature_m);
  }
  for (PhaseColumns& columns : phases_) {
    columns.sorted_stature_m = columns.stature_m;
    std::sort(columns.sorted_stature_m.begin(), columns.sorted_stature_m.end());
  }
}

}  // namespace reachcast
