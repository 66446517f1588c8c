// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/stretch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reachcast/posture/chain.hpp"

namespace reachcast {
namespace {

constexpr double kLogitLimit = 45.0;  // 1 - 1/(1 + e^-45) is below the rounding of double
constexpr double kPoint = 1e-13;      // ranges narrower than this hold no information

double fraction(double value, double min, double max) {
  return max - min < kPoint ? 0.5 : std::clamp((value - min) / (max - min), 0.0, 1.0);
}

double blend(double q, double min, double max) {
  return max - min < kPoint ? 0.5 * (min + max) : min + q * (max - min);
}

}  // namespace

double to_logit(double q) {
  if (q <= 0.0) return -kLogitLimit;
  if (q >= 1.0) return kLogitLimit;
  return std::clamp(std::log(q / (1.0 - q)), -kLogitLimit, kLogitLimit);
}

double from_logit(double x) {
  if (x <= -kLogitLimit) return 0.0;
  return 1.0 / (1.0 + std::exp(-x));
}

StretchDomain::StretchDomain(const Interval& proximal, const Interval& distal, double c)
    : p_lo_(proximal.lo),
      p_hi_(proximal.hi),
      d_lo_(distal.lo),
      d_hi_(distal.hi),
      c_(std::clamp(c, std::max({0.0, proximal.lo - distal.hi, distal.lo - proximal.hi}), proximal.hi + distal.hi)) {}

StretchDomain::Range StretchDomain::sum_range() const {
  // Appendix, q_s max.
  double max = 2.0;
  if (d_hi_ - p_hi_ > c_) max = (c_ + p_hi_ + d_hi_) / d_hi_;
  if (p_hi_ - d_hi_ > c_) max = (c_ + p_hi_ + d_hi_) / p_hi_;
  // Smallest sum: lp/P.hi + (smallest possible ld)/D.hi is convex and piecewise linear in lp; look at its corners.
  const double first = std::max({p_lo_, c_ - d_hi_, d_lo_ - c_});
  const double last = std::max(first, std::min(p_hi_, c_ + d_hi_));
  double min = std::numeric_limits<double>::infinity();
  for (const double corner : {first, last, c_, c_ - d_lo_, c_ + d_lo_}) {
    const double lp = std::clamp(corner, first, last);
    min = std::min(min, lp / p_hi_ + std::max(d_lo_, std::abs(c_ - lp)) / d_hi_);
  }
  return {std::min(min, max), max};
}

StretchDomain::Range StretchDomain::difference_range(double s) const {
  const double total = p_hi_ + d_hi_, excess = p_hi_ - d_hi_;
  // pp <= 1, pd >= D.lo/D.hi, lp - ld <= c   |   pp >= P.lo/P.hi, pd <= 1, ld - lp <= c
  double min = std::max({s - 2.0, 2.0 * d_lo_ / d_hi_ - s, (s * excess - 2.0 * c_) / total});
  double max = std::min({s - 2.0 * p_lo_ / p_hi_, 2.0 - s, (s * excess + 2.0 * c_) / total});
  // lp + ld >= c
  if (excess > 0.0) max = std::min(max, (s * total - 2.0 * c_) / excess);
  if (excess < 0.0) min = std::max(min, (s * total - 2.0 * c_) / excess);
  return {std::min(min, max), std::max(min, max)};
}

std::pair<double, double> StretchDomain::fractions(double lp, double ld) const {
  const double pp = lp / p_hi_, pd = ld / d_hi_;
  const Range sum = sum_range();
  const double s = std::clamp(pp + pd, sum.min, sum.max);
  const Range difference = difference_range(s);
  return {fraction(pp + pd, sum.min, sum.max), fraction(pd - pp, difference.min, difference.max)};
}

std::pair<double, double> StretchDomain::lengths(double qs, double qd) const {
  const Range sum = sum_range();
  const double s = blend(qs, sum.min, sum.max);
  const Range difference = difference_range(s);
  const double d = blend(qd, difference.min, difference.max);
  return {std::clamp(0.5 * (s - d) * p_hi_, p_lo_, p_hi_), std::clamp(0.5 * (s + d) * d_hi_, d_lo_, d_hi_)};
}

StretchDomain::Range StretchDomain::distal_range() const {
  const double min = std::clamp(std::abs(c_ - p_hi_), d_lo_, d_hi_);
  return {min, std::max(min, std::min(d_hi_, c_ + p_hi_))};
}

StretchDomain::Range StretchDomain::proximal_range() const {
  const double min = std::clamp(std::abs(c_ - d_hi_), p_lo_, p_hi_);
  return {min, std::max(min, std::min(p_hi_, c_ + d_hi_))};
}

double StretchDomain::distal_fraction(double ld) const {
  return fraction(ld, distal_range().min, distal_range().max);
}
double StretchDomain::distal_length(double q) const {
  return blend(q, distal_range().min, distal_range().max);
}
double StretchDomain::proximal_fraction(double lp) const {
  return fraction(lp, proximal_range().min, proximal_range().max);
}
double StretchDomain::proximal_length(double q) const {
  return blend(q, proximal_range().min, proximal_range().max);
}

}  // namespace reachcast
