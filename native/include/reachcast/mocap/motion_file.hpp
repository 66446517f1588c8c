// SPDX-License-Identifier: GPL-3.0-or-later
/// Reads a recording of any known format into a Clip: metres, z up.
#pragma once

#include <optional>
#include <string>

#include "reachcast/mocap/clip.hpp"

namespace reachcast {

/// What the file does not say, or says wrongly. Empty fields are taken from the file or guessed from the data.
struct MotionFileOptions {
  std::optional<double> metres_per_unit;  ///< > 0; empty: guessed
  std::optional<char> up;                 ///< the file's vertical axis, 'x', 'y' or 'z'; empty: guessed
  std::optional<double> rate_hz;          ///< > 0; empty: the file's own rate
  std::optional<long> interval;           ///< CSV with an `interval_label` column: read only this group of rows
};

/// A Clip together with how the file was understood.
struct MotionFile : Clip {
  double metres_per_unit = 1.0;
  char up = 'z';     ///< the vertical axis inside the file; `positions` are z up whatever it was
  std::string note;  ///< one sentence per thing guessed or noticed; empty when there was nothing to say
};

/// Dispatches on the extension: .bvh and .csv, in any letter case. Throws std::invalid_argument for another
/// extension, an unreadable file, options out of range, and whatever the reader of that format refuses.
[[nodiscard]] MotionFile read_motion(const std::string& path, const MotionFileOptions& options = {});

}  // namespace reachcast
