// SPDX-License-Identifier: GPL-3.0-or-later
/// Clips and joint maps between Python and C++. Call these while the GIL is held.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "array_checks.hpp"
#include "reachcast/mocap/clip.hpp"
#include "reachcast/mocap/joint_map.hpp"

namespace reachcast::bindings {

/// Names come from files and may hold any bytes.
[[nodiscard]] pybind11::str text(const std::string& bytes);

/// Frames times joints points to an owning (frames, joints, 3).
[[nodiscard]] pybind11::array_t<double> clip_array(const Vec3* points, std::size_t frames, std::size_t joints);

[[nodiscard]] pybind11::list clip_names(const Clip& clip);
[[nodiscard]] pybind11::dict clip_channels(const Clip& clip);
[[nodiscard]] pybind11::array_t<bool> clip_filled(const Clip& clip);

/// positions: (frames, joints, 3), NaN where missing.
[[nodiscard]] Clip make_clip(const std::vector<std::string>& names, const DoubleArray& positions, double rate_hz,
                             const std::string& source);

/// A preset's name, the path of a JSON file, or a dict or pairs of a canonical joint and its sources.
[[nodiscard]] JointMap joint_map(const pybind11::object& map);

}  // namespace reachcast::bindings
