// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/neighbours.hpp"

#include <cmath>

namespace reachcast {

std::vector<std::uint32_t> positions_of(const MotionTable& table, const Query& query, const LeftOut& left_out) {
  std::vector<std::uint32_t> positions;
  if (!left_out) return positions;
  const PhaseColumns& columns = table.of(query.phase, query.hands);
  for (std::uint32_t at = 0; at < columns.size(); ++at) {
    if (left_out(table.motions()[columns.rows[at]])) positions.push_back(at);
  }
  return positions;
}

Neighbour named(const MotionTable& table, const Query& query, const Share& share) {
  const MotionSummary& m = table.motions()[table.of(query.phase, query.hands).rows[share.at]];
  return {m.id,
          m.origin,
          m.is_mirrored,
          share.weight,
          glm::distance(m.target, query.target),
          glm::distance(m.home, query.home),
          std::abs(m.subject.stature_m - query.subject.stature_m)};
}

std::vector<Neighbour> nearest_motions(const MotionTable& table, const Query& query, End end, const Scheme& scheme,
                                       const LeftOut& left_out) {
  Search search(table, query, positions_of(table, query, left_out));
  std::vector<Neighbour> out;
  for (const Share& share : search.shares(scheme, end, search.nearest(scheme, end))) {
    out.push_back(named(table, query, share));
  }
  return out;
}

}  // namespace reachcast
