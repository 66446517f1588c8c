// SPDX-License-Identifier: GPL-3.0-or-later
/// The distributions that tests and confidence bands need, from Boost.Math in plain double precision, so that every
/// machine computes the same numbers.
#pragma once

namespace reachcast {

/// I_x(a, b), the distribution function of Beta(a, b); a, b > 0. 0 for x <= 0 and 1 for x >= 1.
[[nodiscard]] double regularised_incomplete_beta(double a, double b, double x);

/// Derivative of the logarithm of the gamma function; x > 0.
[[nodiscard]] double digamma(double x);

/// How likely |T| is to be at least |t|, for Student's T with `freedom` > 0 degrees of freedom.
[[nodiscard]] double student_t_p_value(double t, double freedom);
/// The t that T exceeds with probability 1 - p; p in (0, 1).
[[nodiscard]] double student_t_quantile(double p, double freedom);
/// How likely F is to be at least f, for Fisher's F with these degrees of freedom; f >= 0. Zero for infinite f.
[[nodiscard]] double fisher_f_p_value(double f, double numerator_freedom, double denominator_freedom);

}  // namespace reachcast
