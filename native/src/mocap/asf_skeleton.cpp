// SPDX-License-Identifier: GPL-3.0-or-later
#include "asf_skeleton.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "text_scanner.hpp"

namespace reachcast {
namespace {

constexpr std::size_t kMostBones = 5000;
constexpr double kInch_m = 0.0254;

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t begin = 0; begin < line.size();) {
    if (static_cast<unsigned char>(line[begin]) <= ' ') {
      ++begin;
      continue;
    }
    std::size_t end = begin;
    while (end < line.size() && static_cast<unsigned char>(line[end]) > ' ') ++end;
    words.push_back(line.substr(begin, end - begin));
    begin = end;
  }
  return words;
}

/// The file line by line; comments and blank lines are passed over.
class AsfReader {
 public:
  AsfReader(std::string_view text, const std::string& source) : scanner_(text, source), line_(scanner_) {}

  AsfSkeleton read() {
    skeleton_.bones.push_back({"root", -1, Vec3(0.0), Mat3(1.0), {}, false});
    bool more = next();
    while (more) {
      const std::string_view section = words_.front();
      if (section == ":units") {
        more = read_units();
      } else if (section == ":root") {
        more = read_root();
      } else if (section == ":bonedata") {
        more = read_bones();
      } else if (section == ":hierarchy") {
        more = read_hierarchy();
      } else if (section.starts_with(':')) {
        more = skip_section();
      } else {
        line_.fail("a section such as :bonedata", section);
      }
    }
    if (!has_hierarchy_) line_.fail_found("a section :hierarchy", "none");
    sort_bones();
    return std::move(skeleton_);
  }

 private:
  bool next() {
    words_.clear();
    while (words_.empty()) {
      if (!scanner_.next_line_with_words()) return false;
      line_ = scanner_;
      words_ = words_of(scanner_.take_line());
      if (words_.front().starts_with('#')) words_.clear();
    }
    return true;
  }
  bool next_in_section() { return next() && !words_.front().starts_with(':'); }
  bool at_section() const { return !words_.empty(); }

  bool skip_section() {
    while (next_in_section()) {
    }
    return at_section();
  }

  double number(std::size_t word) {
    if (word >= words_.size()) line_.fail_found("a number", "the end of the line");
    const std::optional<double> value = parse_number(words_[word]);
    if (!value) line_.fail("a number", words_[word]);
    return *value;
  }
  Vec3 vector() { return {number(1), number(2), number(3)}; }

  bool read_units() {
    while (next_in_section()) {
      if (words_.front() == "length") {
        const double length = number(1);
        if (!(length > 0.0)) line_.fail("a length over 0", words_[1]);
        skeleton_.metres_per_unit = kInch_m / length;
      } else if (words_.front() == "angle") {
        const bool is_radians = words_.size() > 1 && words_[1].starts_with("rad");
        if (!is_radians && (words_.size() < 2 || !words_[1].starts_with("deg"))) {
          line_.fail_found("angle deg or angle rad", words_.size() > 1 ? quote(words_[1]) : "nothing");
        }
        if (is_radians) skeleton_.radians_per_unit = 1.0;
      }
    }
    return at_section();
  }

  AsfChannel channel(std::string_view word) {
    constexpr std::array<std::string_view, 6> known{"rx", "ry", "rz", "tx", "ty", "tz"};
    for (std::size_t i = 0; i < known.size(); ++i) {
      if (equal_ignoring_case(word, known[i])) return static_cast<AsfChannel>(i);
    }
    line_.fail("rx, ry, rz, tx, ty or tz", word);
  }

  std::vector<AsfChannel> axis_order(std::string_view word) {
    std::vector<AsfChannel> order;
    for (const char c : word) {
      const char axis = static_cast<char>(c | 0x20);
      if (axis < 'x' || axis > 'z' || order.size() == 3) line_.fail("an order of axes such as XYZ", word);
      order.push_back(static_cast<AsfChannel>(axis - 'x'));
    }
    return order;
  }

  bool read_root() {
    std::vector<AsfChannel> order{0, 1, 2};
    Vec3 orientation(0.0);
    while (next_in_section()) {
      if (words_.front() == "order") {
        for (std::size_t i = 1; i < words_.size(); ++i) skeleton_.bones[0].channels.push_back(channel(words_[i]));
        if (skeleton_.bones[0].channels.size() > 6) line_.fail_found("at most 6 channels of the root", "more");
      } else if (words_.front() == "axis") {
        order = axis_order(words_.size() > 1 ? words_[1] : "");
      } else if (words_.front() == "position") {
        skeleton_.position = vector();
      } else if (words_.front() == "orientation") {
        orientation = vector();
      }
    }
    if (order.size() != 3) line_.fail_found("three axes of the root", std::to_string(order.size()));
    orientation *= skeleton_.radians_per_unit;
    skeleton_.bones[0].axes = rotation_in_order(order, &orientation.x);
    return at_section();
  }

