// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/mocap/joint_map.hpp"

#include <algorithm>
#include <stdexcept>
#include <unordered_map>

#include "joint_sources.hpp"

namespace reachcast {
namespace {

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

}  // namespace

const std::vector<Joint>& required_joints() {
  using enum Joint;
  static const std::vector<Joint> required{left_ankle, left_knee,      left_hip,    left_shoulder,
                                           left_elbow, left_wrist,     right_ankle, right_knee,
                                           right_hip,  right_shoulder, right_elbow, right_wrist};
  return required;
}

JointSources find_sources(const Clip& clip, const JointMap& map) {
  const NameIndex names = index_names(clip);
  JointSources sources;
  for (const auto& [joint, wanted] : map.sources) {
    std::vector<std::size_t>& source = sources[index(joint)];
    if (source.empty()) source = find_all(names, wanted);
  }
  return sources;
}

std::string missing_joints(const JointSources& sources) {
  std::string missing;
  for (const Joint joint : required_joints()) {
    if (sources[index(joint)].empty()) missing += (missing.empty() ? "" : ", ") + std::string(joint_name(joint));
  }
  return missing;
}

const JointMap& detect_joint_map(const Clip& clip) {
  const JointMap* best = nullptr;
  std::size_t most = 0;
  const JointMap* nearest = nullptr;
  std::size_t fewest_missing = required_joints().size() + 1;
  for (const JointMap& map : joint_map_presets()) {
    const JointSources sources = find_sources(clip, map);
    const auto found = static_cast<std::size_t>(
        std::count_if(sources.begin(), sources.end(), [](const auto& source) { return !source.empty(); }));
    const auto lacking =
        static_cast<std::size_t>(std::count_if(required_joints().begin(), required_joints().end(),
                                               [&](Joint joint) { return sources[index(joint)].empty(); }));
    if (lacking == 0 && found > most) {
      best = &map;
      most = found;
    }
    if (lacking < fewest_missing) {
      nearest = &map;
      fewest_missing = lacking;
    }
  }
  if (best) return *best;
  throw std::invalid_argument(clip.source + ": no known set of joint names fits; the nearest is '" + nearest->name +
                              "', which finds no point for " + missing_joints(find_sources(clip, *nearest)) +
                              "; give a joint map");
}

}  // namespace reachcast
