// SPDX-License-Identifier: GPL-3.0-or-later
/// Who moves. Only stature is required; what is unknown stays empty and never takes part in a similarity.
#pragma once

#include <optional>

namespace reachcast {

enum class Sex { female, male };

struct Subject {
  double stature_m = 0.0;  ///< 0.5 to 2.6; published proportions go from 1.2 to 2.2
  std::optional<Sex> sex;
  std::optional<double> age_years;  ///< >= 0
  std::optional<double> mass_kg;    ///< > 0
};

}  // namespace reachcast
