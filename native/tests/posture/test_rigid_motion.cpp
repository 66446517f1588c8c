// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/rigid_motion.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

namespace reachcast {
namespace {

constexpr double kSameTurn_rad = 1e-9;    // where one turn is clearly the nearest
constexpr double kSameSquares_m2 = 1e-9;  // where several are nearly as near, what is left over still agrees

class Random {
 public:
  double operator()(double deviation) { return deviation * normal_(engine_); }
  Vec3 vector(double deviation) { return {(*this)(deviation), (*this)(deviation), (*this)(deviation)}; }

 private:
  std::mt19937_64 engine_{1987};
  std::normal_distribution<> normal_;
};

Vec3 mean(const Corners& c) {
  return 0.25 * (c[0] + c[1] + c[2] + c[3]);
}

/// The oracle: by singular values (Kabsch 1976).
Quat kabsch(const Corners& from, const Corners& to) {
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < 4; ++i)
    products += to_eigen(to[i] - mean(to)) * to_eigen(from[i] - mean(from)).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(products, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  const Eigen::Matrix3d r = svd.matrixU() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
  return glm::normalize(glm::quat_cast(Mat3(to_glm(r.col(0)), to_glm(r.col(1)), to_glm(r.col(2)))));
}

double squares(const Quat& turn, const Corners& from, const Corners& to) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 left = to[i] - mean(to) - turn * (from[i] - mean(from));
    sum += glm::dot(left, left);
  }
  return sum;
}

double angle_between(const Quat& a, const Quat& b) {
  return glm::length(rotation_vector(a * glm::conjugate(b)));
}

Corners trunk() {
  return {Vec3(-0.09, 0.0, 0.9), Vec3(0.09, 0.0, 0.9), Vec3(-0.18, 0.02, 1.4), Vec3(0.18, 0.02, 1.4)};
}

Corners moved(const Corners& from, const Quat& turn, const Vec3& shift) {
  Corners out;
  for (std::size_t i = 0; i < 4; ++i) out[i] = turn * from[i] + shift;
  return out;
}

TEST(NearestTurn, IsThatOfTheSingularValuesForCornersOfATrunk) {
  Random random;
  for (int trial = 0; trial < 20000; ++trial) {
    const double noise = std::pow(10.0, -(trial % 17) - 1);
    const Corners from = trunk();
    Corners to = moved(from, rotation_by(random.vector(trial % 2 ? 0.2 : 2.0)), random.vector(1.0));
    for (Vec3& corner : to) corner += random.vector(noise);
    ASSERT_LT(angle_between(nearest_turn(from, to), kabsch(from, to)), kSameTurn_rad) << trial;
  }
}

TEST(NearestTurn, IsAsNearAsAnyForCornersOfAnyKind) {
  Random random;
  for (int trial = 0; trial < 20000; ++trial) {
    const double thin = std::pow(10.0, -(trial % 13)), flat = trial % 3 ? 1.0 : 0.0;
    Corners from, to;
    for (Vec3& corner : from) corner = {random(thin), random(flat), random(1.0)};
    to = moved(from, rotation_by(random.vector(1.0)), random.vector(1.0));
    for (Vec3& corner : to) corner += random.vector(trial % 5 ? 0.1 : 10.0);
    const Quat turn = nearest_turn(from, to);
    ASSERT_NEAR(glm::length(turn), 1.0, 1e-12);
    const double least = squares(kabsch(from, to), from, to);
    ASSERT_NEAR(squares(turn, from, to), least, kSameSquares_m2 * (1.0 + least)) << trial;
  }
}

TEST(NearestTurn, OfEquallyNearTurnsIsTheSmallest) {
  const Corners point{}, line{Vec3(0, 0, -1), Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(0, 0, 2)};
  EXPECT_LT(angle_between(nearest_turn(trunk(), point), Quat(1, 0, 0, 0)), kSameTurn_rad);
  const Quat lean = rotation_by(Vec3(0.3, 0.0, 0.0));
  EXPECT_LT(angle_between(nearest_turn(line, moved(line, lean, Vec3(1.0))), lean), 1e-6);
}

TEST(NearestTurn, FindsHalfATurn) {
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), glm::normalize(Vec3(1, 2, 3))}) {
    const Quat half = rotation_by(kPi * axis);
    EXPECT_LT(squares(nearest_turn(trunk(), moved(trunk(), half, Vec3(0.5))), trunk(), moved(trunk(), half, {})),
              1e-18);
  }
}

TEST(RotationVector, UndoesRotationByAndAQuarterIsAQuarter) {
  Random random;
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec3 direction = glm::normalize(random.vector(1.0));
    const Vec3 vector = direction * (kPi * static_cast<double>(trial) / 2001.0);
    const Quat turn = rotation_by(vector);
    ASSERT_LT(glm::distance(rotation_vector(turn), vector), 1e-12);
    ASSERT_LT(glm::distance(rotation_vector(quarter_of(turn)), 0.25 * vector), 1e-12);
    ASSERT_LT(glm::distance(rotation_vector(quarter_of(-turn)), 0.25 * vector), 1e-12);
  }
}

}  // namespace
}  // namespace reachcast
