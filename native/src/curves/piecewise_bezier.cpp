// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/piecewise_bezier.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "reachcast/curves/bezier.hpp"

namespace reachcast {

namespace {

constexpr double kRankTolerance = 1e-10;  // relative size below which a direction counts as left open by the points
constexpr int kMostPieces = 64;

void require_options(const PiecewiseFit& options) {
  if (options.degree < 2 || options.degree > kMaxBezierDegree) {
    throw std::invalid_argument("degree is " + std::to_string(options.degree) + ", expected 2 to " +
                                std::to_string(kMaxBezierDegree) + " for pieces that meet smoothly");
  }
  if (!(options.tolerance >= 0.0 && std::isfinite(options.tolerance))) {
    throw std::invalid_argument("tolerance is " + std::to_string(options.tolerance) +
                                ", expected a finite number >= 0");
  }
  if (options.max_pieces < 1 || options.max_pieces > kMostPieces) {
    throw std::invalid_argument("max_pieces is " + std::to_string(options.max_pieces) + ", expected 1 to " +
                                std::to_string(kMostPieces));
  }
}

void require_rising(std::span<const double> times) {
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i] >= times[i - 1]) continue;
    throw std::invalid_argument("times[" + std::to_string(i) + "] is " + std::to_string(times[i]) +
                                ", expected at least the one before it, " + std::to_string(times[i - 1]));
  }
}

std::size_t piece_at(std::span<const double> breaks, double s) {
  const auto above = std::upper_bound(breaks.begin() + 1, breaks.end() - 1, s);
  return static_cast<std::size_t>(above - breaks.begin()) - 1;
}

double local_time(std::span<const double> breaks, std::size_t piece, double s) {
  return std::clamp((s - breaks[piece]) / (breaks[piece + 1] - breaks[piece]), 0.0, 1.0);
}

/// Control points of every piece as weights of the free ones, its d - 1 inner points. Where two pieces of lengths h and
/// k meet, equal derivatives put the joint at (k L + h R)/(h + k) between the inner points L and R on its two sides.
/// The two ends of the whole are no free points: their rows stay zero.
Eigen::MatrixXd control_weights(std::span<const double> breaks, int degree) {
  const auto pieces = static_cast<Eigen::Index>(breaks.size()) - 1;
  const Eigen::Index inner = degree - 1;
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(pieces * (degree + 1), pieces * inner);
  for (Eigen::Index piece = 0; piece < pieces; ++piece) {
    const Eigen::Index row = piece * (degree + 1);
    weights.block(row + 1, piece * inner, inner, inner).setIdentity();
    if (piece == 0) continue;
    const auto k = static_cast<std::size_t>(piece);
    const double before = breaks[k] - breaks[k - 1], after = breaks[k + 1] - breaks[k];
    for (const Eigen::Index joint : {row - 1, row}) {
      weights(joint, piece * inner - 1) = after / (before + after);
      weights(joint, piece * inner) = before / (before + after);
    }
  }
  return weights;
}

/// The least-squares curve for given breaks; the straight line is taken off first, as in `fit_bezier`.
PiecewiseBezier fit_at(std::span<const Vec3> points, std::span<const double> times, int degree,
                       std::vector<double> breaks) {
  const Eigen::MatrixXd weights = control_weights(breaks, degree);
  const auto rows = static_cast<Eigen::Index>(points.size()) - 2;
  Eigen::MatrixXd basis(rows, weights.cols()), deviation(rows, 3);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const auto k = static_cast<std::size_t>(i) + 1;
    const std::size_t piece = piece_at(breaks, times[k]);
    const auto first = static_cast<Eigen::Index>(piece) * (degree + 1);
    basis.row(i) = bernstein(local_time(breaks, piece, times[k]), degree) * weights.middleRows(first, degree + 1);
    deviation.row(i) = to_eigen(points[k] - glm::mix(points.front(), points.back(), times[k])).transpose();
  }
  Eigen::MatrixXd offsets = Eigen::MatrixXd::Zero(weights.rows(), 3);
  if (rows > 0) {
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> qr;
    qr.setThreshold(kRankTolerance);
    offsets = weights * qr.compute(basis).solve(deviation);
  }
  PiecewiseBezier curve{std::move(breaks), {}, 0.0};
  for (std::size_t piece = 0; piece + 1 < curve.breaks.size(); ++piece) {
    const Vec3 from = glm::mix(points.front(), points.back(), curve.breaks[piece]);
    const Vec3 to = glm::mix(points.front(), points.back(), curve.breaks[piece + 1]);
    Points control = axis_points(from, to, degree);
    for (std::size_t i = 0; i < control.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(piece * control.size() + i);
      control[i] += to_glm(offsets.row(row).transpose());
    }
    curve.pieces.push_back(std::move(control));
  }
  return curve;
}

