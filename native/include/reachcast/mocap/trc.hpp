// SPDX-License-Identifier: GPL-3.0-or-later
/// Track row columns (.trc): markers over time as text, five header lines and one line per frame.
#pragma once

#include <string>
#include <string_view>

#include "reachcast/mocap/motion_file.hpp"

namespace reachcast {

/// Cells are separated by tabs (by any blanks in a file whose line of names has no tab). A blank cell is missing: a
/// marker with one is missing in that frame (NaN). Rate: DataRate; unit: Units (mm, cm, m, in, ft). A disagreement with
/// NumFrames or NumMarkers is an error, as the file was then cut off or mixed up. Throws std::invalid_argument, worded
/// `file:line: expected X, found Y`.
[[nodiscard]] MotionFile read_trc(const std::string& path, const MotionFileOptions& options = {});

/// The same from text in memory; `source` names it in messages.
[[nodiscard]] MotionFile parse_trc(std::string_view text, const std::string& source,
                                   const MotionFileOptions& options = {});

}  // namespace reachcast
