// SPDX-License-Identifier: GPL-3.0-or-later
#include "csv_table.hpp"

#include <algorithm>
#include <unordered_set>

#include "cells.hpp"
#include "reachcast/conventions.hpp"
#include "text_scanner.hpp"

namespace reachcast {
namespace {

constexpr std::size_t kMostCells = 300'000'000;

/// Calls use(column, cell) for each cell of a line, without its quotes; returns how many there were.
template <typename Use>
std::size_t split(std::string_view line, Use use) {
  return split_cells(line, ',', [&](std::size_t column, std::string_view cell) {
    const bool quoted = cell.size() >= 2 && cell.front() == '"' && cell.back() == '"';
    use(column, quoted ? cell.substr(1, cell.size() - 2) : cell);
  });
}

void read_header(TextScanner& scanner, CsvTable& table) {
  if (!scanner.next_line_with_words()) scanner.fail("a line of column names", {});
  const TextScanner here = scanner;
  std::unordered_set<std::string> taken;
  split(scanner.take_line(), [&](std::size_t column, std::string_view cell) {
    const std::string where = "a name for column " + std::to_string(column + 1);
    if (cell.empty()) here.fail_found(where, "an empty cell");
    if (parse_number(cell)) here.fail(where, cell);
    if (!taken.insert(std::string(cell)).second) here.fail("every column name once", cell);
    table.names.emplace_back(cell);
  });
  table.columns.resize(table.names.size());
}

}  // namespace

std::optional<std::size_t> CsvTable::find(std::string_view name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

CsvTable read_csv_table(std::string_view text, const std::string& source) {
  TextScanner scanner(text, source);
  CsvTable table;
  read_header(scanner, table);
  const std::size_t width = table.names.size();
  while (scanner.next_line_with_words()) {
    const TextScanner here = scanner;
    const std::size_t cells = split(scanner.take_line(), [&](std::size_t column, std::string_view cell) {
      if (column >= width) return;
      const std::optional<double> value = cell.empty() ? kMissing : parse_number(cell);
      if (!value) here.fail("a number or nothing in column " + quote(table.names[column]), cell);
      table.columns[column].push_back(*value);
    });
    if (cells != width) {
      here.fail_found(std::to_string(width) + " cells, as in the first line", std::to_string(cells));
    }
    if (table.rows() * width > kMostCells) here.fail_found("at most " + std::to_string(kMostCells) + " cells", "more");
  }
  if (table.rows() == 0) scanner.fail_found("at least one line of numbers", "none");
  return table;
}

}  // namespace reachcast
