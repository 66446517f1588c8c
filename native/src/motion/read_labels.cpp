// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "reachcast/mocap/text_table.hpp"
#include "reachcast/motion/labels.hpp"

namespace reachcast {
namespace {

constexpr std::array<std::string_view, 13> kColumns{"file",    "subject", "stature_m", "sex",   "age",
                                                    "mass_kg", "phase",   "hands",     "first", "last",
                                                    "start_s", "end_s",   "object"};
constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kEvents{{{"grasp_frame", "grasp"},
                                                                                {"lift_off_frame", "lift-off"},
                                                                                {"placed_frame", "placed"},
                                                                                {"release_frame", "release"}}};
constexpr double kMostFrames = 1e9;

[[noreturn]] void fail(const std::string& where, const std::string& what) {
  throw std::invalid_argument(where + ": " + what);
}

void check_columns(const TextTable& table) {
  std::string known;
  for (const std::string_view name : kColumns) known += (known.empty() ? "" : ", ") + std::string(name);
  for (const auto& [column, event] : kEvents) known += ", " + std::string(column);
  const auto has = [&](std::string_view name) {
    return std::find(table.names.begin(), table.names.end(), name) != table.names.end();
  };
  for (const std::string& name : table.names) {
    const bool fits =
        std::find(kColumns.begin(), kColumns.end(), name) != kColumns.end() ||
        std::any_of(kEvents.begin(), kEvents.end(), [&](const auto& event) { return event.first == name; });
    if (!fits) fail(table.source, "column '" + name + "' is not known; the columns are " + known);
  }
  for (const char* needed : {"file", "phase"}) {
    if (!has(needed)) fail(table.source, std::string("column '") + needed + "' is missing");
  }
  if (!(has("first") && has("last")) && !(has("start_s") && has("end_s"))) {
    fail(table.source, "columns 'first' and 'last', or 'start_s' and 'end_s', are missing");
  }
}

/// The cells of one row by the names of their columns.
class Cells {
 public:
  Cells(const TextTable& table, const TextTable::Row& row)
      : table_(table), row_(row), where_(table.source + ":" + std::to_string(row.line)) {}

  [[nodiscard]] const std::string& where() const { return where_; }

  [[nodiscard]] std::optional<std::string> text(std::string_view name) const {
    const auto found = std::find(table_.names.begin(), table_.names.end(), name);
    if (found == table_.names.end()) return std::nullopt;
    const std::string& cell = row_.cells[static_cast<std::size_t>(found - table_.names.begin())];
    return cell.empty() ? std::nullopt : std::optional(cell);
  }

  [[nodiscard]] std::string needed(std::string_view name) const {
    const std::optional<std::string> cell = text(name);
    if (!cell) fail(where_, std::string(name) + " is empty");
    return *cell;
  }

  /// A number from low to high.
  [[nodiscard]] std::optional<double> number(std::string_view name, double low, double high) const {
    const std::optional<std::string> cell = text(name);
    if (!cell) return std::nullopt;
    double value = 0.0;
    const auto [end, error] = std::from_chars(cell->data(), cell->data() + cell->size(), value);
    if (error != std::errc{} || end != cell->data() + cell->size() || !(value >= low && value <= high)) {
      std::ostringstream limits;
      limits << name << " must be a number from " << low << " to " << high << ", not '" << *cell << "'";
      fail(where_, limits.str());
    }
    return value;
  }

  [[nodiscard]] std::optional<std::size_t> frame(std::string_view name) const {
    const std::optional<double> value = number(name, 0.0, kMostFrames);
    if (!value) return std::nullopt;
    if (*value != std::floor(*value)) fail(where_, std::string(name) + " must be a whole frame, not " + *text(name));
    return static_cast<std::size_t>(*value);
  }

