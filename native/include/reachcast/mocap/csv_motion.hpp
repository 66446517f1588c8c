// SPDX-License-Identifier: GPL-3.0-or-later
/// Tables of points over time: one header line, one frame per line, comma separated.
#pragma once

#include <string>
#include <string_view>

#include "reachcast/mocap/motion_file.hpp"

namespace reachcast {

/// Columns NAME_x, NAME_y, NAME_z are the point NAME, unless NAME ends in "Angle"; every other column is a channel of
/// that name (`frame`, `time_s`, `obj_qw`, ...). An empty cell is missing (NaN).
/// Rate: the option, else `time_s`, which must advance in even steps, else 100 Hz for tables grouped by
/// `interval_label` (with a note), else an error. Unit: the option, else metres, or millimetres when coordinates are
/// typically beyond 20. Vertical axis: the option, else from head and shoulders above feet, else z.
/// Throws std::invalid_argument, worded `file:line: expected X, found Y`, for malformed input.
[[nodiscard]] MotionFile read_csv_motion(const std::string& path, const MotionFileOptions& options = {});

/// The same from text in memory; `source` names it in messages.
[[nodiscard]] MotionFile parse_csv_motion(std::string_view text, const std::string& source,
                                          const MotionFileOptions& options = {});

}  // namespace reachcast
