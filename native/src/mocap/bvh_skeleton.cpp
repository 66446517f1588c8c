// SPDX-License-Identifier: GPL-3.0-or-later
#include "bvh_skeleton.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_set>

#include "units.hpp"

namespace reachcast {
namespace {

constexpr std::size_t kDeepest = 512;      // real skeletons stay under 40
constexpr std::size_t kMostJoints = 5000;  // real skeletons stay under 300

constexpr std::array<std::string_view, 6> kChannelNames{"Xposition", "Yposition", "Zposition",
                                                        "Xrotation", "Yrotation", "Zrotation"};

/// Keeps the stack of open joints itself, so that deep nesting costs no call depth.
class SkeletonReader {
 public:
  explicit SkeletonReader(TextScanner& scanner) : scanner_(scanner) {}

  BvhSkeleton read() {
    expect("HIERARCHY");
    for (bool more = true; more;) more = read_statement();
    if (skeleton_.joints.empty()) scanner_.fail_found("ROOT before MOTION", "no joint");
    if (skeleton_.channel_count == 0) scanner_.fail_found("CHANNELS on at least one joint", "none");
    return std::move(skeleton_);
  }

 private:
  struct Open {
    int joint;
    bool has_offset;
  };

  /// False once MOTION has been read.
  bool read_statement() {
    const std::string_view word = scanner_.word();
    if (open_.empty()) {
      if (equal_ignoring_case(word, "MOTION")) return false;
      if (!equal_ignoring_case(word, "ROOT")) scanner_.fail("ROOT or MOTION", word);
      open_joint(joint_name());
    } else if (word == "}") {
      if (!open_.back().has_offset) scanner_.fail("OFFSET of joint " + quote(current().name), word);
      open_.pop_back();
    } else if (equal_ignoring_case(word, "OFFSET")) {
      for (int axis = 0; axis < 3; ++axis) current().offset[axis] = scanner_.number("a number of OFFSET");
      open_.back().has_offset = true;
    } else if (equal_ignoring_case(word, "CHANNELS")) {
      read_channels();
    } else if (equal_ignoring_case(word, "JOINT")) {
      open_joint(joint_name());
    } else if (equal_ignoring_case(word, "End")) {
      scanner_.rest_of_line();
      open_joint(current().name + "_end");
    } else {
      scanner_.fail("OFFSET, CHANNELS, JOINT, End Site or }", word);
    }
    return true;
  }

  BvhJoint& current() { return skeleton_.joints[static_cast<std::size_t>(open_.back().joint)]; }

  void expect(std::string_view keyword) {
    const std::string_view word = scanner_.word();
    if (!equal_ignoring_case(word, keyword)) scanner_.fail(keyword, word);
  }

  std::string joint_name() {
    const std::string name(scanner_.rest_of_line());
    if (name.empty()) scanner_.fail_found("the name of a joint", "none");
    return name;
  }

  void open_joint(const std::string& name) {
    expect("{");
    if (open_.size() >= kDeepest) scanner_.fail_found("at most " + std::to_string(kDeepest) + " nested joints", "more");
    if (skeleton_.joints.size() >= kMostJoints) {
      scanner_.fail_found("at most " + std::to_string(kMostJoints) + " joints", "more");
    }
    const int parent = open_.empty() ? -1 : open_.back().joint;
    skeleton_.joints.push_back({unique(name), parent, Vec3(0.0), {}});
    open_.push_back({static_cast<int>(skeleton_.joints.size()) - 1, false});
  }

  std::string unique(const std::string& name) {
    std::string candidate = name;
    for (int copy = 2; !taken_.insert(candidate).second; ++copy) candidate = name + '_' + std::to_string(copy);
    return candidate;
  }

  void read_channels() {
    constexpr int most = 12;
    if (!current().channels.empty()) scanner_.fail_found("CHANNELS once per joint", "them twice");
    const double count = scanner_.number("the number of channels");
    if (count != std::floor(count) || count < 0 || count > most) {
      scanner_.fail_found("a number of channels from 0 to " + std::to_string(most), "another number");
    }
    for (int i = 0; i < static_cast<int>(count); ++i) {
      const std::string_view word = scanner_.word();
      std::size_t channel = 0;
      while (channel < kChannelNames.size() && !equal_ignoring_case(word, kChannelNames[channel])) ++channel;
      if (channel == kChannelNames.size()) scanner_.fail("a channel such as Xposition or Zrotation", word);
      current().channels.push_back(static_cast<BvhChannel>(channel));
    }
    skeleton_.channel_count += current().channels.size();
  }

  TextScanner& scanner_;
  BvhSkeleton skeleton_;
  std::vector<Open> open_;
  std::unordered_set<std::string> taken_;
};

}  // namespace

std::vector<std::string> BvhSkeleton::names() const {
  std::vector<std::string> all;
  all.reserve(joints.size());
  for (const BvhJoint& joint : joints) all.push_back(joint.name);
  return all;
}

double BvhSkeleton::height() const {
  std::vector<double> paths(joints.size(), 0.0);  // from the root, along the bones
  Points rest(joints.size(), Vec3(0.0));
  Vec3 low(0.0), high(0.0);
  double to_head = 0.0;
  double to_foot = 0.0;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].parent < 0) continue;
    const auto parent = static_cast<std::size_t>(joints[i].parent);
    paths[i] = paths[parent] + glm::length(joints[i].offset);
    rest[i] = rest[parent] + joints[i].offset;
    low = glm::min(low, rest[i]);
    high = glm::max(high, rest[i]);
    const BodyEnd end = body_end(joints[i].name);
    if (end == BodyEnd::high) to_head = std::max(to_head, paths[i]);
    const bool is_tip = body_end(joints[parent].name) == BodyEnd::low;  // toes point forward, not down
    if (end == BodyEnd::low && !is_tip) to_foot = std::max(to_foot, paths[i]);
  }
  if (to_head > 0.0 && to_foot > 0.0) return to_head + to_foot;
  const Vec3 extent = high - low;
  return std::max({extent.x, extent.y, extent.z});
}

BvhSkeleton read_bvh_skeleton(TextScanner& scanner) {
  return SkeletonReader(scanner).read();
}

}  // namespace reachcast
