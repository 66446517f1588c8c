// SPDX-License-Identifier: GPL-3.0-or-later
/// Cells of a line of text. Private to mocap/.
#pragma once

#include <string>
#include <string_view>

namespace reachcast {

/// Calls use(column, cell) for each cell of a line, without blanks around it but with its quotes; a separator between
/// quotes parts nothing. Returns how many there were.
template <typename Use>
std::size_t split_cells(std::string_view line, char separator, Use use) {
  const auto is_blank = [&](char c) { return static_cast<unsigned char>(c) <= ' ' && c != separator; };
  std::size_t column = 0, begin = 0;
  bool quoted = false;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (quoted || line[i] != separator)) continue;
    std::string_view cell = line.substr(begin, i - begin);
    while (!cell.empty() && is_blank(cell.front())) cell.remove_prefix(1);
    while (!cell.empty() && is_blank(cell.back())) cell.remove_suffix(1);
    use(column++, cell);
    begin = i + 1;
  }
  return column;
}

/// The cell without quotes around it; a doubled quote within them is one quote.
[[nodiscard]] inline std::string unquoted(std::string_view cell) {
  if (cell.size() < 2 || cell.front() != '"' || cell.back() != '"') return std::string(cell);
  std::string text;
  for (std::size_t i = 1; i + 1 < cell.size(); ++i) {
    text += cell[i];
    if (cell[i] == '"' && cell[i + 1] == '"' && i + 2 < cell.size()) ++i;
  }
  return text;
}

}  // namespace reachcast
