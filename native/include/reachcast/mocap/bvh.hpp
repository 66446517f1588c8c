// SPDX-License-Identifier: GPL-3.0-or-later
/// Biovision hierarchies (.bvh): a tree of joints with Euler angles per frame, turned into joint centres.
///
/// Conventions, as in Blender's own importer:
/// - A joint's rotation is the product of its rotation channels in the order listed, R = R1 R2 R3, in degrees, applied
///   in the frame of its parent (intrinsic angles). Three channels of any order, and fewer or repeated ones, are fine.
/// - A position channel replaces that component of the joint's OFFSET; it is not added to it. A component without a
///   channel keeps its OFFSET. Where the position channels stand among the rotations makes no difference.
/// - `End Site` has no rotation; it becomes a point named `<parent>_end`. A name that is taken gets _2, _3, ...
/// - Frames are lines. `Frames:` is believed less than the lines: all complete lines present are read, and a
///   disagreement is mentioned in the note. A line with too few or too many numbers is an error.
#pragma once

#include <string>
#include <string_view>

#include "reachcast/mocap/motion_file.hpp"

namespace reachcast {

/// Names are the joints and end sites in file order. The vertical axis is the one along which the head is highest above
/// the feet on the mean over frames (y when names do not tell); the unit is the one of m, cm, mm, inch, foot and the
/// CMU database's 0.0564 m in which the bones from foot to head add up to 1.15 to 2.1 m. Throws std::invalid_argument,
/// worded `file:line: expected X, found Y`, for malformed input, and when no unit fits and none was given.
[[nodiscard]] MotionFile read_bvh(const std::string& path, const MotionFileOptions& options = {});

/// The same from text in memory; `source` names it in messages.
[[nodiscard]] MotionFile parse_bvh(std::string_view text, const std::string& source,
                                   const MotionFileOptions& options = {});

}  // namespace reachcast
