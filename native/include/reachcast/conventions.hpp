// SPDX-License-Identifier: GPL-3.0-or-later
/// Units, axes and the one bridge between GLM and Eigen.
///
/// Metres, seconds, kilograms, radians. Right-handed, z up. Quaternions are (w, x, y, z) wherever they are listed.
/// "Body frame": origin on the floor midway between the ankles at the start of a motion, x to the subject's right,
/// y forward, z up. Names that end in `_body` or `_world` say which frame a value lives in where the type cannot.
/// GLM holds points and rotations; Eigen holds statistics (least squares, covariance). Only this header knows both.
#pragma once

#include <Eigen/Core>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

namespace reachcast {

using Vec3 = glm::dvec3;
using Mat3 = glm::dmat3;  ///< columns are the images of the axes
using Quat = glm::dquat;
using Points = std::vector<Vec3>;

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

[[nodiscard]] inline Eigen::Vector3d to_eigen(const Vec3& v) { return {v.x, v.y, v.z}; }
[[nodiscard]] inline Vec3 to_glm(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
[[nodiscard]] inline bool is_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace reachcast
