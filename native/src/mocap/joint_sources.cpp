// SPDX-License-Identifier: GPL-3.0-or-later
#include "joint_sources.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <unordered_map>

#include "units.hpp"

namespace reachcast {
namespace {

// Shank, thigh and trunk as parts of stature (Drillis & Contini 1966).
constexpr double kShankThighTrunk = 0.246 + 0.245 + 0.288;

std::string_view without_namespace(std::string_view name) {
  const std::size_t colon = name.rfind(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

using NameIndex = std::unordered_map<std::string_view, std::size_t>;

/// Full names win over names without their namespace, and earlier points over later ones.
NameIndex index_names(const Clip& clip) {
  NameIndex index;
  for (std::size_t i = 0; i < clip.names.size(); ++i) index.emplace(clip.names[i], i);
  for (std::size_t i = 0; i < clip.names.size(); ++i) index.emplace(without_namespace(clip.names[i]), i);
  return index;
}

/// Indices of all the names, or nothing when one of them is not recorded.
std::vector<std::size_t> find_all(const NameIndex& index, const std::vector<std::string>& names) {
  std::vector<std::size_t> found;
  for (const std::string& name : names) {
    const auto at = index.find(name);
    if (at == index.end()) return {};
    found.push_back(at->second);
  }
  return found;
}

Vec3 span_vector(const Clip& clip, std::size_t frame, const FoundSpan& span) {
  return plain_mean(clip, frame, span.to) - plain_mean(clip, frame, span.from);
}

double median_length(const Clip& clip, const FoundSpan& span) {
  std::vector<double> lengths;
  for (std::size_t frame = 0; frame < clip.frames(); ++frame) {
    lengths.push_back(glm::length(span_vector(clip, frame, span)));
  }
  return median_of(lengths);
}

/// Empty when any name that the source needs is not recorded.
FoundSource find_source(const Clip& clip, const NameIndex& names, const JointSource& wanted) {
  FoundSource found{find_all(names, wanted.points), wanted.offset, false, {}, {}, {}};
  if (found.empty() || !found.has_offset()) return found;
  bool is_complete = true;
  const auto look_up = [&](const PointSpan& span) {
    FoundSpan indices{find_all(names, span.from), find_all(names, span.to)};
    if (!span.empty() && (indices.from.empty() || indices.to.empty())) is_complete = false;
    return indices;
  };
  found.across = look_up(wanted.across);
  found.ahead = look_up(wanted.ahead);
  found.along = look_up(wanted.along);
  const FoundSpan scale = look_up(wanted.scale);
  if (!is_complete) return {};
  found.is_scaled = !wanted.scale.empty();
  if (found.is_scaled) found.offset *= median_length(clip, scale);
  return found;
}

}  // namespace

JointSources find_sources(const Clip& clip, const JointMap& map) {
  const NameIndex names = index_names(clip);
  JointSources sources;
  for (const auto& [joint, wanted] : map.sources) {
    FoundSource& source = sources[index(joint)];
    if (source.empty()) source = find_source(clip, names, wanted);
  }
  return sources;
}

Vec3 plain_mean(const Clip& clip, std::size_t frame, const std::vector<std::size_t>& points) {
  if (points.empty()) return Vec3(kMissing);
  Vec3 sum(0.0);
  for (const std::size_t point : points) sum += clip.at(frame, point);
  return sum / static_cast<double>(points.size());
}

Vec3 joint_centre(const Clip& clip, std::size_t frame, const FoundSource& source) {
  const Vec3 mean = plain_mean(clip, frame, source.points);
  if (!source.has_offset()) return mean;
  const Vec3 right = glm::normalize(span_vector(clip, frame, source.across));
  Vec3 up(0.0, 0.0, 1.0);
  if (!source.ahead.from.empty()) {
    up = glm::cross(right, span_vector(clip, frame, source.ahead));
  } else if (!source.along.from.empty()) {
    up = span_vector(clip, frame, source.along);
  }
  up = glm::normalize(up - glm::dot(up, right) * right);
  return mean + source.offset.x * right + source.offset.y * glm::cross(up, right) + source.offset.z * up;
}

std::string missing_joints(const JointSources& sources) {
  std::string missing;
  for (const Joint joint : required_joints()) {
    if (sources[index(joint)].empty()) missing += (missing.empty() ? "" : ", ") + std::string(joint_name(joint));
  }
  return missing;
}

double stature_in_units(const Clip& clip, const JointSources& sources) {
  using enum Joint;
  std::vector<double> lengths;
  for (std::size_t frame = 0; frame < clip.frames(); ++frame) {
    const auto point = [&](Joint joint) {
      const FoundSource& source = sources[index(joint)];
      return source.is_scaled ? joint_centre(clip, frame, source) : plain_mean(clip, frame, source.points);
    };
    const Vec3 hips[] = {point(left_hip), point(right_hip)};
    const double legs = glm::distance(hips[0], point(left_knee)) + glm::distance(point(left_knee), point(left_ankle)) +
                        glm::distance(hips[1], point(right_knee)) +
                        glm::distance(point(right_knee), point(right_ankle));
    const double trunk = glm::length(point(left_shoulder) + point(right_shoulder) - hips[0] - hips[1]);
    lengths.push_back(0.5 * (legs + trunk));
  }
  return median_of(lengths) / kShankThighTrunk;
}

const JointMap* best_joint_map(const Clip& clip) {
  const JointMap* best = nullptr;
  std::ptrdiff_t most = 0;
  for (const JointMap& map : joint_map_presets()) {
    const JointSources sources = find_sources(clip, map);
    const auto found =
        std::count_if(sources.begin(), sources.end(), [](const auto& source) { return !source.empty(); });
    if (found <= most || !missing_joints(sources).empty()) continue;
    best = &map;
    most = found;
  }
  return best;
}

}  // namespace reachcast
