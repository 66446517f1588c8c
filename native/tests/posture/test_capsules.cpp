// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/capsules.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/common.hpp>
#include <random>

#include "reachcast/posture/rigid_motion.hpp"

namespace reachcast {
namespace {

constexpr int kTrials = 300;
constexpr int kSamples = 400;    // points along a segment
constexpr double kRound = 1e-9;  // of a nearest point found by halving

class Draw {
 public:
  double between(double a, double b) { return std::uniform_real_distribution<>(a, b)(random_); }
  Vec3 point(double far) { return {between(-far, far), between(-far, far), between(-far, far)}; }
  Vec3 direction() {
    Vec3 v = point(1.0);
    while (glm::length(v) < 0.1 || glm::length(v) > 1.0) v = point(1.0);
    return glm::normalize(v);
  }
  Capsule capsule() { return {point(0.3), point(0.3), between(0.01, 0.08)}; }
  OrientedBox box() {
    return {point(0.3), Vec3(between(0.02, 0.3), between(0.02, 0.3), between(0.02, 0.3)),
            glm::mat3_cast(rotation_by(point(2.0)))};
  }

 private:
  std::mt19937_64 random_{1965};
};

double distance_to(const OrientedBox& box, const Vec3& p) {
  const Vec3 local = glm::transpose(box.axes) * (p - box.centre);
  return glm::length(local - glm::clamp(local, -box.half, box.half));
}

double distance_to(const Capsule& capsule, const Vec3& p) {
  const Vec3 line = capsule.b - capsule.a;
  const double t = std::clamp(glm::dot(p - capsule.a, line) / glm::dot(line, line), 0.0, 1.0);
  return glm::distance(p, capsule.a + t * line) - capsule.radius_m;
}

/// Smallest distance of points along the capsule's line, less its radius. At most half a step too large.
template <class Shape>
double sampled_gap(const Shape& shape, const Capsule& capsule) {
  double least = 1e9;
  for (int i = 0; i <= kSamples; ++i) {
    const double t = static_cast<double>(i) / kSamples;
    least = std::min(least, distance_to(shape, capsule.a + t * (capsule.b - capsule.a)) - capsule.radius_m);
  }
  return least;
}

double half_step(const Capsule& capsule) {
  return 0.5 * glm::distance(capsule.a, capsule.b) / kSamples;
}

template <class Shape>
Shape moved(Shape shape, const Vec3& by);
template <>
Capsule moved(Capsule c, const Vec3& by) {
  return {c.a + by, c.b + by, c.radius_m};
}
template <>
OrientedBox moved(OrientedBox box, const Vec3& by) {
  box.centre += by;
  return box;
}

/// Apart: the gap is the sampled one. Together: the way out frees, and no sampled way that is shorter does.
template <class Shape>
void expect_as_sampled(Draw& draw, const Shape& shape, const Capsule& capsule, int& met) {
  const Penetration found = penetration(shape, capsule);
  EXPECT_NEAR(glm::length(found.direction), 1.0, kRound);
  const double gap = sampled_gap(shape, capsule);
  if (found.depth_m <= 0.0) {
    EXPECT_LE(-found.depth_m, gap + kRound);
    EXPECT_GE(-found.depth_m, gap - half_step(capsule));
    return;
  }
  ++met;
  EXPECT_LE(gap, half_step(capsule));
  EXPECT_GE(sampled_gap(moved(shape, found.depth_m * found.direction), capsule), -kRound);
  for (int i = 0; i < 200; ++i) {
    const Vec3 shorter = (found.depth_m - half_step(capsule)) * draw.direction();
    EXPECT_LT(sampled_gap(moved(shape, shorter), capsule), half_step(capsule));
  }
  const Vec3 way = draw.direction();
  const double out = way_out(shape, capsule, way);
  EXPECT_GE(out, found.depth_m - kRound);
  EXPECT_LT(penetration(moved(shape, out * way), capsule).depth_m, kRound);
  EXPECT_GT(penetration(moved(shape, (out - 1e-3) * way), capsule).depth_m, 0.0);
}

TEST(Capsules, PenetrationOfCapsulesIsThatOfSampledPoints) {
  Draw draw;
  int met = 0;
  for (int trial = 0; trial < kTrials; ++trial) expect_as_sampled(draw, draw.capsule(), draw.capsule(), met);
  EXPECT_GT(met, kTrials / 20);
}

TEST(Capsules, PenetrationOfABoxIsThatOfSampledPoints) {
  Draw draw;
  int met = 0;
  for (int trial = 0; trial < kTrials; ++trial) expect_as_sampled(draw, draw.box(), draw.capsule(), met);
  EXPECT_GT(met, kTrials / 3);
}

TEST(Capsules, ParallelAndCrossingAndPointlikeOnesHaveADirection) {
  const Capsule bone{{0, 0, 0}, {0, 0, 1}, 0.1};
  for (const Capsule& other : {Capsule{{0.1, 0, 0.2}, {0.1, 0, 2.0}, 0.05}, Capsule{{0, 0, 0.3}, {0, 0, 0.6}, 0.05},
                               Capsule{{-1, 0, 0.5}, {1, 0, 0.5}, 0.05}, Capsule{{0, 0, 0.5}, {0, 0, 0.5}, 0.05}}) {
    const Penetration found = penetration(other, bone);
    EXPECT_GT(found.depth_m, 0.0);
    EXPECT_NEAR(penetration(moved(other, found.depth_m * found.direction), bone).depth_m, 0.0, 1e-9);
  }
}

TEST(Capsules, WhatIsFarDoesNotMeet) {
  Draw draw;
  int far = 0;
  for (int trial = 0; trial < 20 * kTrials; ++trial) {
    const Capsule capsule = draw.capsule(), other = draw.capsule();
    const OrientedBox box = draw.box();
    if (are_far(other, capsule, 0.02)) {
      ++far;
      EXPECT_LE(penetration(other, capsule).depth_m, -0.02);
    }
    if (are_far(box, capsule, 0.02)) {
      ++far;
      EXPECT_LE(penetration(box, capsule).depth_m, -0.02);
    }
  }
  EXPECT_GT(far, kTrials);
}

TEST(Capsules, TheStandingBodyIsAsWideAndDeepAsPeopleAre) {
  // Breadths and depths over stature, ANSUR II (Gordon et al. 2014), women and men; capsules are a little thinner.
  const Body body = Body::from_stature(1.7);
  const BodyCapsules capsules = capsules_of(body.posture(), 1.7);
  const auto over = [&](BodyPart left, BodyPart right) {
    const Capsule &a = capsules[index(left)], &b = capsules[index(right)];
    const double out = std::max({a.a.x, a.b.x, b.a.x, b.b.x}) - std::min({a.a.x, a.b.x, b.a.x, b.b.x});
    return (out + 2.0 * a.radius_m) / 1.7;
  };
  EXPECT_NEAR(over(BodyPart::waist_left, BodyPart::waist_right), 0.185, 0.02);
  EXPECT_NEAR(over(BodyPart::chest_left, BodyPart::chest_right), 0.165, 0.02);
  EXPECT_NEAR(over(BodyPart::pelvis, BodyPart::pelvis), 0.20, 0.02);
  const Capsule& head = capsules[index(BodyPart::head)];
  EXPECT_NEAR((std::max(head.a.z, head.b.z) + head.radius_m) / 1.7, 1.0, 0.02);
  for (const BodyPart part : {BodyPart::waist_left, BodyPart::chest_right}) {
    const Capsule& c = capsules[index(part)];
    EXPECT_GT(std::min(c.a.y, c.b.y) - c.radius_m, -0.075 * 1.7);
    EXPECT_LT(std::max(c.a.y, c.b.y) + c.radius_m, 0.09 * 1.7);
  }
}

}  // namespace
}  // namespace reachcast