 private:
  const TextTable& table_;
  const TextTable::Row& row_;
  std::string where_;
};

std::optional<Sex> sex_of(const Cells& cells) {
  const std::optional<std::string> cell = cells.text("sex");
  if (!cell) return std::nullopt;
  std::string lower = *cell;
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  if (lower == "female" || lower == "f") return Sex::female;
  if (lower == "male" || lower == "m") return Sex::male;
  fail(cells.where(), "sex must be female, male, f or m, not '" + *cell + "'");
}

void read_times(const Cells& cells, PhaseLabel& label) {
  label.first = cells.frame("first");
  label.last = cells.frame("last");
  constexpr double longest_s = 1e7;
  label.start_s = cells.number("start_s", 0.0, longest_s);
  label.end_s = cells.number("end_s", 0.0, longest_s);
  if (label.first.has_value() != label.last.has_value()) fail(cells.where(), "one of first and last is empty");
  if (label.start_s.has_value() != label.end_s.has_value()) fail(cells.where(), "one of start_s and end_s is empty");
  if (label.first.has_value() == label.start_s.has_value()) {
    fail(cells.where(), label.first ? "frames and seconds are both given; one of them must be empty"
                                    : "neither first and last nor start_s and end_s are given");
  }
  if (label.first && *label.last <= *label.first) {
    fail(cells.where(),
         "last must be after first, frame " + std::to_string(*label.first) + ", not " + std::to_string(*label.last));
  }
  if (label.start_s && !(*label.end_s > *label.start_s)) {
    fail(cells.where(), "end_s must be after start_s, " + *cells.text("start_s") + ", not " + *cells.text("end_s"));
  }
}

void read_events(const Cells& cells, PhaseLabel& label) {
  for (const auto& [column, name] : kEvents) {
    const std::optional<std::size_t> frame = cells.frame(column);
    if (!frame) continue;
    if (!label.events.empty() && *frame < label.events.back().frame) {
      fail(cells.where(), std::string(column) + " must not be before " + label.events.back().name + ", frame " +
                              std::to_string(label.events.back().frame) + ", not " + std::to_string(*frame));
    }
    label.events.push_back({std::string(name), *frame});
  }
}

PhaseLabel read_row(const TextTable& table, const TextTable::Row& row) {
  const Cells cells(table, row);
  PhaseLabel label;
  label.table = table.source;
  label.line = row.line;
  label.file = cells.needed("file");
  label.subject = cells.text("subject");
  label.stature_m = cells.number("stature_m", 0.5, 2.6);
  label.sex = sex_of(cells);
  label.age_years = cells.number("age", 0.0, 130.0);
  label.mass_kg = cells.number("mass_kg", 0.1, 500.0);
  const std::string phase = cells.needed("phase");
  const std::optional<Phase> known = find_phase(phase);
  if (!known) fail(cells.where(), "phase must be transfer, return, reach or retrieve, not '" + phase + "'");
  label.phase = *known;
  const std::string hands = cells.text("hands").value_or("both");
  const std::optional<Hands> working = find_hands(hands);
  if (!working) fail(cells.where(), "hands must be both, left or right, not '" + hands + "'");
  label.hands = *working;
  label.object = cells.text("object");
  read_times(cells, label);
  read_events(cells, label);
  return label;
}

}  // namespace

FrameRange PhaseLabel::frames(const Clip& clip) const {
  const std::string where = table + ":" + std::to_string(line);
  const auto frame_at = [&](double seconds) { return static_cast<std::size_t>(std::llround(seconds * clip.rate_hz)); };
  if (first.has_value() == start_s.has_value()) fail(where, "the label needs frames or seconds");
  const FrameRange range = first ? FrameRange{*first, *last} : FrameRange{frame_at(*start_s), frame_at(*end_s)};
  if (range.first > range.last || range.last >= clip.frames()) {
    fail(where, "frames " + std::to_string(range.first) + " to " + std::to_string(range.last) +
                    " do not lie within 0 to " + std::to_string(clip.frames() == 0 ? 0 : clip.frames() - 1) + " of " +
                    file);
  }
  return range;
}

std::string PhaseLabel::text() const {
  std::ostringstream out;
  out.precision(12);
  out << file << ": " << phase_name(phase);
  if (hands != Hands::both) out << " with the " << hands_name(hands) << " hand";
  const auto add = [&](const char* name, const auto& value) {
    if (value) out << ", " << name << ' ' << *value;
  };
  add("subject", subject);
  add("stature_m", stature_m);
  if (sex) out << ", " << (*sex == Sex::female ? "female" : "male");
  add("age", age_years);
  add("mass_kg", mass_kg);
  add("first", first);
  add("last", last);
  add("start_s", start_s);
  add("end_s", end_s);
  add("object", object);
  for (const ObjectEvent& event : events) out << ", " << event.name << ' ' << event.frame;
  return out.str();
}

std::vector<PhaseLabel> read_labels(const std::string& path) {
  std::vector<PhaseLabel> labels;
  const TextTable table = read_text_table(path);
  check_columns(table);
  for (const TextTable::Row& row : table.rows) labels.push_back(read_row(table, row));
  return labels;
}

std::vector<PhaseLabel> parse_labels(std::string_view text, const std::string& source) {
  std::vector<PhaseLabel> labels;
  const TextTable table = parse_text_table(text, source);
  check_columns(table);
  for (const TextTable::Row& row : table.rows) labels.push_back(read_row(table, row));
  return labels;
}

}  // namespace reachcast
