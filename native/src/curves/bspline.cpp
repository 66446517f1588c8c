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

/// Knots of the clamped basis of the given degree on the same spans, in spans.
constexpr int knot(int i, int degree) {
  return std::clamp(i - degree, 0, kSpans);
}

/// In which span t lies, 0 to kSpans - 1, and the Degree + 1 basis functions that are not zero there, by the recurrence
/// of Cox and de Boor. The first of them has the span's number.
template <int Degree>
int local_basis(double t, std::array<double, Degree + 1>& values) {
  static constexpr std::array<double, Degree + 1> kShare = [] {  // divisions by the width of some spans
    std::array<double, Degree + 1> shares{};
    for (int i = 1; i <= Degree; ++i) shares[static_cast<std::size_t>(i)] = 1.0 / i;
    return shares;
  }();
  const double place = std::clamp(t, 0.0, 1.0) * kSpans;
  const int span = std::min(static_cast<int>(place), kSpans - 1), at = span + Degree;
  values[0] = 1.0;
  for (int d = 1; d <= Degree; ++d) {
    double carried = 0.0;
    for (int r = 0; r < d; ++r) {
      const int from = knot(at + 1 - d + r, Degree), to = knot(at + 1 + r, Degree);
      const auto k = static_cast<std::size_t>(r);
      const double part = values[k] * kShare[static_cast<std::size_t>(to - from)];
      values[k] = carried + (to - place) * part;
      carried = (place - from) * part;
    }
    values[static_cast<std::size_t>(d)] = carried;
  }
  return span;
}

}  // namespace

LocalBasis bspline_local(double t) {
  LocalBasis out;
  out.first = local_basis<kDegree>(t, out.values);
  return out;
}

BasisRow bspline_row(double t) {
  const LocalBasis local = bspline_local(t);
  BasisRow row = BasisRow::Zero();
  for (Eigen::Index i = 0; i <= kDegree; ++i) row(local.first + i) = local.values[static_cast<std::size_t>(i)];
  return row;
}

BasisRow bspline_integral_row(double t) {
  // Integral of B_j of degree 3 = (u_{j+4} - u_j)/4 * sum over i > j of B_i of degree 4 (its own knots start one
  // earlier).
  std::array<double, kDegree + 2> quartic;
  const int first = local_basis<kDegree + 1>(t, quartic);
  BasisRow row;
  double tail = 0.0;
  for (int j = static_cast<int>(kBasisCount) - 1; j >= 0; --j) {
    const int of_quartic = j + 1 - first;
    if (of_quartic >= 0 && of_quartic <= kDegree + 1) tail += quartic[static_cast<std::size_t>(of_quartic)];
    row(j) = (knot(j + kDegree + 1, kDegree) - knot(j, kDegree)) / (kSpans * (kDegree + 1.0)) * tail;
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
