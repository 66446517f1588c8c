// SPDX-License-Identifier: GPL-3.0-or-later
/// A recording of others, as it was read: named points over time.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "reachcast/conventions.hpp"

namespace reachcast {

struct Clip {
  std::string source;              ///< path of the file, as given
  double rate_hz = 0.0;            ///< frames per second, > 0
  std::vector<std::string> names;  ///< J names, unique
  std::vector<bool> derived;       ///< J flags: true where the point was computed from others and not recorded
  Points positions;                ///< F * J points, frames first, metres, z up, world of the recording; NaN = missing
  std::map<std::string, std::vector<double>> channels;  ///< other numeric columns, F values each (e.g. "obj_qw")
  /// F * J flags, 1 where a gap was filled and nothing was recorded (see fill_gaps); empty: nowhere.
  std::vector<std::uint8_t> filled{};

  [[nodiscard]] std::size_t joints() const { return names.size(); }
  [[nodiscard]] std::size_t frames() const { return names.empty() ? 0 : positions.size() / names.size(); }
  [[nodiscard]] const Vec3& at(std::size_t frame, std::size_t joint) const {
    return positions[frame * joints() + joint];
  }
  [[nodiscard]] Vec3& at(std::size_t frame, std::size_t joint) { return positions[frame * joints() + joint]; }
  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;
};

}  // namespace reachcast
