// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/mocap/c3d.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_set>

#include "c3d_bytes.hpp"
#include "settle.hpp"
#include "text_scanner.hpp"
#include "units.hpp"

namespace reachcast {
namespace {

constexpr std::size_t kBlock = 512;
constexpr std::uint8_t kMark = 0x50;
constexpr double kFarthest = 1e9;  // nothing recorded is this far away, in any unit

// Places of the header's numbers, in bytes.
constexpr std::size_t kPointsAt = 2, kAnalogAt = 4, kFirstAt = 6, kLastAt = 8, kScaleAt = 12, kDataAt = 16,
                      kRateAt = 20;

/// How the points of a file are laid out.
struct Layout {
  std::size_t points = 0;
  std::size_t frames = 0;
  std::size_t begin = 0;       ///< byte of the first frame
  std::size_t frame_size = 0;  ///< bytes
  bool is_real = false;        ///< floats; else integers times scale
  bool is_dec = false;
  double scale = 1.0;
};

std::size_t stated_frames(const C3dBytes& bytes, const C3dParameters& parameters) {
  const auto field = [&](const char* name) -> std::optional<double> {
    const std::string full = std::string("TRIAL:") + name;
    const std::optional<double> low = parameters.number(full, 0), high = parameters.number(full, 1);
    if (!low) return std::nullopt;
    return high ? *low + 65536.0 * *high : *low;  // two words, the low one first
  };
  const std::optional<double> first = field("ACTUAL_START_FIELD"), last = field("ACTUAL_END_FIELD");
  if (first && last && *first >= 1.0 && *last >= *first && *last < 1e9) {
    return static_cast<std::size_t>(*last - *first) + 1;
  }
  const std::size_t from = bytes.word(kFirstAt), to = bytes.word(kLastAt);
  if (to < from) {
    bytes.fail("a last frame not before the first, " + std::to_string(from), std::to_string(to));
  }
  return to - from + 1;
}

Layout read_layout(const C3dBytes& bytes, const C3dParameters& parameters, std::string& note) {
  Layout layout;
  layout.is_dec = parameters.is_dec();
  const std::size_t in_header = bytes.word(kPointsAt);
  layout.points = static_cast<std::size_t>(parameters.number("POINT:USED").value_or(static_cast<double>(in_header)));
  if (layout.points != in_header) {
    bytes.fail("as many points in POINT:USED as in the header, " + std::to_string(in_header),
               std::to_string(layout.points));
  }
  if (layout.points == 0) bytes.fail("at least one point", "none");
  const double header_scale = bytes.real(kScaleAt, layout.is_dec);
  layout.is_real = header_scale < 0.0;
  layout.scale = std::abs(header_scale);
  if (!layout.is_real && !(layout.scale > 0.0 && layout.scale < 1e6)) {
    bytes.fail("a POINT:SCALE over 0 and under 1e6", show(layout.scale));
  }
  const std::size_t number_size = layout.is_real ? 4 : 2;
  layout.frame_size = number_size * (4 * layout.points + bytes.word(kAnalogAt));
  const std::size_t block = bytes.word(kDataAt);
  if (block < 2) bytes.fail("point data from block 2 on", "block " + std::to_string(block));
  layout.begin = (block - 1) * kBlock;
  const std::size_t room = bytes.size() > layout.begin ? (bytes.size() - layout.begin) / layout.frame_size : 0;
  layout.frames = stated_frames(bytes, parameters);
  if (layout.frames > room) {
    bytes.fail("room for the " + std::to_string(layout.frames) + " frames announced",
               "room for " + std::to_string(room));
  }
  const bool has_long_padding = (room - layout.frames) * layout.frame_size > kBlock + layout.frame_size;
  if (has_long_padding) {
    add_note(note, "The file announces " + std::to_string(layout.frames) + " frames and has room for " +
                       std::to_string(room) + "; those announced were read.");
  }
  return layout;
}

Vec3 read_point(const C3dBytes& bytes, const Layout& layout, std::size_t at) {
  Vec3 point;
  bool is_seen;
  if (layout.is_real) {
    for (int axis = 0; axis < 3; ++axis) {
      point[axis] = bytes.real(at + 4 * static_cast<std::size_t>(axis), layout.is_dec);
    }
    is_seen = !(bytes.real(at + 12, layout.is_dec) < 0.0F);
  } else {
    for (int axis = 0; axis < 3; ++axis) {
      point[axis] = layout.scale * static_cast<std::int16_t>(bytes.word(at + 2 * static_cast<std::size_t>(axis)));
    }
    is_seen = static_cast<std::int16_t>(bytes.word(at + 6)) >= 0;
  }
  const bool is_near = glm::max(glm::max(std::abs(point.x), std::abs(point.y)), std::abs(point.z)) < kFarthest;
  return is_seen && is_finite(point) && is_near ? point : Vec3(kMissing);
}

std::vector<std::string> point_names(const C3dParameters& parameters, std::size_t points) {
  const std::vector<std::string> labels = parameters.all_texts("POINT:LABELS");
  std::unordered_set<std::string> taken;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < points; ++i) {
    const std::string label = i < labels.size() && !labels[i].empty() ? labels[i] : "point_" + std::to_string(i + 1);
    std::string name = label;
    for (int copy = 2; !taken.insert(name).second; ++copy) name = label + '_' + std::to_string(copy);
    names.push_back(name);
  }
  return names;
}

/// Indices of the points that are places, not angles or forces stored as if they were.
std::vector<std::size_t> places(const C3dParameters& parameters, const std::vector<std::string>& names) {
  std::set<std::string> others;
  for (const char* kind : {"ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS"}) {
    for (const std::string& label : parameters.all_texts(std::string("POINT:") + kind)) others.insert(label);
  }
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!others.contains(names[i])) chosen.push_back(i);
  }
  return chosen;
}

