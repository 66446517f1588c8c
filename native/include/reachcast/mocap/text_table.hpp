// SPDX-License-Identifier: GPL-3.0-or-later
/// A table of text with named columns, such as people keep beside their recordings.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace reachcast {

struct TextTable {
  struct Row {
    std::size_t line = 0;            ///< in the file, from 1
    std::vector<std::string> cells;  ///< one per name, empty where nothing was written
  };
  std::string source;
  std::vector<std::string> names;  ///< as in the first line, in lower case, unique
  std::vector<Row> rows;
};

/// Cells are separated by the one of comma, semicolon and tab that the first line holds most of; they may be quoted,
/// with separators and doubled quotes inside, but end with their line. Line ends \n, \r\n and \r, a byte order mark,
/// and blank lines are taken. Throws std::invalid_argument, worded `file:line: expected X, found Y`.
[[nodiscard]] TextTable read_text_table(const std::string& path);

/// The same from text in memory; `source` names it in messages.
[[nodiscard]] TextTable parse_text_table(std::string_view text, const std::string& source);

}  // namespace reachcast