  bool read_bones() {
    while (next_in_section()) {
      if (words_.front() != "begin") line_.fail("begin", words_.front());
      read_bone();
    }
    return at_section();
  }

  void read_bone() {
    AsfBone bone;
    Vec3 direction(0.0);
    double length = 0.0;
    while (next_in_section() && words_.front() != "end") {
      if (words_.front() == "name") {
        bone.name = words_.size() > 1 ? std::string(words_[1]) : "";
      } else if (words_.front() == "direction") {
        direction = vector();
      } else if (words_.front() == "length") {
        length = number(1);
      } else if (words_.front() == "axis") {
        const std::vector<AsfChannel> order = axis_order(words_.size() > 4 ? words_[4] : "XYZ");
        Vec3 angles = vector() * skeleton_.radians_per_unit;
        if (order.size() != 3) line_.fail_found("three axes of a bone", std::to_string(order.size()));
        bone.axes = rotation_in_order(order, &angles.x);
      } else if (words_.front() == "dof") {
        read_dof(bone);
      }
    }
    if (words_.empty() || words_.front() != "end") line_.fail_found("end of a bone", "another section");
    if (bone.name.empty()) line_.fail_found("the name of a bone", "none");
    if (skeleton_.find(bone.name)) line_.fail_found("every bone once", quote(bone.name));
    if (skeleton_.bones.size() >= kMostBones)
      line_.fail_found("at most " + std::to_string(kMostBones) + " bones", "more");
    const double size = glm::length(direction);
    bone.along = size > 0.0 ? direction * (length / size) : Vec3(0.0);
    skeleton_.bones.push_back(bone);
  }

  void read_dof(AsfBone& bone) {
    for (std::size_t i = 1; i < words_.size(); ++i) {
      const bool stretches = equal_ignoring_case(words_[i], "l");
      if (stretches || channel(words_[i]) > 2) {
        line_.fail("bones that only turn (dof rx, ry, rz): one that moves or stretches leaves its joint", words_[i]);
      }
      bone.channels.push_back(channel(words_[i]));
    }
    if (bone.channels.size() > 3) line_.fail_found("at most three rotations of a bone", "more");
  }

  bool read_hierarchy() {
    has_hierarchy_ = true;
    while (next_in_section()) {
      if (words_.front() == "begin" || words_.front() == "end") continue;
      const std::size_t parent = bone(words_.front());
      for (std::size_t i = 1; i < words_.size(); ++i) {
        AsfBone& child = skeleton_.bones[bone(words_[i])];
        if (child.parent >= 0 || &child == &skeleton_.bones[0]) line_.fail("one parent per bone", words_[i]);
        child.parent = static_cast<int>(parent);
        skeleton_.bones[parent].has_child = true;
      }
    }
    return at_section();
  }

  std::size_t bone(std::string_view name) {
    const std::optional<std::size_t> found = skeleton_.find(name);
    if (!found) line_.fail("the name of a bone", name);
    return *found;
  }

  /// Parents before children, else in the order of the file; bones that hang on no root are refused.
  void sort_bones() {
    std::vector<AsfBone>& bones = skeleton_.bones;
    std::vector<int> place(bones.size(), -1);
    std::vector<AsfBone> sorted{bones[0]};
    place[0] = 0;
    for (bool is_growing = true; is_growing;) {
      is_growing = false;
      for (std::size_t i = 1; i < bones.size(); ++i) {
        const int parent = bones[i].parent;
        if (place[i] >= 0 || parent < 0 || place[static_cast<std::size_t>(parent)] < 0) continue;
        place[i] = static_cast<int>(sorted.size());
        sorted.push_back(bones[i]);
        sorted.back().parent = place[static_cast<std::size_t>(parent)];
        is_growing = true;
      }
    }
    for (std::size_t i = 0; i < bones.size(); ++i) {
      if (place[i] < 0) line_.fail_found("every bone to hang on the root", quote(bones[i].name) + " loose");
    }
    bones = std::move(sorted);
  }

  TextScanner scanner_;
  TextScanner line_;  ///< where the current line begins, for messages
  std::vector<std::string_view> words_;
  AsfSkeleton skeleton_;
  bool has_hierarchy_ = false;
};

}  // namespace

std::optional<std::size_t> AsfSkeleton::find(std::string_view name) const {
  for (std::size_t i = 0; i < bones.size(); ++i) {
    if (bones[i].name == name) return i;
  }
  return std::nullopt;
}

Mat3 rotation_in_order(const std::vector<AsfChannel>& order, const double* angles_rad) {
  Mat3 rotation(1.0);
  for (const AsfChannel channel : order) {
    Vec3 axis(0.0);
    axis[channel % 3] = 1.0;
    rotation = glm::mat3_cast(glm::angleAxis(*angles_rad++, axis)) * rotation;
  }
  return rotation;
}

AsfSkeleton read_asf_skeleton(std::string_view text, const std::string& source) {
  return AsfReader(text, source).read();
}

}  // namespace reachcast
