// SPDX-License-Identifier: GPL-3.0-or-later
/// How far along its path a hand is, against time (Faraway, Reed, Wang 2007, section 4).
#pragma once

#include "reachcast/conventions.hpp"

namespace reachcast {

/// Relative speed proportional to t^alpha (1-t)^beta over relative time t in [0, 1]; in the usual notation of the
/// distribution that is Beta(alpha + 1, beta + 1). The paper writes 30 t^2 (1-t)^2 as alpha = beta = 2, and its peak at
/// 0.48 is 1.63 / (1.63 + 1.75). Defaults: the published medians.
/// alpha and beta are each in [0, kMaxExponent]; the functions throw std::invalid_argument for others, and for t
/// outside [0, 1].
struct SpeedProfile {
  static constexpr double kMaxExponent = 1000.0;

  double alpha = 1.63;
  double beta = 1.75;

  /// Share of the path covered: 0 at 0, 1 at 1, never falling; the integral of `speed`.
  [[nodiscard]] double progress(double t) const;
  /// Path length per movement time; its mean over [0, 1] is 1.
  [[nodiscard]] double speed(double t) const;
};

/// I_x(a, b), the distribution function of Beta(a, b); a, b >= 1 and x in [0, 1]. Absolute error below 1e-13 for a and
/// b up to 1001.
[[nodiscard]] double regularised_incomplete_beta(double a, double b, double x);

}  // namespace reachcast
