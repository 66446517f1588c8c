// SPDX-License-Identifier: GPL-3.0-or-later
/// The domain of the two stretches of a pivot (Faraway 2004, (2.1)-(2.7) and Appendix) when each side has an interval
/// of reach [lo, hi] and not just an upper bound. With lo = 0 it is the paper's.
#pragma once

#include <utility>

namespace reachcast {

struct Interval;

/// logit, with q clamped so that 0 and 1 survive a round trip through double: |logit| <= 45.
[[nodiscard]] double to_logit(double q);
[[nodiscard]] double from_logit(double x);

/// lp in [P.lo, P.hi], ld in [D.lo, D.hi], |lp - ld| <= c <= lp + ld; stretches pp = lp / P.hi, pd = ld / D.hi,
/// s = pp + pd, d = pd - pp. Fractions are positions within the possible range, in [0, 1]; where the range is a point,
/// the fraction is 1/2.
class StretchDomain {
 public:
  StretchDomain(const Interval& proximal, const Interval& distal, double c);

  /// (q_s, q_d) of (2.6) and (2.7), and back.
  [[nodiscard]] std::pair<double, double> fractions(double lp, double ld) const;
  [[nodiscard]] std::pair<double, double> lengths(double qs, double qd) const;

  /// One side is a single link (lo = hi): the other side's length within its range, and back.
  [[nodiscard]] double distal_fraction(double ld) const;
  [[nodiscard]] double distal_length(double q) const;
  [[nodiscard]] double proximal_fraction(double lp) const;
  [[nodiscard]] double proximal_length(double q) const;

 private:
  struct Range {
    double min, max;
  };
  [[nodiscard]] Range sum_range() const;
  [[nodiscard]] Range difference_range(double s) const;
  [[nodiscard]] Range distal_range() const;
  [[nodiscard]] Range proximal_range() const;
  double p_lo_, p_hi_, d_lo_, d_hi_, c_;
};

}  // namespace reachcast
