// SPDX-License-Identifier: GPL-3.0-or-later
/// A rig at rest in the world: its bones, which of them are which segment, and the joint centres they imply.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "reachcast/body/body.hpp"
#include "reachcast/rig/segments.hpp"

namespace reachcast {

/// Parents stand before their children. World, metres.
struct RestBones {
  std::vector<int> parents;     ///< -1 for a root
  Points heads;                 ///< one per bone
  std::vector<Mat3> rotations;  ///< one per bone: columns are the bone's own axes
};

class RestRig {
 public:
  static constexpr int kNone = -1;

  /// `segments`: bone of each segment by name; all are needed but the toes, and no bone serves twice but for spine and
  /// chest. `joints`: rest joint centres, world. `axes`: columns are the body's right, forward and up in the world.
  ///
  /// Throws std::invalid_argument naming the bone, segment or joint with its value and the limit: numbers must be
  /// finite, rotations and axes right-handed to 1e-6, links longer than nothing, pelvis and chest triangles.
  RestRig(RestBones bones, const std::map<std::string, int>& segments, const Posture& joints, const Mat3& axes);

  [[nodiscard]] const RestBones& bones() const { return bones_; }
  [[nodiscard]] const Mat3& axes() const { return axes_; }
  [[nodiscard]] const Posture& joints() const { return joints_; }
  [[nodiscard]] const Vec3& at(Joint joint) const { return joints_[index(joint)]; }
  [[nodiscard]] const Vec3& right() const { return axes_[0]; }
  [[nodiscard]] const Vec3& forward() const { return axes_[1]; }
  [[nodiscard]] const Vec3& up() const { return axes_[2]; }

  /// Mapped bones and all above them, parents first: those that get keys.
  [[nodiscard]] const std::vector<int>& keyed() const { return keyed_; }
  /// Place of a bone in keyed(), kNone for the others.
  [[nodiscard]] int slot(int bone) const { return slots_[static_cast<std::size_t>(bone)]; }
  /// Bone of a segment, kNone for a toe that is not mapped.
  [[nodiscard]] int bone(Segment segment) const { return bone_of_[index(segment)]; }
  /// The bones of the back, lowest first: from the spine's bone to the chest's, or to the one below it on which the
  /// neck or a clavicle hangs. What is above follows the last of them.
  [[nodiscard]] const std::vector<int>& back() const { return back_; }
  /// From the head of each of these to the next, and at last to c7t1, which is a point of the last one.
  [[nodiscard]] const Points& back_pieces() const { return back_pieces_; }
  /// Segment of a bone as a number, kNone for bones that are not mapped.
  [[nodiscard]] int segment(int bone) const { return segment_of_[static_cast<std::size_t>(bone)]; }

 private:
  void map_segments(const std::map<std::string, int>& segments);
  void find_keyed();
  void find_back();

  RestBones bones_;
  Posture joints_;
  Mat3 axes_;
  std::array<int, kSegmentCount> bone_of_{};
  std::vector<int> segment_of_, slots_, keyed_, back_;
  Points back_pieces_;
};

}  // namespace reachcast
