// SPDX-License-Identifier: GPL-3.0-or-later
/// Which hands work.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace reachcast {

/// Which hands work: hold the object, come for it or leave it. The other hand, if any, is free.
enum class Hands { both, left, right };
inline constexpr std::size_t kHandsCount = 3;

[[nodiscard]] std::string_view hands_name(Hands hands);  ///< "both", "left" or "right"
[[nodiscard]] std::optional<Hands> find_hands(std::string_view name);
/// Those of the mirror image.
[[nodiscard]] Hands mirrored(Hands hands);

/// Sides are 0 for left and 1 for right.
[[nodiscard]] constexpr bool works(Hands hands, std::size_t side) {
  return hands == Hands::both || (hands == Hands::left) == (side == 0);
}
/// The side of the one hand that works, or of the one that does not. Only where there is one.
[[nodiscard]] constexpr std::size_t working_side(Hands hands) {
  return hands == Hands::left ? 0 : 1;
}
[[nodiscard]] constexpr std::size_t free_side(Hands hands) {
  return 1 - working_side(hands);
}

}  // namespace reachcast
