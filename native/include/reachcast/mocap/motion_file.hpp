// SPDX-License-Identifier: GPL-3.0-or-later
/// Reads a recording of any known format into a Clip: metres, z up.
#pragma once

#include <optional>
#include <string>

#include "reachcast/mocap/clip.hpp"

namespace reachcast {

/// What the file does not say, or says wrongly. Empty fields are taken from the file or guessed from the data.
struct MotionFileOptions {
  std::optional<double> metres_per_unit;  ///< > 0; empty: the file's unit, else guessed
  std::optional<std::string> up;  ///< the file's axis that points up: "x", "y", "z", or "-x", ...; empty: guessed
  std::optional<double> rate_hz;  ///< > 0; empty: the file's own rate
  std::optional<long> interval;   ///< CSV with an `interval_label` column: read only this group of rows
  /// The file's horizontal axis that shall be forward (+y): the recording is turned about the vertical. Empty: not
  /// turned, whatever way the person faces.
  std::optional<std::string> facing{};
  std::optional<std::string> skeleton{};  ///< AMC only: its .asf file; empty: looked for beside it
};

/// Where an answer about a file comes from.
enum class From {
  argument,  ///< the caller said so
  file,      ///< the file says so
  data,      ///< seen in the recorded points
  usual,     ///< nothing told: what is usual for the format
  unknown,   ///< nothing told, and nothing is assumed
};
[[nodiscard]] const char* name_of(From from);

/// How a file was understood; every answer can be overridden by an option.
struct Guess {
  double metres_per_unit = 1.0;
  std::string unit = "metres";  ///< in words
  From unit_from = From::usual;
  std::string up = "z";  ///< the file's axis that points up; `positions` are z up whatever it was
  From up_from = From::usual;
  std::string facing;  ///< the file's axis nearest to where the person faces at the start; empty when not known
  From facing_from = From::unknown;
  double rate_hz = 0.0;
  From rate_from = From::file;
  double stature_m = kMissing;  ///< from the lengths of shank, thigh and trunk; NaN when they are not all recorded

  /// One line for people: "millimetres (file), up y (data), facing z (data), 250 Hz (file), stature 1.74 m".
  [[nodiscard]] std::string summary() const;
};

/// A Clip together with how the file was understood.
struct MotionFile : Clip {
  Guess guess;
  std::string note;  ///< one sentence per thing guessed or noticed; empty when there was nothing to say
};

/// Dispatches on the extension: .bvh, .csv, .c3d, .trc and .amc, in any letter case. Throws std::invalid_argument for
/// another extension, an unreadable file, options out of range, and whatever the reader of that format refuses.
[[nodiscard]] MotionFile read_motion(const std::string& path, const MotionFileOptions& options = {});

}  // namespace reachcast