/// POINT:Y_SCREEN names the axis that points up on a screen: "+Z".
std::optional<std::string> stated_up(const C3dParameters& parameters) {
  const std::vector<std::string> screen = parameters.texts("POINT:Y_SCREEN");
  if (screen.empty() || screen.front().size() != 2) return std::nullopt;
  const char sign = screen.front()[0];
  const char axis = static_cast<char>(screen.front()[1] | 0x20);
  if ((sign != '+' && sign != '-') || axis < 'x' || axis > 'z') return std::nullopt;
  return signed_axis(axis_index(axis), sign == '-');
}

void read_points(const C3dBytes& bytes, const Layout& layout, const std::vector<std::size_t>& chosen,
                 MotionFile& file) {
  const std::size_t point_size = layout.is_real ? 16 : 8;
  file.positions.reserve(layout.frames * chosen.size());
  for (std::size_t frame = 0; frame < layout.frames; ++frame) {
    const std::size_t at = layout.begin + frame * layout.frame_size;
    for (const std::size_t point : chosen) {
      file.positions.push_back(read_point(bytes, layout, at + point * point_size));
    }
  }
}

std::optional<double> stated_rate(const C3dBytes& bytes, const C3dParameters& parameters) {
  const double in_header = bytes.real(kRateAt, parameters.is_dec());
  const double rate = parameters.number("POINT:RATE").value_or(in_header);
  const double chosen = rate > 0.0 ? rate : in_header;
  return chosen > 0.0 ? std::optional(chosen) : std::nullopt;
}

}  // namespace

MotionFile read_c3d(const std::string& path, const MotionFileOptions& options) {
  return parse_c3d(read_text_file(path), path, options);
}

MotionFile parse_c3d(std::string_view data, const std::string& source, const MotionFileOptions& options) {
  check_options(options);
  const C3dBytes bytes(data, source);
  if (bytes.size() < 2 * kBlock || bytes.byte(1) != kMark || bytes.byte(0) < 2) {
    bytes.fail("a C3D file: a first byte of 2 or more, then 80, and at least 1024 bytes",
               bytes.size() < 2 ? std::to_string(bytes.size()) + " bytes"
                                : std::to_string(bytes.byte(0)) + ", " + std::to_string(bytes.byte(1)) + " in " +
                                      std::to_string(bytes.size()) + " bytes");
  }
  const C3dParameters parameters(bytes, (bytes.byte(0) - std::size_t{1}) * kBlock);
  MotionFile file;
  file.source = source;
  const Layout layout = read_layout(bytes, parameters, file.note);
  const std::vector<std::string> names = point_names(parameters, layout.points);
  const std::vector<std::size_t> chosen = places(parameters, names);
  if (chosen.empty()) bytes.fail("at least one marker", "only angles, forces and the like");
  for (const std::size_t point : chosen) file.names.push_back(names[point]);
  file.derived.assign(chosen.size(), false);
  settle_rate(options, stated_rate(bytes, parameters), file);
  read_points(bytes, layout, chosen, file);
  FileSays says;
  const std::vector<std::string> units = parameters.texts("POINT:UNITS");
  if (!units.empty()) says.metres_per_unit = metres_of_unit(units.front());
  says.up = stated_up(parameters);
  settle(options, says, file);
  return file;
}

}  // namespace reachcast
