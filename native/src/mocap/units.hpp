// SPDX-License-Identifier: GPL-3.0-or-later
/// Which way is up in a file, and how long is its unit. Private to mocap/.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "reachcast/conventions.hpp"
#include "reachcast/mocap/motion_file.hpp"

namespace reachcast {

/// Throws std::invalid_argument naming the option, its value and the limit.
void check_options(const MotionFileOptions& options);

/// The axis along which the points named after head, neck or shoulders lie highest above those named after ankles,
/// feet or toes, on the mean over poses, with its sign ("y", "-y"); empty when names or numbers do not tell. `poses`
/// holds whole poses.
[[nodiscard]] std::optional<std::string> guess_up(std::span<const std::string> names, std::span<const Vec3> poses);

/// Which end of a standing body a point's name speaks of. Names are compared in lower case.
enum class BodyEnd { neither, high, low };
[[nodiscard]] BodyEnd body_end(std::string_view name);

struct Unit {
  double metres;
  std::string_view name;
};
/// The unit in which a standing skeleton of this height is 1.4 to 2.1 m tall; empty when none is.
[[nodiscard]] std::optional<Unit> guess_unit(double height);

/// "metres", "millimetres", ..., "0.1 m".
[[nodiscard]] std::string unit_name(double metres);

/// A proper rotation that brings the given axis to z: x up (y, z, x); y up (x, -z, y). For "-x", "-y", "-z" half a turn
/// about x comes after it.
[[nodiscard]] Vec3 to_z_up(const Vec3& point, std::string_view up);

/// Median of the finite values, reordering them; the upper one of two, NaN when there are none.
[[nodiscard]] double median_of(std::vector<double>& values);

/// 0 to 2 and a sign as "x" to "-z".
[[nodiscard]] std::string signed_axis(int axis, bool is_negative);

[[nodiscard]] inline int axis_index(char axis) {
  return axis - 'x';
}

/// At most 7 significant digits, without trailing zeros, for messages.
[[nodiscard]] std::string show(double value);

/// Appends a sentence to a note of sentences.
void add_note(std::string& note, std::string_view sentence);

}  // namespace reachcast
