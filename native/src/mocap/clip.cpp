// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/mocap/clip.hpp"

#include <algorithm>

namespace reachcast {

std::optional<std::size_t> Clip::find(std::string_view name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

}  // namespace reachcast
