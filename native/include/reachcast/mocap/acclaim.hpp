// SPDX-License-Identifier: GPL-3.0-or-later
/// Acclaim skeletons (.asf) and motions (.amc).
///
/// Conventions:
/// - A bone starts where its parent ends; its rest direction is given in the root's axes. C is the rotation of its
///   `axis`, M that of its `dof` values; the bone turns by C M C^-1 in its parent, the root by its `order` likewise.
/// - Angles listed "X Y Z" are applied in that order about fixed axes: R = Rz Ry Rx.
/// - The point named after a bone is its start; bones without children also have the point `<bone>_end`.
/// - `length L` in :units means that 1 is 1/L inches (CMU: 0.45); the height of a person is believed more.
/// - Bones that translate or stretch (tx, ty, tz, l) are refused: joint centres would leave their places.
#pragma once

#include <string>
#include <string_view>

#include "reachcast/mocap/motion_file.hpp"

namespace reachcast {

/// The skeleton is options.skeleton, else NAME.asf for NAME.amc, else the part before the last '_' (02.asf for
/// 02_01.amc), else the only .asf of the folder. An AMC states no rate: options.rate_hz must. Throws
/// std::invalid_argument, worded `file:line: expected X, found Y` where a line is at fault.
[[nodiscard]] MotionFile read_amc(const std::string& path, const MotionFileOptions& options = {});

/// The same from texts in memory; the sources name them in messages.
[[nodiscard]] MotionFile parse_amc(std::string_view amc, const std::string& amc_source, std::string_view asf,
                                   const std::string& asf_source, const MotionFileOptions& options = {});

}  // namespace reachcast
