// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/mocap/acclaim.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "asf_skeleton.hpp"
#include "settle.hpp"
#include "text_scanner.hpp"
#include "units.hpp"

namespace reachcast {
namespace {

constexpr std::size_t kMostPoints = 100'000'000;

/// One frame: the values of each bone, then where the bones are.
class AsfPose {
 public:
  explicit AsfPose(const AsfSkeleton& skeleton)
      : skeleton_(skeleton),
        values_(skeleton.bones.size()),
        starts_(skeleton.bones.size()),
        turns_(skeleton.bones.size()) {}

  std::vector<double>& values(std::size_t bone) { return values_[bone]; }

  /// Bones that a frame leaves out are at rest.
  void rest() {
    for (std::size_t i = 0; i < values_.size(); ++i) values_[i].assign(skeleton_.bones[i].channels.size(), 0.0);
  }

  /// Appends the start of each bone, then the ends of those without children.
  void place(Points& points) {
    for (std::size_t i = 0; i < skeleton_.bones.size(); ++i) {
      const AsfBone& bone = skeleton_.bones[i];
      const Mat3 own = bone.axes * turned(i) * glm::transpose(bone.axes);  // C M C^-1
      if (bone.parent < 0) {
        starts_[i] = skeleton_.position + moved(i);
        turns_[i] = own;
      } else {
        const auto parent = static_cast<std::size_t>(bone.parent);
        starts_[i] = starts_[parent] + turns_[parent] * skeleton_.bones[parent].along;
        turns_[i] = turns_[parent] * own;
      }
      points.push_back(starts_[i]);
    }
    for (std::size_t i = 0; i < skeleton_.bones.size(); ++i) {
      if (!skeleton_.bones[i].has_child) points.push_back(starts_[i] + turns_[i] * skeleton_.bones[i].along);
    }
  }

 private:
  Mat3 turned(std::size_t bone) const {
    std::vector<AsfChannel> order;
    std::vector<double> angles;
    for (std::size_t i = 0; i < values_[bone].size(); ++i) {
      if (skeleton_.bones[bone].channels[i] > 2) continue;
      order.push_back(skeleton_.bones[bone].channels[i]);
      angles.push_back(values_[bone][i] * skeleton_.radians_per_unit);
    }
    return rotation_in_order(order, angles.data());
  }

  Vec3 moved(std::size_t bone) const {
    Vec3 by(0.0);
    for (std::size_t i = 0; i < values_[bone].size(); ++i) {
      const AsfChannel channel = skeleton_.bones[bone].channels[i];
      if (channel > 2) by[channel - 3] = values_[bone][i];
    }
    return by;
  }

