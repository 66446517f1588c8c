// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/mocap/bvh.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bvh_skeleton.hpp"
#include "settle.hpp"
#include "units.hpp"

namespace reachcast {
namespace {

constexpr std::size_t kMostPoints = 100'000'000;  // 2.4 GB; an hour of 60 joints at 120 Hz is 26 million

/// Multiplies a rotation by one about a coordinate axis, from the right: only two columns change.
void turn(Mat3& rotation, int axis, double degrees) {
  const double angle = degrees * (kPi / 180.0);
  const double cosine = std::cos(angle);
  const double sine = std::sin(angle);
  const int j = (axis + 1) % 3;
  const int k = (axis + 2) % 3;
  const Vec3 old_j = rotation[j];
  rotation[j] = cosine * old_j + sine * rotation[k];
  rotation[k] = cosine * rotation[k] - sine * old_j;
}

/// Forward kinematics of one frame: joint centres in file units and axes.
class ForwardKinematics {
 public:
  explicit ForwardKinematics(const BvhSkeleton& skeleton)
      : skeleton_(skeleton), rotations_(skeleton.joints.size(), Mat3(1.0)), points_(skeleton.joints.size()) {}

  const Points& place(const std::vector<double>& values) {
    const double* value = values.data();
    for (std::size_t i = 0; i < skeleton_.joints.size(); ++i) {
      const BvhJoint& joint = skeleton_.joints[i];
      const auto parent = static_cast<std::size_t>(joint.parent);
      const Mat3 parent_rotation = joint.parent < 0 ? Mat3(1.0) : rotations_[parent];
      Mat3 rotation = parent_rotation;
      Vec3 local = joint.offset;
      for (const BvhChannel channel : joint.channels) {
        if (channel < 3) {
          local[channel] = *value++;
        } else {
          turn(rotation, channel - 3, *value++);
        }
      }
      const Vec3 origin = joint.parent < 0 ? Vec3(0.0) : points_[parent];
      points_[i] = origin + parent_rotation * local;
      rotations_[i] = rotation;
    }
    return points_;
  }

 private:
  const BvhSkeleton& skeleton_;
  std::vector<Mat3> rotations_;
  Points points_;
};

/// The number behind "Frames:" or "Frame Time:". The colon may stand alone or touch the number.
double read_field(TextScanner& scanner, std::string_view keyword) {
  const std::string wanted(keyword);
  if (!scanner.next_line_with_words()) scanner.fail(wanted + ':', {});
  const std::string_view line = scanner.rest_of_line();
  const std::size_t colon = std::min(line.find(':'), line.size());
  std::string words;
  for (const char c : line.substr(0, colon)) {
    if (c != ' ' && c != '\t') words += c;
    if (words.size() > keyword.size()) break;
  }
  std::string compact = wanted;
  std::erase(compact, ' ');
  if (colon == line.size() || !equal_ignoring_case(words, compact)) scanner.fail(wanted + ':', line);
  std::string_view text = line.substr(colon + 1);
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  const std::optional<double> value = parse_number(text);
  if (!value) scanner.fail_found("a number after " + wanted + ':', text.empty() ? "nothing" : quote(text));
  return *value;
}

std::optional<double> read_rate(TextScanner& scanner, const MotionFileOptions& options, std::string& note) {
  constexpr double longest_s = 1e3;
  constexpr double shortest_s = 1e-6;
  const double step_s = read_field(scanner, "Frame Time");
  if (options.rate_hz) return std::nullopt;
  if (!(step_s >= shortest_s && step_s <= longest_s)) {
    scanner.fail_found("a Frame Time between 1e-6 and 1000 s (or give rate)", show(step_s));
  }
  if (step_s > 1.0) add_note(note, "A frame lasts " + show(step_s) + " s: is that right?");
  return 1.0 / step_s;
}

/// One line of numbers into `values`; the line's end is left for the caller.
void read_values(TextScanner& scanner, std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string_view word = scanner.word_on_line();
    const std::optional<double> value = parse_number(word);
    if (!value && word.empty()) {
      scanner.fail_found(std::to_string(values.size()) + " numbers in a frame", "only " + std::to_string(i));
    }
    if (!value) scanner.fail("a number", word);
    values[i] = *value;
  }
  const std::string_view extra = scanner.word_on_line();
  if (!extra.empty()) {
    scanner.fail_found("the line to end after " + std::to_string(values.size()) + " numbers", quote(extra));
  }
}

void read_frames(TextScanner& scanner, const BvhSkeleton& skeleton, double stated_frames, MotionFile& file) {
  ForwardKinematics kinematics(skeleton);
  std::vector<double> values(skeleton.channel_count);
  const std::size_t joints = skeleton.joints.size();
  std::size_t frames = 0;
  // At least two bytes per number; whatever is announced, no more than 24 bytes of memory per byte of text.
  const double most_frames = static_cast<double>(scanner.remaining() / 2 / skeleton.channel_count);
  const auto expected = static_cast<std::size_t>(std::clamp(stated_frames, 0.0, most_frames));
  file.positions.reserve(std::min(expected * joints, scanner.remaining()));
  while (scanner.next_line_with_words()) {
    read_values(scanner, values);
    if (++frames * joints > kMostPoints) {
      scanner.fail_found("at most " + std::to_string(kMostPoints / joints) + " frames", "more");
    }
    const Points& points = kinematics.place(values);
    file.positions.insert(file.positions.end(), points.begin(), points.end());
  }
  if (frames == 0) scanner.fail_found("at least one frame", "none");
  if (static_cast<double>(frames) != stated_frames) {
    add_note(file.note, "The file announces " + show(stated_frames) + " frames and has " + std::to_string(frames) +
                            "; all of them were read.");
  }
}

}  // namespace

MotionFile read_bvh(const std::string& path, const MotionFileOptions& options) {
  return parse_bvh(read_text_file(path), path, options);
}

MotionFile parse_bvh(std::string_view text, const std::string& source, const MotionFileOptions& options) {
  check_options(options);
  TextScanner scanner(text, source);
  MotionFile file;
  file.source = source;
  const BvhSkeleton skeleton = read_bvh_skeleton(scanner);
  file.names = skeleton.names();
  file.derived.assign(file.names.size(), false);
  const double stated_frames = read_field(scanner, "Frames");
  settle_rate(options, read_rate(scanner, options, file.note), file);
  read_frames(scanner, skeleton, stated_frames, file);
  FileSays says;
  says.usual_up.assign(1, 'y');
  says.skeleton_height = skeleton.height();
  settle(options, says, file);
  return file;
}

}  // namespace reachcast
