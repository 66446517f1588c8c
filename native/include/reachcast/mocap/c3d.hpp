// SPDX-License-Identifier: GPL-3.0-or-later
/// C3D files (www.c3d.org): markers over time, in binary.
///
/// - Processors: Intel and DEC numbers; MIPS is refused. Coordinates: floats, and integers times POINT:SCALE.
/// - A negative residual, and a coordinate that is no finite number, is missing (NaN).
/// - Frames: TRIAL:ACTUAL_START_FIELD and ACTUAL_END_FIELD where present (they go beyond 65535), else the header.
///   A file with room for fewer frames than it announces is refused; room for more is padding.
/// - Names: POINT:LABELS, LABELS2, ...; a marker without one is `point_N` (N from 1). A taken name gets _2, _3, ...
///   What POINT:ANGLES, FORCES, MOMENTS, POWERS and SCALARS list are no places and is left out.
/// - Unit: POINT:UNITS; up: POINT:Y_SCREEN where names do not tell; rate: POINT:RATE, else the header's.
/// - Analogue channels and events are not read.
#pragma once

#include <string>
#include <string_view>

#include "reachcast/mocap/motion_file.hpp"

namespace reachcast {

/// Throws std::invalid_argument naming what was expected and found. No more memory is taken than three times the file.
[[nodiscard]] MotionFile read_c3d(const std::string& path, const MotionFileOptions& options = {});

/// The same from the bytes of a file; `source` names it in messages.
[[nodiscard]] MotionFile parse_c3d(std::string_view bytes, const std::string& source,
                                   const MotionFileOptions& options = {});

}  // namespace reachcast