  const AsfSkeleton& skeleton_;
  std::vector<std::vector<double>> values_;
  Points starts_;
  std::vector<Mat3> turns_;
};

void read_bone_line(TextScanner& scanner, const AsfSkeleton& skeleton, std::string_view name, AsfPose& pose) {
  const std::optional<std::size_t> bone = skeleton.find(name);
  if (!bone) scanner.fail("the name of a bone of the skeleton or the number of a frame", name);
  std::vector<double>& values = pose.values(*bone);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string_view word = scanner.word_on_line();
    const std::optional<double> value = parse_number(word);
    if (!value) {
      scanner.fail_found(std::to_string(values.size()) + " numbers of " + quote(name),
                         word.empty() ? "only " + std::to_string(i) : quote(word));
    }
    values[i] = *value;
  }
  const std::string_view extra = scanner.word_on_line();
  if (!extra.empty()) {
    scanner.fail_found("the line to end after " + std::to_string(values.size()) + " numbers of " + quote(name),
                       quote(extra));
  }
}

/// Lines before the first frame: comments, :FULLY-SPECIFIED, :DEGREES or :RADIANS.
bool is_head_line(TextScanner& scanner, std::string_view word, AsfSkeleton& skeleton) {
  if (!word.starts_with('#') && !word.starts_with(':')) return false;
  if (equal_ignoring_case(word, ":radians")) skeleton.radians_per_unit = 1.0;
  if (equal_ignoring_case(word, ":degrees")) skeleton.radians_per_unit = kPi / 180.0;
  scanner.take_line();
  return true;
}

void read_frames(TextScanner& scanner, AsfSkeleton& skeleton, MotionFile& file) {
  AsfPose pose(skeleton);
  std::size_t frames = 0;
  bool has_bones = false;
  while (scanner.next_line_with_words()) {
    const std::string_view word = scanner.word_on_line();
    if (is_head_line(scanner, word, skeleton)) continue;
    if (parse_number(word)) {
      if (frames > 0 && !has_bones) scanner.fail_found("bones in a frame", "the next frame");
      if (frames > 0) pose.place(file.positions);
      if (++frames * file.joints() > kMostPoints) {
        scanner.fail_found("at most " + std::to_string(kMostPoints / file.joints()) + " frames", "more");
      }
      has_bones = false;
      pose.rest();
      const std::string_view extra = scanner.word_on_line();
      if (!extra.empty()) scanner.fail_found("the line to end after a frame's number", quote(extra));
    } else {
      if (frames == 0) scanner.fail("the number of a frame", word);
      read_bone_line(scanner, skeleton, word, pose);
      has_bones = true;
    }
  }
  if (frames == 0 || !has_bones) scanner.fail_found("at least one frame, and bones in the last", "none");
  pose.place(file.positions);
}

/// Foot to head along the bones at rest, in file units: through the root from the lowest tip to the highest.
double height_at_rest(const AsfSkeleton& skeleton) {
  std::vector<double> paths(skeleton.bones.size(), 0.0);
  double to_head = 0.0, to_foot = 0.0;
  for (std::size_t i = 1; i < skeleton.bones.size(); ++i) {
    const auto parent = static_cast<std::size_t>(skeleton.bones[i].parent);
    paths[i] = paths[parent] + glm::length(skeleton.bones[i].along);
    const BodyEnd end = body_end(skeleton.bones[i].name);
    if (end == BodyEnd::high) to_head = std::max(to_head, paths[i]);
    if (end == BodyEnd::low) to_foot = std::max(to_foot, paths[parent]);  // a foot's start is the ankle
  }
  return to_head > 0.0 && to_foot > 0.0 ? to_head + to_foot : kMissing;
}

std::string find_skeleton(const std::string& path) {
  namespace fs = std::filesystem;
  const fs::path amc(path);
  const std::string stem = amc.stem().string();
  std::error_code ignored;
  for (const std::string& name : {stem, stem.substr(0, stem.rfind('_'))}) {
    for (const char* ending : {".asf", ".ASF"}) {
      const fs::path candidate = amc.parent_path() / (name + ending);
      if (fs::is_regular_file(candidate, ignored)) return candidate.string();
    }
  }
  std::vector<std::string> all;
  const fs::path folder = amc.parent_path().empty() ? fs::path(".") : amc.parent_path();
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (equal_ignoring_case(entry.path().extension().string(), ".asf")) all.push_back(entry.path().string());
  }
  if (all.size() == 1) return all.front();
  throw std::invalid_argument(path + ": expected its skeleton " + stem + ".asf beside it, found " +
                              (all.empty() ? "no .asf" : std::to_string(all.size()) + " other .asf") +
                              " in the folder; give skeleton");
}

}  // namespace

MotionFile read_amc(const std::string& path, const MotionFileOptions& options) {
  const std::string text = read_text_file(path);
  const std::string asf = options.skeleton ? *options.skeleton : find_skeleton(path);
  return parse_amc(text, path, read_text_file(asf), asf, options);
}

MotionFile parse_amc(std::string_view amc, const std::string& amc_source, std::string_view asf,
                     const std::string& asf_source, const MotionFileOptions& options) {
  check_options(options);
  AsfSkeleton skeleton = read_asf_skeleton(asf, asf_source);
  MotionFile file;
  file.source = amc_source;
  settle_rate(options, {}, file);
  for (const AsfBone& bone : skeleton.bones) file.names.push_back(bone.name);
  for (const AsfBone& bone : skeleton.bones) {
    if (!bone.has_child) file.names.push_back(bone.name + "_end");
  }
  file.derived.assign(file.names.size(), false);
  TextScanner scanner(amc, amc_source);
  read_frames(scanner, skeleton, file);
  FileSays says;
  says.metres_per_unit = skeleton.metres_per_unit;
  says.usual_up.assign(1, 'y');
  const double height = height_at_rest(skeleton);
  if (height > 0.0) says.skeleton_height = height;
  settle(options, says, file);
  return file;
}

}  // namespace reachcast
