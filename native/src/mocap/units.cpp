// SPDX-License-Identifier: GPL-3.0-or-later
#include "units.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace reachcast {
namespace {

// From the lowest joint of the feet to the highest of the head, of people from 1.4 to 2.1 m: the first joint of the head
// lies at 0.83 of the stature or above.
constexpr double kShortest_m = 1.15;
constexpr double kTallest_m = 2.1;

// Their ranges for a standing adult do not overlap, so the choice is unique.
constexpr std::array<Unit, 6> kUnits{{{1.0, "metres"},
                                      {0.01, "centimetres"},
                                      {0.001, "millimetres"},
                                      {0.0254, "inches"},
                                      {0.3048, "feet"},
                                      {0.0254 / 0.45, "the CMU database's unit"}}};

struct Mean {
  Vec3 sum{0.0};
  std::size_t count = 0;
  void add(const Vec3& point) {
    if (!is_finite(point)) return;
    sum += point;
    ++count;
  }
  [[nodiscard]] Vec3 value() const { return sum / static_cast<double>(count); }
};

}  // namespace

void check_options(const MotionFileOptions& options) {
  const auto positive = [](const std::optional<double>& value, const char* name) {
    if (value && !(*value > 0.0 && *value <= 1e6)) {
      throw std::invalid_argument(std::string(name) + " must be over 0 and at most 1e6, not " + show(*value));
    }
  };
  positive(options.metres_per_unit, "metres_per_unit");
  positive(options.rate_hz, "rate_hz");
  const auto axis = [](const std::optional<std::string>& value, const char* name) {
    constexpr std::array<std::string_view, 6> known{"x", "y", "z", "-x", "-y", "-z"};
    if (value && std::find(known.begin(), known.end(), *value) == known.end()) {
      throw std::invalid_argument(std::string(name) + " must be 'x', 'y', 'z', '-x', '-y' or '-z', not '" + *value +
                                  "'");
    }
  };
  axis(options.up, "up");
  axis(options.facing, "facing");
}

BodyEnd body_end(std::string_view name) {
  constexpr std::array<std::string_view, 3> high{"head", "neck", "sho"};
  constexpr std::array<std::string_view, 4> low{"foot", "ankle", "rank", "toe"};  // RANK: right ankle in marker sets
  std::string lowered(name);
  std::transform(lowered.begin(), lowered.end(), lowered.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  const auto is_part = [&](std::string_view part) { return lowered.find(part) != std::string::npos; };
  if (std::any_of(high.begin(), high.end(), is_part)) return BodyEnd::high;
  return std::any_of(low.begin(), low.end(), is_part) ? BodyEnd::low : BodyEnd::neither;
}

std::optional<std::string> guess_up(std::span<const std::string> names, std::span<const Vec3> poses) {
  Mean upper, lower;
  for (std::size_t joint = 0; joint < names.size(); ++joint) {
    const BodyEnd end = body_end(names[joint]);
    if (end == BodyEnd::neither) continue;
    Mean& mean = end == BodyEnd::high ? upper : lower;
    for (std::size_t i = joint; i < poses.size(); i += names.size()) mean.add(poses[i]);
  }
  if (upper.count == 0 || lower.count == 0) return std::nullopt;
  const Vec3 rise = upper.value() - lower.value();
  int best = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (std::abs(rise[axis]) > std::abs(rise[best])) best = axis;
  }
  if (!(std::abs(rise[best]) > 0.0)) return std::nullopt;
  return signed_axis(best, rise[best] < 0.0);
}

std::string signed_axis(int axis, bool is_negative) {
  std::string name(is_negative ? "-" : "");
  name.push_back(static_cast<char>('x' + axis));
  return name;
}

std::optional<Unit> guess_unit(double height) {
  for (const Unit& unit : kUnits) {
    const double height_m = height * unit.metres;
    if (height_m >= kShortest_m && height_m <= kTallest_m) return unit;
  }
  return std::nullopt;
}

std::string unit_name(double metres) {
  for (const Unit& unit : kUnits) {
    if (unit.metres == metres) return std::string(unit.name);
  }
  return show(metres) + " m";
}

Vec3 to_z_up(const Vec3& p, std::string_view up) {
  const Vec3 turned = up.back() == 'x' ? Vec3(p.y, p.z, p.x) : up.back() == 'y' ? Vec3(p.x, -p.z, p.y) : p;
  return up.front() == '-' ? Vec3(turned.x, -turned.y, -turned.z) : turned;
}

double median_of(std::vector<double>& values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return kMissing;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::string show(double value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(7);
  text << value;
  return text.str();
}

void add_note(std::string& note, std::string_view sentence) {
  if (!note.empty()) note += ' ';
  note += sentence;
}

}  // namespace reachcast
