// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/axis_curve.hpp"

#include <gtest/gtest.h>

#include "reachcast/curves/bezier.hpp"
#include "reachcast/curves/endpoint_way.hpp"

namespace reachcast {
namespace {

constexpr double kExact_m = 1e-12;
constexpr double kFit_m = 0.008;  // arc length is not quite a cubic's parameter

const std::array<Vec3, 4> kControl{Vec3(0.1, 0.4, 0.2), Vec3(0.1, 0.3, 0.6), Vec3(0.3, 0.35, 1.0), Vec3(0.4, 0.5, 1.1)};

TEST(AxisCurve, IsTheBezierCurveOfItsControlPoints) {
  const AxisCurve curve = curve_through(kControl, {2.0, 2.0});
  const auto back = control_between(curve, kControl[0], kControl[3]);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT(glm::distance(back[i], kControl[i]), kExact_m);
  const Points control(kControl.begin(), kControl.end());
  for (const double s : {0.0, 0.05, 0.3, 0.5, 0.9, 1.0}) {
    const Vec3 expected = eval_bezier(control, std::array{s}).front();
    EXPECT_LT(glm::distance(point_on(curve, kControl[0], kControl[3], s), expected), kExact_m);
  }
}

TEST(AxisCurve, MeetsItsEndsExactlyAndOnlyGoesForward) {
  const EndpointWay way = curve_through(kControl, {1.4, 3.0});
  EXPECT_EQ(point_at(way, kControl[0], kControl[3], 0.0), kControl[0]);
  EXPECT_EQ(point_at(way, kControl[0], kControl[3], 1.0), kControl[3]);
  for (int i = 1; i <= 50; ++i) EXPECT_GT(progress(way, i / 50.0), progress(way, (i - 1) / 50.0));
}

TEST(AxisCurve, FitsWhatWasDrawnWithIt) {
  const AxisCurve drawn = curve_through(kControl, {2.2, 1.5});
  Points points;
  for (int i = 0; i <= 60; ++i) points.push_back(point_at(EndpointWay(drawn), kControl[0], kControl[3], i / 60.0));
  const AxisCurve fitted = fit_axis_curve(points);
  for (int i = 0; i <= 60; ++i) {
    EXPECT_LT(glm::distance(point_at(EndpointWay(fitted), kControl[0], kControl[3], i / 60.0),
                            points[static_cast<std::size_t>(i)]),
              0.03);
  }
  // As lines in space, whenever a point is reached.
  for (const Vec3& point : points) {
    double nearest = 1.0;
    for (int k = 0; k <= 400; ++k)
      nearest = std::min(nearest, glm::distance(point, point_on(fitted, kControl[0], kControl[3], k / 400.0)));
    EXPECT_LT(nearest, kFit_m);
  }
}

/// What begins in the middle of a movement still starts from rest.
TEST(AxisCurve, StartsFromRestWhateverWasRecorded) {
  Points even;
  for (int i = 0; i <= 20; ++i) even.push_back(Vec3(0.02 * i, 0.4, 0.5));
  const AxisCurve curve = fit_axis_curve(even);
  EXPECT_GE(curve.speed.alpha, kLeastExponent);
  EXPECT_GE(curve.speed.beta, kLeastExponent);
}

TEST(AxisCurve, IsCarriedAsOneShapeTurnedAndScaled) {
  const AxisCurve curve = curve_through(kControl, {2.0, 2.0});
  const Vec3 from = kControl[3] - kControl[0], to = 1.7 * Vec3(-from.y, from.x, from.z);
  const AxisCurve moved = carried(curve, from, to);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(glm::length(moved.offsets[i]), 1.7 * glm::length(curve.offsets[i]), kExact_m);
    EXPECT_NEAR(glm::dot(moved.offsets[i], to), 1.7 * 1.7 * glm::dot(curve.offsets[i], from), kExact_m);
  }
  const AxisCurve back = carried(moved, to, from);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_LT(glm::distance(back.offsets[i], curve.offsets[i]), kExact_m);
}

/// DESIGN 3.3: offsets (-0.025, -0.148, 0.077) and (-0.015, -0.139, -0.002) of the distance; between two hands the
/// first component vanishes.
TEST(AxisCurve, PublishedOneHasThePrintedOffsets) {
  const AxisCurve curve = published_axis_curve(0.8);
  EXPECT_LT(glm::distance(curve.offsets[0], 0.8 * Vec3(0, -0.148, 0.077)), kExact_m);
  EXPECT_LT(glm::distance(curve.offsets[1], 0.8 * Vec3(0, -0.139, -0.002)), kExact_m);
  EXPECT_EQ(curve.speed.alpha, 1.63);
  EXPECT_EQ(curve.speed.beta, 1.75);
}

TEST(AxisCurve, RefusesTooFewPoints) {
  EXPECT_THROW((void)fit_axis_curve(std::array{Vec3(0), Vec3(1), Vec3(2)}), std::invalid_argument);
  EXPECT_THROW((void)fit_axis_curve(std::array{Vec3(1), Vec3(1), Vec3(1), Vec3(1)}), std::invalid_argument);
}

}  // namespace
}  // namespace reachcast
