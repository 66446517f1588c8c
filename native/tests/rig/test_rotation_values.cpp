// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/rig/rotation_values.hpp"

#include <gtest/gtest.h>

#include "rig/rig_cases.hpp"

namespace reachcast {
namespace {

using tests::difference;

constexpr double kMatrix = 1e-12;  // a few products and sines of rotation matrices
constexpr std::array<std::string_view, 6> kOrders{"XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"};
constexpr std::array<std::string_view, 8> kModes{"QUATERNION", "AXIS_ANGLE", "XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"};

/// The rotation that `values` stand for, from the definitions alone: Euler order "XYZ" turns about x, then y, then z.
Mat3 meant(std::span<const double> values, std::string_view mode) {
  if (mode == "QUATERNION") return glm::mat3_cast(Quat(values[0], values[1], values[2], values[3]));
  if (mode == "AXIS_ANGLE") return turn_about({values[1], values[2], values[3]}, values[0]);
  Mat3 out(1.0);
  for (const char name : mode) {
    Vec3 axis(0.0);
    axis[name - 'X'] = 1.0;
    out = turn_about(axis, values[static_cast<std::size_t>(name - 'X')]) * out;
  }
  return out;
}

std::vector<double> values_of(std::span<const Mat3> rotations, std::string_view mode) {
  return rotation_values(rotations, rotation_mode(mode));
}

void expect_meant(std::span<const Mat3> rotations, std::string_view mode) {
  const std::vector<double> values = values_of(rotations, mode);
  const std::size_t width = value_count(rotation_mode(mode));
  ASSERT_EQ(values.size(), width * rotations.size());
  for (std::size_t f = 0; f < rotations.size(); ++f) {
    EXPECT_LT(difference(meant(std::span(values).subspan(f * width, width), mode), rotations[f]), kMatrix)
        << mode << ", frame " << f;
  }
}

double largest_step(const std::vector<double>& values, std::size_t width) {
  double most = 0.0;
  for (std::size_t i = width; i < values.size(); ++i) most = std::max(most, std::abs(values[i] - values[i - width]));
  return most;
}

TEST(RotationValues, StandForTheRotationsInEveryMode) {
  std::mt19937_64 random(0);
  std::vector<Mat3> rotations{Mat3(1.0)};
  for (int i = 0; i < 300; ++i) rotations.push_back(tests::random_turn(random, kPi));
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) rotations.push_back(turn_about(axis, kPi));
  for (const std::string_view mode : kModes) expect_meant(rotations, mode);
}

TEST(RotationValues, EulerAnglesPassTheGimbalWithoutAJump) {
  for (const std::string_view order : kOrders) {
    std::vector<Mat3> path;
    for (int step = 0; step <= 60; ++step) {
      std::array<double, 3> angles{0.4, 0.4, 0.4};
      angles[static_cast<std::size_t>(order[1] - 'X')] = (60.0 + step) * kPi / 180.0;  // 90 degrees is among them
      path.push_back(meant(angles, order));
    }
    expect_meant(path, order);
    EXPECT_LT(largest_step(values_of(path, order), 3), 0.02) << order;
  }
}

TEST(RotationValues, ARestAtTheGimbalKeepsTheFirstAngle) {
  for (const std::string_view order : kOrders) {
    for (const double sign : {-1.0, 1.0}) {
      std::vector<Mat3> path;
      for (int step = 0; step < 20; ++step) {
        std::array<double, 3> angles{};
        angles[static_cast<std::size_t>(order[1] - 'X')] = sign * 0.5 * kPi;
        angles[static_cast<std::size_t>(order[2] - 'X')] = 0.1 * step;
        path.push_back(meant(angles, order));
      }
      expect_meant(path, order);
      EXPECT_LT(largest_step(values_of(path, order), 3), 0.1 + 1e-9) << order;
    }
  }
}

/// A right angle without rounding, so that nothing but the sum of the outer angles is left in the matrix.
Mat3 exact_right_angle(char axis, double sign) {
  const int j = axis - 'X', k = (j + 1) % 3, i = (j + 2) % 3;
  Mat3 out(0.0);
  out[j][j] = 1.0;
  out[k][i] = sign;
  out[i][k] = -sign;
  return out;
}

TEST(RotationValues, TheFirstAngleIsKeptExactlyAtTheGimbal) {
  for (const std::string_view order : kOrders) {
    for (const double sign : {-1.0, 1.0}) {
      std::vector<Mat3> path;
      std::array<double, 3> angles{};
      const auto angle = [&](int place) -> double& {
        return angles[static_cast<std::size_t>(order[static_cast<std::size_t>(place)] - 'X')];
      };
      angle(0) = 0.7;
      angle(1) = sign * 1.5;
      path.push_back(meant(angles, order));
      Vec3 last(0.0), first(0.0);
      last[order[2] - 'X'] = first[order[0] - 'X'] = 1.0;
      path.push_back(turn_about(last, 0.3) * exact_right_angle(order[1], sign) * turn_about(first, 0.7));
      expect_meant(path, order);
      const std::vector<double> values = values_of(path, order);
      EXPECT_NEAR(values[3 + static_cast<std::size_t>(order[0] - 'X')], 0.7, kMatrix) << order;
      EXPECT_NEAR(values[3 + static_cast<std::size_t>(order[2] - 'X')], 0.3, kMatrix) << order;
    }
  }
}

TEST(RotationValues, SpinsOfManyTurnsDoNotJump) {
  std::vector<Mat3> spin;
  const double step = 4.0 * kPi / 119.0;
  for (int i = 0; i < 120; ++i) spin.push_back(turn_about({0.0, 0.6, 0.8}, step * i));
  EXPECT_LT(largest_step(values_of(spin, "QUATERNION"), 4), 0.5 * step + 1e-9);
  const std::vector<double> angles = values_of(spin, "AXIS_ANGLE");
  for (std::size_t i = 1; i < spin.size(); ++i) {
    EXPECT_NEAR(angles[4 * i], step * static_cast<double>(i), 1e-9);
    EXPECT_LT(glm::distance(Vec3(angles[4 * i + 1], angles[4 * i + 2], angles[4 * i + 3]), Vec3(0.0, 0.6, 0.8)), 1e-9);
  }
  for (const std::string_view order : kOrders) {
    expect_meant(spin, order);
    EXPECT_LT(largest_step(values_of(spin, order), 3), 0.5) << order;
  }
}

TEST(RotationValues, TheAxisBeforeTheFirstTurnIsThatOfTheFirstTurn) {
  const std::array<Mat3, 3> path{Mat3(1.0), Mat3(1.0), turn_about({0, 0, 1}, 0.5)};
  EXPECT_EQ(values_of(path, "AXIS_ANGLE"), (std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0.5, 0, 0, 1}));
  const std::array<Mat3, 1> still{Mat3(1.0)};
  EXPECT_EQ(values_of(still, "AXIS_ANGLE"), (std::vector<double>{0, 0, 1, 0}));
}

TEST(RotationValues, NoFramesGiveNoValuesAndUnknownModesAreNamed) {
  for (const std::string_view mode : kModes) EXPECT_TRUE(values_of({}, mode).empty());
  try {
    (void)rotation_mode("XYX");
    FAIL() << "an order that turns about one axis twice was taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("'XYX'"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("AXIS_ANGLE"), std::string::npos);
  }
}

}  // namespace
}  // namespace reachcast
