// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/obstacles.hpp"

#include <gtest/gtest.h>

#include <random>

#include "predict/predict_cases.hpp"

namespace reachcast {
namespace {

using namespace tests;

/// The twelve triangles of a level box without a turn.
std::vector<Triangle> board(const Vec3& low, const Vec3& high) {
  const auto corner = [&](int i) {
    return Vec3(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
  };
  std::vector<Triangle> out;
  for (const auto& f : {std::array{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}) {
    out.push_back({corner(f[0]), corner(f[1]), corner(f[2])});
    out.push_back({corner(f[0]), corner(f[2]), corner(f[3])});
  }
  return out;
}

Vec3 in_frame_of(const LevelBox& box, const Vec3& p) {
  const double c = std::cos(box.yaw_rad), s = std::sin(box.yaw_rad);
  const Vec3 d = p - box.centre;
  return {c * d.x + s * d.y, -s * d.x + c * d.y, d.z};
}

TEST(Obstacles, MeetWhatSamplingFindsInside) {
  std::mt19937_64 random(17);
  const auto between = [&](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
  const auto point = [&](double size) {
    return Vec3(between(-size, size), between(-size, size), between(-size, size));
  };
  int met = 0, sampled = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<Triangle> triangles;
    for (int i = 0; i < 1 + trial % 30; ++i) {
      const Vec3 at = point(1.0);
      triangles.push_back({at + point(0.3), at + point(0.3), at + point(0.3)});
    }
    const LevelBox box{point(0.7), {between(0.05, 0.6), between(0.05, 0.6), between(0.05, 0.6)}, between(-4, 4)};
    bool inside = false;
    for (const Triangle& t : triangles) {
      for (int k = 0; k <= 40; ++k) {
        for (int l = 0; l + k <= 40; ++l) {
          const double u = k / 40.0, v = l / 40.0;
          const Vec3 p = in_frame_of(box, t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]));
          inside |=
              std::abs(p.x) < 0.5 * box.size.x && std::abs(p.y) < 0.5 * box.size.y && std::abs(p.z) < 0.5 * box.size.z;
        }
      }
    }
    const bool found = Obstacles(triangles).meet(box);
    EXPECT_TRUE(found || !inside) << trial << ": a triangle passes through the box and is not met";
    met += found ? 1 : 0;
    sampled += inside ? 1 : 0;
  }
  // Samples miss corners that just reach in; there must be few of those.
  EXPECT_GT(sampled, 300);
  EXPECT_LT(met - sampled, met / 15);
}

TEST(Obstacles, RefuseACornerThatIsNotFinite) {
  EXPECT_THROW(Obstacles({{Vec3(0.0), Vec3(1.0), Vec3(0, kMissing, 0)}}), std::invalid_argument);
  EXPECT_FALSE(Obstacles().meet({}));
}

/// A board 3 cm thick whose top the box is put on, reaching 2 cm further to the person than the box.
std::vector<Triangle> shelf_board(const Task& t) {
  return board(t.target + Vec3(-0.4, -0.16, -0.03), t.target + Vec3(0.4, 0.25, 0.0));
}

bool box_hits(const Motion& motion, const Task& t, const Obstacles& obstacles) {
  for (const BoxPose& pose : motion.box) {
    const Vec3 size = Vec3(t.object.width_m, t.object.depth_m, t.object.height_m) - 0.01;
    if (obstacles.meet({pose.position + Vec3(0, 0, 0.5 * t.object.height_m), size, pose.yaw_rad})) return true;
  }
  return false;
}

TEST(Obstacles, TheBoxComesToABoardFromAboveAndNotThroughIt) {
  int bent = 0;
  for (const double height : {0.7, 0.9, 1.1}) {
    for (const double x : {-0.2, 0.0, 0.15}) {
      const Task t = task({0.0, 0.34, 0.05}, {x, 0.55, height});
      PredictOptions how = options(24.0);
      how.obstacles = std::make_shared<const Obstacles>(shelf_board(t));
      const Body body = Body::from_stature(1.72);
      const Motion free = predict(made_corpus(), subject(1.72), t, body, options(24.0));
      const Motion round = predict(made_corpus(), subject(1.72), t, body, how);
      EXPECT_FALSE(box_hits(round, t, *how.obstacles)) << height << " " << x;
      EXPECT_LT(worst_link(body, round), 1e-6);
      bent += box_hits(free, t, *how.obstacles) ? 1 : 0;
      const bool said = std::any_of(round.corrections.begin(), round.corrections.end(),
                                    [](const Correction& c) { return c.name == "obstacles"; });
      EXPECT_EQ(said, box_hits(free, t, *how.obstacles) || said);
    }
  }
  EXPECT_GT(bent, 3) << "else nothing was in the way";
}

TEST(Obstacles, APlaceOutOfReachIsSaidBeforeTheWayToIt) {
  const Task t = task({0.0, 0.34, 0.05}, {0.0, 0.55, 2.4});
  PredictOptions how = options(24.0);
  how.obstacles = std::make_shared<const Obstacles>(board({-2, -2, 1.8}, {2, 2, 1.82}));
  expect_contains(message_of<std::invalid_argument>(
                      [&] { (void)predict(made_corpus(), subject(1.72), t, Body::from_stature(1.72), how); }),
                  "cm out of reach");
}

TEST(Obstacles, SayWhenTheBoxWouldStandInThemOrThereIsNoWay) {
  const Task t = task({0.0, 0.42, 0.3}, {0.0, 0.45, 1.0});
  const auto said = [&](const std::vector<Triangle>& triangles) {
    PredictOptions how = options(24.0);
    how.obstacles = std::make_shared<const Obstacles>(triangles);
    return message_of<std::invalid_argument>(
        [&] { (void)predict(made_corpus(), subject(1.72), t, Body::from_stature(1.72), how); });
  };
  expect_contains(said(board(t.target + Vec3(-0.1, -0.1, 0.05), t.target + Vec3(0.1, 0.1, 0.1))),
                  "stand in an obstacle at the target");
  expect_contains(said(board({-2, -2, 0.8}, {2, 2, 0.82})), "no way past the obstacles");
}

}  // namespace
}  // namespace reachcast
