// SPDX-License-Identifier: GPL-3.0-or-later
/// Schemes between Python and C++.
#pragma once

#include <pybind11/pybind11.h>

#include <optional>

#include "reachcast/predict/scheme.hpp"

namespace reachcast::bindings {

/// From a dict as `schemes()` returns it; every key may be missing. Unknown keys and values are a std::invalid_argument
/// that names them, and so are values that the scheme would not use.
[[nodiscard]] Scheme to_scheme(const pybind11::handle& given);
[[nodiscard]] pybind11::dict scheme_dict(const Scheme& scheme);

/// The options of `predict`: a scheme, and its k by itself.
[[nodiscard]] Scheme to_scheme(const std::optional<int>& k, const pybind11::object& given);

/// Throws std::invalid_argument naming the first of `unknown`; `known`: what could have been meant.
void refuse_unknown(const pybind11::kwargs& unknown, const char* function, const char* known);

}  // namespace reachcast::bindings
