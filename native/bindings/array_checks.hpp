// SPDX-License-Identifier: GPL-3.0-or-later
/// NumPy in, NumPy out, for every binding file. Going in, shape and finiteness are checked and a ValueError names the
/// argument; going out, arrays own their memory. Call these while the GIL is held.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <cmath>
#include <initializer_list>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "reachcast/conventions.hpp"

namespace reachcast::bindings {

/// Take this type as the argument: lists and other dtypes are converted, the result is contiguous, frames first.
using DoubleArray = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;
inline constexpr pybind11::ssize_t kAnySize = -1;  ///< an axis of any length in `require_shape`

[[nodiscard]] inline std::string shape_text(std::span<const pybind11::ssize_t> shape) {
  std::string text = "(";
  for (std::size_t axis = 0; axis < shape.size(); ++axis) {
    if (axis > 0) text += ", ";
    text += shape[axis] == kAnySize ? "n" : std::to_string(shape[axis]);
  }
  return text + (shape.size() == 1 ? ",)" : ")");
}

inline void require_shape(const DoubleArray& array, std::string_view name,
                          std::initializer_list<pybind11::ssize_t> expected) {
  const std::span<const pybind11::ssize_t> wanted(expected.begin(), expected.size());
  const std::span<const pybind11::ssize_t> given(array.shape(), static_cast<std::size_t>(array.ndim()));
  bool fits = wanted.size() == given.size();
  for (std::size_t axis = 0; fits && axis < wanted.size(); ++axis) {
    fits = wanted[axis] == kAnySize || wanted[axis] == given[axis];
  }
  if (fits) return;
  throw std::invalid_argument(std::string(name) + " has shape " + shape_text(given) + ", expected " +
                              shape_text(wanted));
}

/// The message gives the index of the first bad value, one number per axis: "points[3, 1] is nan, ...".
inline void require_finite(const DoubleArray& array, std::string_view name) {
  const double* const values = array.data();
  for (pybind11::ssize_t i = 0; i < array.size(); ++i) {
    if (std::isfinite(values[i])) continue;
    std::string place;
    pybind11::ssize_t rest = i;
    for (pybind11::ssize_t axis = array.ndim(); axis-- > 0; rest /= array.shape(axis)) {
      place = std::to_string(rest % array.shape(axis)) + (place.empty() ? "" : ", ") + place;
    }
    throw std::invalid_argument(std::string(name) + (place.empty() ? "" : "[" + place + "]") + " is " +
                                std::to_string(values[i]) + ", expected a finite number");
  }
}

/// (n, 3) to n points, all finite.
[[nodiscard]] inline Points to_points(const DoubleArray& array, std::string_view name) {
  require_shape(array, name, {kAnySize, 3});
  require_finite(array, name);
  Points points(static_cast<std::size_t>(array.shape(0)));
  const double* const values = array.data();
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = Vec3(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
  }
  return points;
}

/// (3,) to a point, finite.
[[nodiscard]] inline Vec3 to_vec3(const DoubleArray& array, std::string_view name) {
  require_shape(array, name, {3});
  require_finite(array, name);
  return {array.data()[0], array.data()[1], array.data()[2]};
}

/// (n,) to n numbers, all finite.
[[nodiscard]] inline std::vector<double> to_numbers(const DoubleArray& array, std::string_view name) {
  require_shape(array, name, {kAnySize});
  require_finite(array, name);
  return {array.data(), array.data() + array.size()};
}

/// n points to an owning (n, 3).
[[nodiscard]] inline pybind11::array_t<double> points_array(std::span<const Vec3> points) {
  pybind11::array_t<double> array({static_cast<pybind11::ssize_t>(points.size()), pybind11::ssize_t{3}});
  double* const values = array.mutable_data();
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) values[3 * i + static_cast<std::size_t>(axis)] = points[i][axis];
  }
  return array;
}

/// A point to an owning (3,).
[[nodiscard]] inline pybind11::array_t<double> vec3_array(const Vec3& point) {
  pybind11::array_t<double> array(pybind11::ssize_t{3});
  for (int axis = 0; axis < 3; ++axis) array.mutable_data()[axis] = point[axis];
  return array;
}

/// n numbers to an owning (n,).
[[nodiscard]] inline pybind11::array_t<double> numbers_array(std::span<const double> numbers) {
  return pybind11::array_t<double>(static_cast<pybind11::ssize_t>(numbers.size()), numbers.data());
}
[[nodiscard]] inline pybind11::array_t<double> numbers_array(const Eigen::VectorXd& numbers) {
  return pybind11::array_t<double>(static_cast<pybind11::ssize_t>(numbers.size()), numbers.data());
}

}  // namespace reachcast::bindings
