// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/body/hands.hpp"

#include <algorithm>
#include <array>

namespace reachcast {
namespace {

constexpr std::array<std::string_view, kHandsCount> kNames{"both", "left", "right"};

}  // namespace

std::string_view hands_name(Hands hands) {
  return kNames[static_cast<std::size_t>(hands)];
}

std::optional<Hands> find_hands(std::string_view name) {
  const auto* const found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<Hands>(found - kNames.begin());
}

Hands mirrored(Hands hands) {
  if (hands == Hands::both) return hands;
  return hands == Hands::left ? Hands::right : Hands::left;
}

}  // namespace reachcast
