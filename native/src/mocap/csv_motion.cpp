// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/mocap/csv_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "csv_table.hpp"
#include "settle.hpp"
#include "text_scanner.hpp"
#include "units.hpp"

namespace reachcast {
namespace {

constexpr std::string_view kIntervals = "interval_label";
constexpr std::string_view kTimes = "time_s";
constexpr double kUnstatedRate_hz = 100.0;  // the wall-reaching tables name no rate; their motions fit about 100 Hz
constexpr double kFarthest_m = 20.0;        // coordinates typically beyond this are millimetres

struct PointColumns {
  std::string name;
  std::array<std::size_t, 3> columns;
};

/// The triples NAME_x, NAME_y, NAME_z in order of their x columns; marks their columns as used.
std::vector<PointColumns> find_points(const CsvTable& table, std::vector<bool>& used) {
  std::vector<PointColumns> points;
  for (std::size_t x = 0; x < table.names.size(); ++x) {
    if (table.names[x].size() < 3 || !table.names[x].ends_with("_x")) continue;
    const std::string name = table.names[x].substr(0, table.names[x].size() - 2);
    const std::optional<std::size_t> y = table.find(name + "_y");
    const std::optional<std::size_t> z = table.find(name + "_z");
    if (!y || !z || name.ends_with("Angle")) continue;
    points.push_back({name, {x, *y, *z}});
    for (const std::size_t column : points.back().columns) used[column] = true;
  }
  return points;
}

std::vector<std::size_t> choose_rows(const CsvTable& table, const MotionFileOptions& options,
                                     const std::string& source) {
  const std::optional<std::size_t> labels = table.find(kIntervals);
  if (options.interval && !labels)
    throw std::invalid_argument(source + ": interval was given, but there is no column interval_label");
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (!options.interval || table.columns[*labels][row] == static_cast<double>(*options.interval)) rows.push_back(row);
  }
  if (rows.empty()) {
    const auto [low, high] = std::minmax_element(table.columns[*labels].begin(), table.columns[*labels].end());
    throw std::invalid_argument(source + ": no row has interval_label " + std::to_string(*options.interval) +
                                "; the labels run from " + show(*low) + " to " + show(*high));
  }
  return rows;
}

/// Frames per second from times that must advance evenly (to a fifth of a step: printed times are rounded).
double rate_of_times(const std::vector<double>& times, const std::string& source) {
  if (times.size() < 2) throw std::invalid_argument(source + ": one frame alone has no rate; give rate");
  const double step = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (!(step > 0.0) || !(std::abs(times[i] - times[i - 1] - step) <= 0.2 * step)) {
      throw std::invalid_argument(source + ": expected time_s to advance in even steps of about " + show(step) +
                                  " s, found " + show(times[i - 1]) + " followed by " + show(times[i]) +
                                  "; give rate if the frames are evenly spaced all the same");
    }
  }
  return 1.0 / step;
}

void choose_rate(const CsvTable& table, const MotionFileOptions& options, MotionFile& file) {
  const auto times = file.channels.find(std::string(kTimes));
  if (options.rate_hz) {
    settle_rate(options, {}, file);
  } else if (times != file.channels.end()) {
    settle_rate(options, rate_of_times(times->second, file.source), file);
  } else if (table.find(kIntervals)) {
    settle_rate(options, kUnstatedRate_hz, file);
    file.guess.rate_from = From::usual;
    add_note(file.note, "The table states no rate; 100 Hz is assumed (give rate).");
  } else {
    throw std::invalid_argument(file.source + ": expected a column time_s or the option rate, found neither");
  }
}

/// Metres per unit for tables without a known body: millimetres when the typical point lies beyond kFarthest_m along
/// its largest coordinate.
double usual_unit(const MotionFile& file) {
  std::vector<double> sizes;
  for (const Vec3& point : file.positions) {
    if (is_finite(point)) sizes.push_back(std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)}));
  }
  return median_of(sizes) > kFarthest_m ? 0.001 : 1.0;
}

void take_points(const CsvTable& table, const std::vector<std::size_t>& rows, const std::vector<PointColumns>& points,
                 MotionFile& file) {
  for (const PointColumns& point : points) file.names.push_back(point.name);
  file.derived.assign(points.size(), false);
  for (const std::size_t row : rows) {
    for (const PointColumns& point : points) {
      const auto& [x, y, z] = point.columns;
      file.positions.emplace_back(table.columns[x][row], table.columns[y][row], table.columns[z][row]);
    }
  }
}

void take_channels(const CsvTable& table, const std::vector<std::size_t>& rows, const std::vector<bool>& used,
                   MotionFile& file) {
  for (std::size_t column = 0; column < used.size(); ++column) {
    if (used[column]) continue;
    std::vector<double>& channel = file.channels[table.names[column]];
    for (const std::size_t row : rows) channel.push_back(table.columns[column][row]);
  }
}

}  // namespace

MotionFile read_csv_motion(const std::string& path, const MotionFileOptions& options) {
  return parse_csv_motion(read_text_file(path), path, options);
}

MotionFile parse_csv_motion(std::string_view text, const std::string& source, const MotionFileOptions& options) {
  check_options(options);
  const CsvTable table = read_csv_table(text, source);
  MotionFile file;
  file.source = source;
  std::vector<bool> used(table.names.size(), false);
  const std::vector<PointColumns> points = find_points(table, used);
  if (points.empty()) {
    throw std::invalid_argument(source + ": expected columns named NAME_x, NAME_y and NAME_z, found no such three");
  }
  const std::vector<std::size_t> rows = choose_rows(table, options, source);
  if (table.find(kIntervals) && !options.interval) {
    add_note(file.note, "The rows of all intervals follow each other; give interval to read one.");
  }
  take_points(table, rows, points, file);
  take_channels(table, rows, used, file);
  choose_rate(table, options, file);
  FileSays says;
  says.usual_unit = usual_unit(file);
  settle(options, says, file);
  return file;
}

}  // namespace reachcast