/// Largest distance from a point to the curve, for each piece.
std::vector<double> piece_errors(const PiecewiseBezier& curve, std::span<const Vec3> points,
                                 std::span<const double> times) {
  const Points found = curve.positions(times);
  std::vector<double> errors(curve.pieces.size(), 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    double& error = errors[piece_at(curve.breaks, times[i])];
    error = std::max(error, glm::length(points[i] - found[i]));
  }
  return errors;
}

/// Where to cut a piece: at the middle one of its points, when each half then has as many as free control points.
std::optional<double> cut_of(std::span<const double> breaks, std::size_t piece, std::span<const double> times,
                             int degree) {
  const auto first = std::upper_bound(times.begin(), times.end(), breaks[piece]);
  const auto last = std::lower_bound(first, times.end(), breaks[piece + 1]);
  if (last - first < 2 * (degree - 1) + 1) return std::nullopt;
  const double cut = *(first + (last - first) / 2);
  const bool between = cut > breaks[piece] && cut < breaks[piece + 1];
  return between ? std::optional<double>(cut) : std::nullopt;
}

/// The cut in the piece with the largest error over the tolerance that can be cut at all.
std::optional<double> next_cut(std::span<const double> errors, std::span<const double> breaks,
                               std::span<const double> times, const PiecewiseFit& options) {
  std::optional<double> best;
  double worst = options.tolerance;
  for (std::size_t piece = 0; piece < errors.size(); ++piece) {
    if (errors[piece] <= worst) continue;
    const std::optional<double> cut = cut_of(breaks, piece, times, options.degree);
    if (!cut) continue;
    best = cut;
    worst = errors[piece];
  }
  return best;
}

}  // namespace

Points PiecewiseBezier::positions(std::span<const double> s) const {
  Points points;
  for (std::size_t i = 0; i < s.size(); ++i) {
    if (!(s[i] >= 0.0 && s[i] <= 1.0)) {
      throw std::invalid_argument("s[" + std::to_string(i) + "] is " + std::to_string(s[i]) +
                                  ", expected a number in [0, 1]");
    }
    const std::size_t piece = piece_at(breaks, s[i]);
    points.push_back(eval_bezier(pieces[piece], local_time(breaks, piece, s[i])));
  }
  return points;
}

PiecewiseBezier fit_piecewise_bezier(std::span<const Vec3> points, const PiecewiseFit& options) {
  return fit_piecewise_bezier(points, arc_length_times(points), options);
}

PiecewiseBezier fit_piecewise_bezier(std::span<const Vec3> points, std::span<const double> times,
                                     const PiecewiseFit& options) {
  require_options(options);
  (void)fit_bezier(points, times, options.degree);  // refuses points and times that no fit can take
  require_rising(times);
  // The ends of the path are met at 0 and 1, whatever times were given for them.
  std::vector<double> clock(times.begin(), times.end());
  clock.front() = 0.0;
  clock.back() = 1.0;
  std::vector<double> breaks{0.0, 1.0};
  while (true) {
    PiecewiseBezier curve = fit_at(points, clock, options.degree, breaks);
    const std::vector<double> errors = piece_errors(curve, points, clock);
    curve.error = *std::max_element(errors.begin(), errors.end());
    if (curve.pieces.size() >= static_cast<std::size_t>(options.max_pieces)) return curve;
    const std::optional<double> cut = next_cut(errors, breaks, clock, options);
    if (!cut) return curve;
    breaks.insert(std::upper_bound(breaks.begin(), breaks.end(), *cut), *cut);
  }
}

}  // namespace reachcast
