// SPDX-License-Identifier: GPL-3.0-or-later
/// How far along its path a hand is, against time (Faraway, Reed, Wang 2007, section 4).
#pragma once

#include <span>
#include <vector>

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

  /// Least jerk on a straight line (Flash and Hogan 1985): 30 t^2 (1-t)^2.
  [[nodiscard]] static constexpr SpeedProfile flash_hogan() { return {2.0, 2.0}; }

  /// Share of the path covered: 0 at 0, 1 at 1, never falling; the integral of `speed`.
  [[nodiscard]] double progress(double t) const;
  /// Path length per movement time; its mean over [0, 1] is 1.
  [[nodiscard]] double speed(double t) const;
};

/// The profile of greatest likelihood when `sample` is drawn from its density, each value counted `weights` times
/// (empty: once each): relative times in (0, 1), at least two of them different; weights >= 0, of any sum. Where the
/// likelihood still rises at the edge of [0, kMaxExponent], the edge is the answer.
/// Throws std::invalid_argument.
[[nodiscard]] SpeedProfile fit_speed_sample(std::span<const double> sample, std::span<const double> weights = {});

/// The profile of a recorded path: the sample are the middles of its time steps, each weighted with the distance
/// covered in it. `times` in seconds or any unit, rising, one per point; empty: evenly spaced.
/// Throws std::invalid_argument for fewer than 3 points, times that do not rise, and a path that moves in fewer than
/// two of its steps: a standstill has no profile.
[[nodiscard]] SpeedProfile fit_speed_profile(std::span<const Vec3> points, std::span<const double> times = {});

/// Medians of alpha and of beta over profiles, as the paper takes them; throws std::invalid_argument for none.
[[nodiscard]] SpeedProfile median_profile(std::span<const SpeedProfile> profiles);

}  // namespace reachcast
