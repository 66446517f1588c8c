// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/distributions.hpp"

#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/digamma.hpp>
#include <cmath>

namespace reachcast {

namespace {

// Boost would compute in long double, which is another type on other machines.
using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

}  // namespace

double regularised_incomplete_beta(double a, double b, double x) {
  if (x <= 0.0) return 0.0;
  if (x >= 1.0) return 1.0;
  return boost::math::ibeta(a, b, x, InDouble());
}

double digamma(double x) {
  return boost::math::digamma(x, InDouble());
}

double student_t_p_value(double t, double freedom) {
  if (std::isinf(t)) return 0.0;
  const boost::math::students_t_distribution<double, InDouble> distribution(freedom);
  return 2.0 * cdf(complement(distribution, std::abs(t)));
}

double student_t_quantile(double p, double freedom) {
  return quantile(boost::math::students_t_distribution<double, InDouble>(freedom), p);
}

double fisher_f_p_value(double f, double numerator_freedom, double denominator_freedom) {
  if (std::isinf(f)) return 0.0;
  const boost::math::fisher_f_distribution<double, InDouble> distribution(numerator_freedom, denominator_freedom);
  return cdf(complement(distribution, f));
}

}  // namespace reachcast
