// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/path_offsets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include "reachcast/curves/bezier.hpp"

namespace reachcast {
namespace {

constexpr double kRounding = 1e-12;
constexpr OffsetOrigin kOrigins[] = {OffsetOrigin::axis, OffsetOrigin::ends, OffsetOrigin::start_axis,
                                     OffsetOrigin::axis_end};
constexpr OffsetScaling kScalings[] = {OffsetScaling::none, OffsetScaling::distance, OffsetScaling::distance_time};

Points random_points(std::mt19937_64& random, int count) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Points points;
  for (int i = 0; i < count; ++i) points.emplace_back(uniform(random), uniform(random), uniform(random));
  return points;
}

TEST(PathOffsets, ControlPointsComeBackFromTheirOffsets) {
  std::mt19937_64 random(1);
  for (int degree = 1; degree <= kMaxBezierDegree; ++degree) {
    for (const OffsetOrigin origin : kOrigins) {
      for (const OffsetScaling scaling : kScalings) {
        for (const Hand hand : {Hand::left, Hand::right}) {
          const Points control = random_points(random, degree + 1);
          const OffsetForm form{degree, origin, scaling};
          const Eigen::VectorXd offsets = offsets_of(control, form, hand, 1.7);
          ASSERT_EQ(offsets.size(), form.size());
          const Points back = control_of(offsets, form, control.front(), control.back(), hand, 1.7);
          for (std::size_t i = 0; i < control.size(); ++i) EXPECT_LT(glm::length(back[i] - control[i]), kRounding);
        }
      }
    }
  }
}

// Fig. 5 for a cubic: Y_1 = P_1 - P_0 and Y_2 = P_2 - P_3, or from A_1 and A_2 on the axis.
TEST(PathOffsets, OriginsAreThoseOfTheFigure) {
  const Vec3 start(0.0), end(3.0, 0.0, 6.0), first(1.0, 0.0, 2.0), second(2.0, 0.0, 4.0);
  const auto origins = [&](OffsetOrigin origin) { return offset_origins({3, origin, {}}, start, end); };
  EXPECT_EQ(origins(OffsetOrigin::axis), (Points{first, second}));
  EXPECT_EQ(origins(OffsetOrigin::ends), (Points{start, end}));
  EXPECT_EQ(origins(OffsetOrigin::start_axis), (Points{start, second}));
  EXPECT_EQ(origins(OffsetOrigin::axis_end), (Points{first, end}));
  EXPECT_EQ(offset_origins({4, OffsetOrigin::ends, {}}, start, end), (Points{start, start, end}));
}

TEST(PathOffsets, ScalesAreDistanceAndTheRootOfDistanceAndTime) {
  EXPECT_EQ(offset_scale({3, {}, OffsetScaling::none}, 0.4, {}), 1.0);
  EXPECT_EQ(offset_scale({3, {}, OffsetScaling::distance}, 0.4, {}), 0.4);
  EXPECT_EQ(offset_scale({3, {}, OffsetScaling::distance_time}, 0.5, 2.0), 1.0);
}

TEST(PathOffsets, WithoutScalingAPathMayEndWhereItBegan) {
  const Points loop{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
  const OffsetForm form{3, OffsetOrigin::axis, OffsetScaling::none};
  const Eigen::VectorXd offsets = offsets_of(loop, form, Hand::right, {});
  EXPECT_EQ(control_of(offsets, form, loop[0], loop[3], Hand::right, {}), loop);
}

std::string message_of(const auto& action) {
  try {
    (void)action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(PathOffsets, NamesWhatIsWrong) {
  const Points loop{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
  EXPECT_EQ(message_of([&] { return offsets_of(loop, {}, Hand::right, {}); }),
            "starts and ends 0.000000 m apart, expected at least 0.010000 m to scale by");
  EXPECT_EQ(message_of([&] {
              return offsets_of(loop, {4, {}, {}}, Hand::right, {});
            }),
            "control has 4 points, expected 5");
  const OffsetForm timed{3, {}, OffsetScaling::distance_time};
  EXPECT_EQ(message_of([&] { return offset_scale(timed, 1.0, {}); }),
            "duration is missing, a model scaled by distance and time needs it");
  EXPECT_EQ(message_of([&] { return offset_scale(timed, 1.0, -2.0); }),
            "duration is -2.000000 s, expected a finite number > 0");
}

}  // namespace
}  // namespace reachcast
