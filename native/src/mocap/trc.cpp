// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/mocap/trc.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_set>
#include <vector>

#include "settle.hpp"
#include "text_scanner.hpp"
#include "units.hpp"

namespace reachcast {
namespace {

constexpr std::size_t kFewestColumns = 5;  // frame, time and one marker

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

std::string_view trimmed(std::string_view cell) {
  while (!cell.empty() && static_cast<unsigned char>(cell.front()) <= ' ') cell.remove_prefix(1);
  while (!cell.empty() && static_cast<unsigned char>(cell.back()) <= ' ') cell.remove_suffix(1);
  return cell;
}

/// Cells between tabs, or words when the file has no tabs. Empty cells at the end are left out.
void split(std::string_view line, bool has_tabs, std::vector<std::string_view>& cells) {
  cells.clear();
  for (std::size_t begin = 0; begin < line.size();) {
    if (!has_tabs && is_blank(line[begin])) {
      ++begin;
      continue;
    }
    const std::size_t end = std::min(has_tabs ? line.find('\t', begin) : line.find_first_of(" \t", begin), line.size());
    cells.push_back(trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  while (!cells.empty() && cells.back().empty()) cells.pop_back();
}

struct Header {
  double rate_hz = 0.0, frames = 0.0, markers = 0.0;
  std::string units;
  bool has_tabs = true;
};

/// Lines 1 to 3: what the file is, names of values, values. Values are single words, so any blanks part them.
Header read_header(TextScanner& scanner) {
  std::vector<std::string_view> names, values;
  if (!trimmed(scanner.take_line()).starts_with("PathFileType")) scanner.fail_found("PathFileType", "something else");
  split(scanner.take_line(), false, names);
  split(scanner.take_line(), false, values);
  Header header;
  const auto value_of = [&](std::string_view name) -> std::string_view {
    const auto found = std::find(names.begin(), names.end(), name);
    const auto at = static_cast<std::size_t>(found - names.begin());
    if (found == names.end() || at >= values.size()) scanner.fail_found("a value of " + std::string(name), "none");
    return values[at];
  };
  const auto number_of = [&](std::string_view name) {
    const std::optional<double> value = parse_number(value_of(name));
    if (!value) scanner.fail("a number as " + std::string(name), value_of(name));
    return *value;
  };
  header.rate_hz = number_of("DataRate");
  header.frames = number_of("NumFrames");
  header.markers = number_of("NumMarkers");
  header.units = value_of("Units");
  return header;
}

/// Line 4: Frame#, Time, then a name in every third column (words one after the other without tabs).
void read_names(TextScanner& scanner, Header& header, MotionFile& file) {
  const TextScanner here = scanner;
  const std::string_view line = scanner.take_line();
  header.has_tabs = line.find('\t') != std::string_view::npos;
  std::vector<std::string_view> cells;
  split(line, header.has_tabs, cells);
  if (cells.size() < 3 || !cells[0].starts_with("Frame")) here.fail_found("Frame#, Time and names", "something else");
  std::unordered_set<std::string> taken;
  for (std::size_t i = 2; i < cells.size(); i += header.has_tabs ? 3 : 1) {
    const std::string label = cells[i].empty() ? "point_" + std::to_string(i / 3 + 1) : std::string(cells[i]);
    std::string name = label;
    for (int copy = 2; !taken.insert(name).second; ++copy) name = label + '_' + std::to_string(copy);
    file.names.push_back(name);
  }
  if (static_cast<double>(file.names.size()) != header.markers) {
    here.fail_found("the " + show(header.markers) + " names that NumMarkers announces",
                    std::to_string(file.names.size()));
  }
  file.derived.assign(file.names.size(), false);
  scanner.take_line();  // X1 Y1 Z1 ...
}

void read_frame(const TextScanner& here, const std::vector<std::string_view>& cells, MotionFile& file) {
  const auto coordinate = [&](std::size_t column) {
    if (column >= cells.size() || cells[column].empty() || equal_ignoring_case(cells[column], "nan")) return kMissing;
    const std::optional<double> value = parse_number(cells[column]);
    if (!value) here.fail("a number or nothing in column " + std::to_string(column + 1), cells[column]);
    return *value;
  };
  for (std::size_t joint = 0; joint < file.names.size(); ++joint) {
    const std::size_t x = 2 + 3 * joint;
    const Vec3 point(coordinate(x), coordinate(x + 1), coordinate(x + 2));
    file.positions.push_back(is_finite(point) ? point : Vec3(kMissing));
  }
}

void read_frames(TextScanner& scanner, const Header& header, MotionFile& file) {
  const std::size_t width = 2 + 3 * file.names.size();
  std::vector<std::string_view> cells;
  double frames = 0.0;
  while (!scanner.at_end()) {
    const TextScanner here = scanner;
    const std::string_view line = scanner.take_line();
    split(line, header.has_tabs, cells);
    if (cells.empty()) continue;
    // Blank cells at the end of a line are cells only where their tabs are there.
    const std::size_t written =
        header.has_tabs ? static_cast<std::size_t>(std::count(line.begin(), line.end(), '\t')) + 1 : cells.size();
    if (written < width || cells.size() > width || width < kFewestColumns) {
      here.fail_found(std::to_string(width) + " cells in a frame", std::to_string(std::max(cells.size(), written)));
    }
    read_frame(here, cells, file);
    ++frames;
  }
  if (frames == 0.0) scanner.fail_found("at least one frame", "none");
  if (frames != header.frames) {
    scanner.fail_found("the " + show(header.frames) + " frames that NumFrames announces", show(frames));
  }
}

}  // namespace

MotionFile read_trc(const std::string& path, const MotionFileOptions& options) {
  return parse_trc(read_text_file(path), path, options);
}

MotionFile parse_trc(std::string_view text, const std::string& source, const MotionFileOptions& options) {
  check_options(options);
  TextScanner scanner(text, source);
  MotionFile file;
  file.source = source;
  Header header = read_header(scanner);
  read_names(scanner, header, file);
  settle_rate(options, header.rate_hz, file);
  read_frames(scanner, header, file);
  FileSays says;
  says.metres_per_unit = metres_of_unit(header.units);
  says.usual_up.assign(1, 'y');
  settle(options, says, file);
  return file;
}

}  // namespace reachcast
