// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/endpoint_path.hpp"

#include <gtest/gtest.h>

#include <random>

namespace reachcast {
namespace {

/// A smooth reach along `axis` with a bulge: a minimum-jerk progress and a sideways and upward deviation.
Points reach_along(const Vec3& start, const Vec3& axis, const Vec3& bulge, int frames) {
  Points points;
  for (int f = 0; f < frames; ++f) {
    const double t = static_cast<double>(f) / (frames - 1);
    const double p = t * t * t * (10 - 15 * t + 6 * t * t);
    points.push_back(start + p * axis + 16 * t * t * (1 - t) * (1 - t) * bulge);
  }
  return points;
}

Vec3 orthogonal(const Vec3& v, const Vec3& axis) {
  return v - glm::dot(v, axis) / glm::dot(axis, axis) * axis;
}

double worst_along(const EndpointPath& path, const Points& points, const Vec3& start, const Vec3& end) {
  double worst = 0.0;
  for (std::size_t f = 0; f < points.size(); ++f) {
    const double t = static_cast<double>(f) / static_cast<double>(points.size() - 1);
    worst = std::max(worst, glm::distance(points[f], point_at(path, start, end, t)));
  }
  return worst;
}

TEST(EndpointPath, DecodeFollowsTheRecordedPathForEveryAxisAlsoVertical) {
  for (const Vec3& axis :
       {Vec3(0.3, 0.5, 0.2), Vec3(0, 0, 1.1), Vec3(0, 0, -0.6), Vec3(0, -0.5, 0), Vec3(1e-9, 0, 0.9)}) {
    const Vec3 start(0.1, 0.4, 0.2), bulge = orthogonal(Vec3(0.02, -0.12, 0.05), axis);
    const Points points = reach_along(start, axis, bulge, 31);
    const EndpointPath path = fit_endpoint_path(points);
    EXPECT_LT(worst_along(path, points, start, start + axis), 0.002);
    EXPECT_EQ(point_at(path, start, start + axis, 0.0), start);
    EXPECT_EQ(point_at(path, start, start + axis, 1.0), start + axis);
  }
}

TEST(EndpointPath, AveragesNearTheVerticalDoNotCancel) {
  // Two reaches with the same backward bulge whose axes lean a little to either side of the vertical. With the paper's
  // zero of phi the two angles are opposite and the mean deviation vanishes.
  const Vec3 start(0.0), a(1e-3, 0, 1), b(-1e-3, 0, 1), bulge(0, -0.1, 0);
  const EndpointPath pa = carried(fit_endpoint_path(reach_along(start, a, bulge, 25)), a, Vec3(0, 0, 1));
  const EndpointPath pb = carried(fit_endpoint_path(reach_along(start, b, bulge, 25)), b, Vec3(0, 0, 1));
  EndpointPath mean;
  mean.velocity = 0.5 * (pa.velocity + pb.velocity);
  mean.deviation = 0.5 * (pa.deviation + pb.deviation);
  EXPECT_NEAR(point_at(mean, start, Vec3(0, 0, 1), 0.5).y, -0.1, 0.003);
}

TEST(EndpointPath, CarryingAboutTheVerticalIsATurn) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<> unit(-1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 axis(unit(random), unit(random), 0.0), start(0.0);
    if (glm::length(axis) < 0.1) continue;
    const Vec3 bulge = orthogonal(Vec3(unit(random), unit(random), unit(random)) * 0.1, axis);
    const Quat turn = glm::angleAxis(unit(random) * 3.0, Vec3(0, 0, 1));
    const EndpointPath path = carried(fit_endpoint_path(reach_along(start, axis, bulge, 25)), axis, turn * axis);
    const Points turned = reach_along(start, turn * axis, turn * bulge, 25);
    ASSERT_LT(worst_along(path, turned, start, turn * axis), 0.003);
  }
}

TEST(EndpointPath, ProgressStartsAtRestAndEndsAtRest) {
  const EndpointPath path = fit_endpoint_path(reach_along(Vec3(0.0), Vec3(1, 0, 0), Vec3(0, 0, 0.1), 40));
  EXPECT_LT(progress(path, 0.01) / 0.01, 0.1);
  EXPECT_LT((1.0 - progress(path, 0.99)) / 0.01, 0.1);
  EXPECT_EQ(progress(path, 0.0), 0.0);
  EXPECT_EQ(progress(path, 1.0), 1.0);
}

TEST(EndpointPath, RefusesPathsWithoutAnAxis) {
  EXPECT_THROW((void)fit_endpoint_path(Points(10, Vec3(0.3))), std::invalid_argument);
  EXPECT_THROW((void)fit_endpoint_path(Points(3, Vec3(0.3))), std::invalid_argument);
  Points bad = reach_along(Vec3(0.0), Vec3(1, 0, 0), Vec3(0.0), 10);
  bad[4].y = std::nan("");
  EXPECT_THROW((void)fit_endpoint_path(bad), std::invalid_argument);
}

}  // namespace
}  // namespace reachcast
