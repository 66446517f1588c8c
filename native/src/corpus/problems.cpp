// SPDX-License-Identifier: GPL-3.0-or-later
#include "problems.hpp"

#include <stdexcept>

#include "rows.hpp"

namespace reachcast::problems {
namespace {

using sqlite::Connection;
using sqlite::Statement;

/// SQLite's own check of pages, indexes and constraints; "ok" where all is well.
void check_pages(Connection& connection, std::size_t most, std::vector<std::string>& found) {
  Statement row(connection, "PRAGMA integrity_check(" + std::to_string(most) + ")");
  while (row.step())
    if (row.text(0) != "ok") found.emplace_back(row.text(0));
}

void check_references(Connection& connection, std::vector<std::string>& found) {
  Statement row(connection, "PRAGMA foreign_key_check");
  while (row.step()) {
    found.push_back("row " + std::to_string(row.integer(1)) + " of the table " + std::string(row.text(0)) +
                    " refers to a row of " + std::string(row.text(2)) + " that is not there");
  }
}

void check_motions(Connection& connection, std::vector<std::string>& found) {
  const rows::Format format = rows::format_of(connection);
  Statement row(connection, rows::select(true));
  while (row.step()) {
    try {
      (void)rows::read_motion(row, format);
    } catch (const sqlite::Error&) {
      throw;
    } catch (const std::runtime_error& error) {
      found.emplace_back(error.what());
    }
  }
}

}  // namespace

std::vector<std::string> find(Connection& connection, std::size_t most) {
  std::vector<std::string> found;
  try {
    check_pages(connection, most, found);
    check_references(connection, found);
    check_motions(connection, found);
  } catch (const sqlite::Error& error) {
    if ((error.code & 0xFF) != SQLITE_CORRUPT) throw;
    found.emplace_back(error.what());
  }
  if (found.size() > most) found.resize(most);
  return found;
}

}  // namespace reachcast::problems
