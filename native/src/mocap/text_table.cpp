// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/mocap/text_table.hpp"

#include <algorithm>

#include "cells.hpp"
#include "text_scanner.hpp"

namespace reachcast {
namespace {

constexpr std::size_t kMostRows = 1'000'000;

char separator_of(std::string_view header) {
  char best = ',';
  for (const char candidate : {';', '\t'}) {
    if (std::count(header.begin(), header.end(), candidate) > std::count(header.begin(), header.end(), best))
      best = candidate;
  }
  return best;
}

std::vector<std::string> cells_of(std::string_view line, char separator, const TextScanner& here) {
  if (std::count(line.begin(), line.end(), '"') % 2 != 0)
    here.fail_found("every quote closed on its line", "an open one");
  std::vector<std::string> cells;
  split_cells(line, separator, [&](std::size_t, std::string_view cell) { cells.push_back(unquoted(cell)); });
  return cells;
}

}  // namespace

TextTable read_text_table(const std::string& path) {
  return parse_text_table(read_text_file(path), path);
}

TextTable parse_text_table(std::string_view text, const std::string& source) {
  TextScanner scanner(text, source);
  if (!scanner.next_line_with_words()) scanner.fail("a line of column names", {});
  TextTable table;
  table.source = source;
  const TextScanner top = scanner;
  const std::string_view header = scanner.take_line();
  const char separator = separator_of(header);
  for (std::string name : cells_of(header, separator, top)) {
    std::transform(name.begin(), name.end(), name.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    if (name.empty()) top.fail_found("a name for column " + std::to_string(table.names.size() + 1), "an empty cell");
    if (std::count(table.names.begin(), table.names.end(), name) > 0) top.fail("every column name once", name);
    table.names.push_back(std::move(name));
  }
  while (scanner.next_line_with_words()) {
    const TextScanner here = scanner;
    TextTable::Row row{here.line(), cells_of(scanner.take_line(), separator, here)};
    const auto blank = [](const std::string& cell) { return cell.empty(); };
    if (std::all_of(row.cells.begin(), row.cells.end(), blank)) continue;  // what spreadsheets leave at the end
    if (row.cells.size() != table.names.size()) {
      here.fail_found(std::to_string(table.names.size()) + " cells, as in the first line",
                      std::to_string(row.cells.size()));
    }
    if (table.rows.size() == kMostRows) here.fail_found("at most " + std::to_string(kMostRows) + " rows", "more");
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace reachcast
