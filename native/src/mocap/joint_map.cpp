// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/mocap/joint_map.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "joint_sources.hpp"
#include "text_scanner.hpp"
#include "units.hpp"

namespace reachcast {
namespace {

constexpr double kLongestOffset = 5.0;

void check_source(Joint joint, const JointSource& source) {
  const auto fail = [&](const std::string& what) {
    throw std::invalid_argument("map: " + std::string(joint_name(joint)) + ' ' + what);
  };
  if (source.points.empty()) fail("names no point");
  if (!is_finite(source.offset) || !(glm::length(source.offset) <= kLongestOffset)) {
    fail("has an offset that is not a finite vector of at most " + show(kLongestOffset));
  }
  if (source.offset == Vec3(0.0)) return;
  if (source.across.empty()) fail("has an offset, but no 'across' to say which way it points");
  if (!source.ahead.empty() && !source.along.empty()) fail("has 'ahead' and 'along'; one of them is enough");
}

std::size_t required_without_source(const JointSources& sources) {
  return static_cast<std::size_t>(std::count_if(required_joints().begin(), required_joints().end(),
                                                [&](Joint joint) { return sources[index(joint)].empty(); }));
}

}  // namespace

const std::vector<Joint>& required_joints() {
  using enum Joint;
  static const std::vector<Joint> required{left_ankle, left_knee,      left_hip,    left_shoulder,
                                           left_elbow, left_wrist,     right_ankle, right_knee,
                                           right_hip,  right_shoulder, right_elbow, right_wrist};
  return required;
}

void check_joint_map(const JointMap& map) {
  for (const auto& [joint, source] : map.sources) check_source(joint, source);
}

std::vector<std::string> parse_mean(std::string_view text) {
  std::vector<std::string> names;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t plus = std::min(text.find('+', begin), text.size());
    if (plus == begin) throw std::invalid_argument("map: expected names joined by '+', found " + quote(text));
    names.emplace_back(text.substr(begin, plus - begin));
    begin = plus + 1;
  }
  return names;
}

PointSpan parse_span(std::string_view text) {
  const std::size_t arrow = text.find('>');
  if (arrow == std::string_view::npos) {
    throw std::invalid_argument("map: expected FROM>TO, each a name or several joined by '+', found " + quote(text));
  }
  return {parse_mean(text.substr(0, arrow)), parse_mean(text.substr(arrow + 1))};
}

const JointMap& detect_joint_map(const Clip& clip) {
  if (const JointMap* best = best_joint_map(clip)) return *best;
  const JointMap* nearest = nullptr;
  std::size_t fewest_missing = required_joints().size() + 1;
  for (const JointMap& map : joint_map_presets()) {
    const std::size_t lacking = required_without_source(find_sources(clip, map));
    if (lacking >= fewest_missing) continue;
    nearest = &map;
    fewest_missing = lacking;
  }
  throw std::invalid_argument(clip.source + ": no known set of joint names fits; the nearest is '" + nearest->name +
                              "', which finds no point for " + missing_joints(find_sources(clip, *nearest)) +
                              "; give a joint map");
}

}  // namespace reachcast
