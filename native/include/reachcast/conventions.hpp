// SPDX-License-Identifier: GPL-3.0-or-later
/// Units, axes and the one bridge between GLM and Eigen.
///
/// Metres, seconds, kilograms, radians. Right-handed, z up. Quaternions are (w, x, y, z) wherever they are listed.
/// "Body frame": origin on the floor midway between the ankles at the start of a motion, x to the subject's right,
/// y forward, z up. Names that end in `_body` or `_world` say which frame a value lives in where the type cannot.
/// GLM holds points and rotations; Eigen holds statistics (least squares, covariance). Only this header knows both.
#pragma once

#include <Eigen/Core>
#include <cmath>
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

[[nodiscard]] inline Eigen::Vector3d to_eigen(const Vec3& v) {
  return {v.x, v.y, v.z};
}
[[nodiscard]] inline Vec3 to_glm(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}
[[nodiscard]] inline bool is_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// The smallest rotation that turns one direction into another; neither may be zero. For opposite directions, half a
/// turn about what is nearest to the vertical.
[[nodiscard]] inline Quat smallest_rotation(const Vec3& from, const Vec3& to) {
  const Vec3 a = glm::normalize(from), b = glm::normalize(to);
  const double cosine = glm::dot(a, b);
  if (cosine < -1.0 + 1e-9) {
    const Vec3 up = std::abs(a.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
    return glm::angleAxis(kPi, glm::normalize(up - glm::dot(up, a) * a));
  }
  const Vec3 cross = glm::cross(a, b);
  return glm::normalize(Quat(1.0 + cosine, cross.x, cross.y, cross.z));
}

/// A vector turned by the smallest rotation between two directions of unit length.
[[nodiscard]] inline Vec3 carried_along(const Vec3& from, const Vec3& to, const Vec3& v) {
  const double cosine = glm::dot(from, to);
  if (cosine < -1.0 + 1e-9) return smallest_rotation(from, to) * v;
  const Vec3 cross = glm::cross(from, to);  // Rodrigues' formula, the sine in `cross`
  return cosine * v + glm::cross(cross, v) + glm::dot(cross, v) / (1.0 + cosine) * cross;
}

}  // namespace reachcast
