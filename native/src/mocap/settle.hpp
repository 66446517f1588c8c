// SPDX-License-Identifier: GPL-3.0-or-later
/// From points in a file's own unit and axes to metres, z up, saying how each was found. Private to mocap/.
#pragma once

#include <optional>
#include <string>

#include "reachcast/mocap/motion_file.hpp"

namespace reachcast {

/// What a reader learned about its file beside the points.
struct FileSays {
  std::optional<double> metres_per_unit;  ///< the file's own statement
  std::optional<std::string> up;          ///< the file's own statement, believed less than head above feet
  std::string usual_up = "z";             ///< of the format
  std::optional<double> skeleton_height;  ///< foot to head along the bones, file units; empty: measured on the points
  std::optional<double> usual_unit;       ///< when neither file nor body tells; empty: an error asks for it
};

/// Sets file.guess but for the rate, and turns and scales file.positions. Throws std::invalid_argument when no unit
/// makes a person of these points and none was given.
void settle(const MotionFileOptions& options, const FileSays& says, MotionFile& file);

/// The option, else the file's rate; throws when there is neither or it is not 1e-3 to 1e6 Hz.
void settle_rate(const MotionFileOptions& options, std::optional<double> stated_hz, MotionFile& file);

/// Metres for "mm", "millimeters", "m", "cm", "in", "inches", "ft", ... in any letter case; empty for another word.
[[nodiscard]] std::optional<double> metres_of_unit(std::string_view word);

}  // namespace reachcast
