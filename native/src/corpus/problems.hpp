// SPDX-License-Identifier: GPL-3.0-or-later
/// What is wrong with a corpus that could be opened. Private to this folder.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sqlite.hpp"

namespace reachcast::problems {

/// Reads every page, reference and motion. One sentence per problem, at most `most` of them.
[[nodiscard]] std::vector<std::string> find(sqlite::Connection& connection, std::size_t most);

}  // namespace reachcast::problems
