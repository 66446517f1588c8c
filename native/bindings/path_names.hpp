// SPDX-License-Identifier: GPL-3.0-or-later
/// The words that Python says for the choices of a hand-path model, and Python values as covariates.
#pragma once

#include <pybind11/pybind11.h>

#include <array>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "array_checks.hpp"
#include "reachcast/curves/hand_path.hpp"
#include "reachcast/curves/variation.hpp"

namespace reachcast::bindings {

template <typename Choice, std::size_t count>
using Words = std::array<std::pair<const char*, Choice>, count>;

inline constexpr Words<Hand, 2> kHands{{{"left", Hand::left}, {"right", Hand::right}}};
inline constexpr Words<OffsetOrigin, 4> kOrigins{{{"axis", OffsetOrigin::axis},
                                                  {"ends", OffsetOrigin::ends},
                                                  {"start_axis", OffsetOrigin::start_axis},
                                                  {"axis_end", OffsetOrigin::axis_end}}};
inline constexpr Words<OffsetScaling, 3> kScalings{{{"none", OffsetScaling::none},
                                                    {"distance", OffsetScaling::distance},
                                                    {"distance_time", OffsetScaling::distance_time}}};
inline constexpr Words<Trend, 3> kTrends{
    {{"linear", Trend::linear}, {"quadratic", Trend::quadratic}, {"smooth", Trend::smooth}}};
inline constexpr Words<Alignment, 3> kAlignments{
    {{"none", Alignment::none}, {"start", Alignment::start}, {"ends", Alignment::ends}}};

/// The choice that a word stands for; otherwise std::invalid_argument with the argument, the word and those known.
template <typename Choice, std::size_t count>
[[nodiscard]] Choice choice(const Words<Choice, count>& words, std::string_view word, std::string_view argument) {
  std::string known;
  for (const auto& [name, value] : words) {
    if (word == name) return value;
    known += (known.empty() ? "'" : ", '") + std::string(name) + "'";
  }
  throw std::invalid_argument(std::string(argument) + " is '" + std::string(word) + "', expected one of " + known);
}

template <typename Choice, std::size_t count>
[[nodiscard]] std::string word(const Words<Choice, count>& words, Choice wanted) {
  for (const auto& [name, value] : words) {
    if (value == wanted) return name;
  }
  throw std::logic_error("a choice without a word");
}

/// A dict of name to one value per reach: numbers (n,), vectors (n, 3), or a list of strings.
[[nodiscard]] std::vector<Covariate> to_covariates(const pybind11::dict& given);
/// The same for a single reach: a number, a vector (3,), or a string.
[[nodiscard]] std::vector<Covariate> to_single_covariates(const pybind11::dict& given);

/// Eigen to an owning array (rows, columns).
[[nodiscard]] pybind11::array_t<double> matrix_array(const Eigen::MatrixXd& matrix);

}  // namespace reachcast::bindings
