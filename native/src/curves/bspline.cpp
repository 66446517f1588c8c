// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/bspline.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

namespace reachcast {
namespace {

constexpr int kDegree = 3;
constexpr int kSpans = static_cast<int>(kBasisCount) - kDegree;  // 5 equal knot spans
constexpr double kPull = 1e-5;  // relative weight of the second differences in solve_smooth: below any measurement

/// Knots of the clamped basis of the given degree on the same spans.
double knot(int i, int degree) {
  return std::clamp(static_cast<double>(i - degree) / kSpans, 0.0, 1.0);
}

/// All basis functions of `degree` at t by the recurrence of Cox and de Boor; `out` holds kSpans + degree values.
template <std::size_t N>
void basis(double t, int degree, std::array<double, N>& out) {
  const int span = std::min(static_cast<int>(t * kSpans), kSpans - 1) + degree;
  out.fill(0.0);
  out[static_cast<std::size_t>(span)] = 1.0;
  for (int d = 1; d <= degree; ++d) {
    for (int i = span - d; i <= span; ++i) {
      const double left = knot(i + d, degree) - knot(i, degree), right = knot(i + d + 1, degree) - knot(i + 1, degree);
      double value = 0.0;
      if (left > 0.0) value += (t - knot(i, degree)) / left * out[static_cast<std::size_t>(i)];
      if (right > 0.0) value += (knot(i + d + 1, degree) - t) / right * out[static_cast<std::size_t>(i) + 1];
      out[static_cast<std::size_t>(i)] = value;
    }
  }
}

}  // namespace

BasisRow bspline_row(double t) {
  std::array<double, kSpans + kDegree + 1> values;
  basis(std::clamp(t, 0.0, 1.0), kDegree, values);
  return Eigen::Map<const BasisRow>(values.data());
}

BasisRow bspline_integral_row(double t) {
  // Integral of B_j of degree 3 = (u_{j+4} - u_j)/4 * sum over i > j of B_i of degree 4 (its own knots start one
  // earlier).
  std::array<double, kSpans + kDegree + 2> quartic;
  basis(std::clamp(t, 0.0, 1.0), kDegree + 1, quartic);
  BasisRow row;
  double tail = 0.0;
  for (int j = static_cast<int>(kBasisCount) - 1; j >= 0; --j) {
    tail += quartic[static_cast<std::size_t>(j) + 1];
    row(j) = (knot(j + kDegree + 1, kDegree) - knot(j, kDegree)) / (kDegree + 1) * tail;
  }
  return row;
}

Eigen::MatrixXd bspline_matrix(Eigen::Index count) {
  Eigen::MatrixXd rows(count, kBasisCount);
  for (Eigen::Index f = 0; f < count; ++f)
    rows.row(f) = bspline_row(static_cast<double>(f) / static_cast<double>(count - 1));
  return rows;
}

Eigen::MatrixXd solve_smooth(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const Eigen::Index n = a.cols(), extra = std::max<Eigen::Index>(n - 2, 0);
  Eigen::MatrixXd left = Eigen::MatrixXd::Zero(a.rows() + extra, n);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(a.rows() + extra, b.cols());
  left.topRows(a.rows()) = a;
  right.topRows(a.rows()) = b;
  for (Eigen::Index i = 0; i < extra; ++i) left.block(a.rows() + i, i, 1, 3) << kPull, -2.0 * kPull, kPull;
  return left.colPivHouseholderQr().solve(right);
}

Eigen::MatrixXd fit_bspline(const Eigen::Ref<const Eigen::MatrixXd>& values) {
  if (values.rows() < 4) {
    throw std::invalid_argument("values has " + std::to_string(values.rows()) + " rows; a curve needs at least 4");
  }
  if (!values.allFinite()) throw std::invalid_argument("values holds a number that is not finite");
  return solve_smooth(bspline_matrix(values.rows()), values);
}

}  // namespace reachcast
