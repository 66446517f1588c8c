// SPDX-License-Identifier: GPL-3.0-or-later
/// Bodies and postures between Python and C++.
#pragma once

#include <optional>
#include <string>

#include "array_checks.hpp"
#include "reachcast/body/body.hpp"

namespace reachcast::bindings {

[[nodiscard]] inline std::optional<Sex> to_sex(const std::optional<std::string>& sex) {
  if (!sex) return std::nullopt;
  if (*sex == "female") return Sex::female;
  if (*sex == "male") return Sex::male;
  throw std::invalid_argument("sex is '" + *sex + "'; it must be 'female', 'male' or None");
}

[[nodiscard]] inline Posture to_posture(const DoubleArray& array, std::string_view name) {
  require_shape(array, name, {static_cast<pybind11::ssize_t>(kJointCount), 3});
  const Points points = to_points(array, name);
  Posture posture;
  std::copy(points.begin(), points.end(), posture.begin());
  return posture;
}

}  // namespace reachcast::bindings
