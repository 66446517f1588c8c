// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/rig/rotation_values.hpp"

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "reachcast/rig/turns.hpp"

namespace reachcast {
namespace {

constexpr std::array<std::string_view, 8> kModes{"QUATERNION", "AXIS_ANGLE", "XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"};
constexpr double kGimbal = 1e-9;  // cosine of the middle angle below which only the sum of the other two is defined
constexpr double kNoTurn = 1e-9;  // sine of half an angle below which a rotation has no axis

using Angles = std::array<double, 3>;  // first, middle and last of an order

/// Axes in the order of an Euler mode. R = R_k R_j R_i; `parity` is 1 for cyclic orders, else -1.
struct EulerOrder {
  glm::length_t i, j, k;
  double parity;
};

EulerOrder euler_order(RotationMode mode) {
  const std::string_view name = kModes[static_cast<std::size_t>(mode)];
  const EulerOrder order{name[0] - 'X', name[1] - 'X', name[2] - 'X', 1.0};
  return {order.i, order.j, order.k, (order.j - order.i + 3) % 3 == 1 ? 1.0 : -1.0};
}

/// The last angle when the first is given: r turned back by the first leaves R_k R_j, whose j column is R_k e_j.
double last_at_gimbal(const Mat3& r, double first, const EulerOrder& o) {
  const Vec3 column = std::cos(first) * r[o.j] - o.parity * std::sin(first) * r[o.k];
  return std::atan2(-o.parity * column[o.i], column[o.j]);
}

Angles near(const Angles& angles, const Angles& before) {
  return {near_angle(angles[0], before[0]), near_angle(angles[1], before[1]), near_angle(angles[2], before[2])};
}

double distance(const Angles& a, const Angles& b) {
  return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
}

Angles euler_angles(const Mat3& r, const EulerOrder& o, const Angles& before) {
  const double cosine = std::hypot(r[o.i][o.i], r[o.i][o.j]), middle = std::atan2(-o.parity * r[o.i][o.k], cosine);
  if (cosine <= kGimbal) return near({before[0], middle, last_at_gimbal(r, before[0], o)}, before);
  const double first = std::atan2(o.parity * r[o.j][o.k], r[o.k][o.k]);
  const double last = std::atan2(o.parity * r[o.i][o.j], r[o.i][o.i]);
  const Angles one = near({first, middle, last}, before);
  const Angles other = near({first + kPi, kPi - middle, last + kPi}, before);
  return distance(one, before) <= distance(other, before) ? one : other;
}

void write_euler(std::span<const Mat3> rotations, const EulerOrder& order, double* out) {
  Angles angles{};
  for (const Mat3& rotation : rotations) {
    angles = euler_angles(rotation, order, angles);
    out[order.i] = angles[0];
    out[order.j] = angles[1];
    out[order.k] = angles[2];
    out += 3;
  }
}

/// Calls `write` with each rotation's quaternion, of the sign nearest to the one before.
template <typename Write>
void for_continuous(std::span<const Mat3> rotations, Write write) {
  Quat before = rotations.empty() ? Quat(1, 0, 0, 0) : quaternion_of(rotations[0]);
  for (const Mat3& rotation : rotations) {
    Quat q = quaternion_of(rotation);
    if (glm::dot(q, before) < 0.0) q = -q;
    write(q);
    before = q;
  }
}

void write_quaternions(std::span<const Mat3> rotations, double* out) {
  for_continuous(rotations, [&](const Quat& q) {
    for (const double part : {q.w, q.x, q.y, q.z}) *out++ = part;
  });
}

/// The axis of the first frame that has one.
Vec3 first_axis(std::span<const Mat3> rotations) {
  Vec3 axis(0, 1, 0);
  bool is_found = false;
  for_continuous(rotations, [&](const Quat& q) {
    const Vec3 part(q.x, q.y, q.z);
    if (is_found || glm::length(part) <= kNoTurn) return;
    axis = glm::normalize(part);
    is_found = true;
  });
  return axis;
}

void write_axis_angles(std::span<const Mat3> rotations, double* out) {
  Vec3 axis = first_axis(rotations);
  double angle = 0.0;
  for_continuous(rotations, [&](const Quat& q) {
    const Vec3 part(q.x, q.y, q.z);
    double sine = glm::length(part);
    if (sine > kNoTurn) {
      const bool agrees = glm::dot(part, axis) >= 0.0;
      axis = part / (agrees ? sine : -sine);
      sine = agrees ? sine : -sine;
    }
    angle = near_angle(2.0 * std::atan2(sine, q.w), angle);
    for (const double value : {angle, axis.x, axis.y, axis.z}) *out++ = value;
  });
}

}  // namespace

RotationMode rotation_mode(std::string_view name) {
  for (std::size_t i = 0; i < kModes.size(); ++i) {
    if (kModes[i] == name) return static_cast<RotationMode>(i);
  }
  std::string known;
  for (const std::string_view mode : kModes) known += (known.empty() ? "" : ", ") + std::string(mode);
  throw std::invalid_argument("mode is '" + std::string(name) + "'; it must be one of " + known);
}

std::size_t value_count(RotationMode mode) {
  return mode == RotationMode::quaternion || mode == RotationMode::axis_angle ? 4 : 3;
}

Quat quaternion_of(const Mat3& m) {
  // Rows of 4 q q^T; m[c][r] is row r, column c.
  const double xx = m[0][0], yy = m[1][1], zz = m[2][2];
  const double xy = m[1][0] + m[0][1], yz = m[2][1] + m[1][2], zx = m[0][2] + m[2][0];
  const double wx = m[1][2] - m[2][1], wy = m[2][0] - m[0][2], wz = m[0][1] - m[1][0];
  const std::array<double, 4> squares{1 + xx + yy + zz, 1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz};
  std::size_t largest = 0;
  for (std::size_t i = 1; i < 4; ++i) largest = squares[i] > squares[largest] ? i : largest;
  Quat q;
  switch (largest) {
    case 0:
      q = Quat(squares[0], wx, wy, wz);
      break;
    case 1:
      q = Quat(wx, squares[1], xy, zx);
      break;
    case 2:
      q = Quat(wy, xy, squares[2], yz);
      break;
    default:
      q = Quat(wz, zx, yz, squares[3]);
  }
  q = glm::normalize(q);
  return q.w < 0.0 ? -q : q;
}

std::vector<double> rotation_values(std::span<const Mat3> rotations, RotationMode mode) {
  std::vector<double> values(rotations.size() * value_count(mode));
  if (mode == RotationMode::quaternion) {
    write_quaternions(rotations, values.data());
  } else if (mode == RotationMode::axis_angle) {
    write_axis_angles(rotations, values.data());
  } else {
    write_euler(rotations, euler_order(mode), values.data());
  }
  return values;
}

}  // namespace reachcast
