// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/rigid_motion.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace reachcast {
namespace {

constexpr int kNewtonSteps = 50;
constexpr double kUndecided = 1e-3;      // below this share of its scale, a product of rows has lost half its digits
constexpr double kSmallestTurn = 1e-12;  // share of the scale by which the smaller of equally near turns is preferred

Vec3 mean(const Corners& corners) {
  return 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
}

/// Sum of the products of coordinates, [i][j]: i of `from`, j of `to`, both from their means; and half the sum of all
/// squares, which no eigenvalue of Horn's matrix exceeds.
struct Products {
  Mat3 sum{0.0};
  double bound = 0.0;
};

Products products_of(const Corners& from, const Corners& to) {
  const Vec3 a = mean(from), b = mean(to);
  Products out;
  for (std::size_t k = 0; k < from.size(); ++k) {
    const Vec3 p = from[k] - a, q = to[k] - b;
    for (int i = 0; i < 3; ++i) out.sum[i] += p[i] * q;
    out.bound += 0.5 * (glm::dot(p, p) + glm::dot(q, q));
  }
  return out;
}

/// Horn's matrix N (1987, section 4A): its eigenvector of the largest eigenvalue is the turn (w, x, y, z).
Eigen::Matrix4d horn_matrix(const Mat3& s) {
  Eigen::Matrix4d n;
  n(0, 0) = s[0][0] + s[1][1] + s[2][2];
  n(1, 1) = s[0][0] - s[1][1] - s[2][2];
  n(2, 2) = s[1][1] - s[0][0] - s[2][2];
  n(3, 3) = s[2][2] - s[0][0] - s[1][1];
  n(0, 1) = n(1, 0) = s[1][2] - s[2][1];
  n(0, 2) = n(2, 0) = s[2][0] - s[0][2];
  n(0, 3) = n(3, 0) = s[0][1] - s[1][0];
  n(1, 2) = n(2, 1) = s[0][1] + s[1][0];
  n(1, 3) = n(3, 1) = s[2][0] + s[0][2];
  n(2, 3) = n(3, 2) = s[1][2] + s[2][1];
  return n;
}

/// Newton's method on the characteristic polynomial of N from above, where it falls steadily to the largest root
/// (Theobald 2005). Corners that are nearly congruent lie next to the bound: two or three steps.
double largest_eigenvalue(const Products& products, const Eigen::Matrix4d& n) {
  const Mat3& s = products.sum;
  const double c2 = -2.0 * (glm::dot(s[0], s[0]) + glm::dot(s[1], s[1]) + glm::dot(s[2], s[2]));
  const double c1 = -8.0 * glm::dot(s[0], glm::cross(s[1], s[2]));
  const double c0 = n.determinant();
  double x = products.bound;
  for (int step = 0; step < kNewtonSteps; ++step) {
    const double square = x * x, inner = (square + c2) * x + c1;
    const double slope = 3.0 * square * x + c2 * x + inner;
    if (!(slope > 0.0)) break;
    const double change = (inner * x + c0) / slope;
    x -= change;
    if (std::abs(change) <= 1e-15 * products.bound) break;
  }
  return x;
}

/// Orthogonal to three vectors: their product in four dimensions.
Eigen::Vector4d across(const Eigen::Vector4d& a, const Eigen::Vector4d& b, const Eigen::Vector4d& c) {
  const auto minor = [&](int i, int j) { return b[i] * c[j] - b[j] * c[i]; };
  const double m01 = minor(0, 1), m02 = minor(0, 2), m03 = minor(0, 3), m12 = minor(1, 2), m13 = minor(1, 3),
               m23 = minor(2, 3);
  return {a[1] * m23 - a[2] * m13 + a[3] * m12, -a[0] * m23 + a[2] * m03 - a[3] * m02,
          a[0] * m13 - a[1] * m03 + a[3] * m01, -a[0] * m12 + a[1] * m02 - a[2] * m01};
}

}  // namespace

Vec3 rotation_vector(const Quat& turn) {
  const Vec3 axis(turn.x, turn.y, turn.z);
  const double sine = glm::length(axis);
  if (sine < 1e-15) return Vec3(0.0);
  return axis * ((turn.w < 0.0 ? -2.0 : 2.0) * std::atan2(sine, std::abs(turn.w)) / sine);
}

Quat rotation_by(const Vec3& vector) {
  const double angle = glm::length(vector);
  return angle < 1e-15 ? Quat(1.0, 0.0, 0.0, 0.0) : glm::angleAxis(angle, vector / angle);
}

Quat quarter_of(const Quat& turn) {
  const auto half = [](const Quat& q) { return glm::normalize(Quat(1.0 + q.w, q.x, q.y, q.z)); };
  return half(half(turn.w < 0.0 ? -turn : turn));
}

Quat nearest_turn(const Corners& from, const Corners& to) {
  const Products products = products_of(from, to);
  Eigen::Matrix4d n = horn_matrix(products.sum);
  const Eigen::Matrix4d rest = n - largest_eigenvalue(products, n) * Eigen::Matrix4d::Identity();
  // The turn is orthogonal to every row of `rest`. Of a small turn w is the largest part, which the last three rows
  // give best.
  Eigen::Vector4d q = across(rest.col(1), rest.col(2), rest.col(3));
  const double scale = products.bound * products.bound * products.bound;
  if (!(q.norm() > kUndecided * scale && q[0] * q[0] > kUndecided * q.squaredNorm())) {
    n(0, 0) += kSmallestTurn * std::max(products.bound, kSmallestTurn);
    q = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(n).eigenvectors().col(3);
  }
  q.normalize();
  return {q[0], q[1], q[2], q[3]};
}

}  // namespace reachcast
