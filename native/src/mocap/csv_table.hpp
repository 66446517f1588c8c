// SPDX-License-Identifier: GPL-3.0-or-later
/// A table of numbers with named columns. Private to mocap/.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace reachcast {

struct CsvTable {
  std::vector<std::string> names;            ///< unique, not empty
  std::vector<std::vector<double>> columns;  ///< one per name, NaN where a cell was empty

  [[nodiscard]] std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;
};

/// Blank lines are passed over; cells may be quoted but not contain line ends. Throws std::invalid_argument.
[[nodiscard]] CsvTable read_csv_table(std::string_view text, const std::string& source);

}  // namespace reachcast
