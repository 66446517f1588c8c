// SPDX-License-Identifier: GPL-3.0-or-later
/// Where a hand goes between two given points: a Bezier curve whose inner control points are predicted from what is
/// known about the reach (Faraway, Reed, Wang 2007, sections 3.3 and 4).
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "reachcast/conventions.hpp"
#include "reachcast/curves/covariates.hpp"
#include "reachcast/curves/hand_path_speed.hpp"
#include "reachcast/curves/path_offsets.hpp"
#include "reachcast/curves/regression.hpp"
#include "reachcast/curves/smooth_fit.hpp"

namespace reachcast {

/// A path and the timing along it.
struct HandPath {
  Points control;  ///< first and last are exactly the start and the end asked for
  SpeedProfile speed;

  /// Positions at relative times in [0, 1]: the curve at the progress of each. Throws std::invalid_argument for others.
  [[nodiscard]] Points positions(std::span<const double> t) const;
};

/// How the offsets depend on covariates. With no covariates each is the null model, the mean over all paths; with one
/// label, linear gives the group means.
enum class Trend {
  linear,     ///< least squares
  quadratic,  ///< least squares, with squares of numbers and vectors, and the mixed products of a vector
  smooth,     ///< kernel ridge regression; far from the data it is the null model
};

struct HandPathFit {
  OffsetForm form;
  Hand hand = Hand::right;          ///< the hand that made the paths
  std::vector<double> durations_s;  ///< one per path, > 0, for distance_time only
  SpeedProfile speed;               ///< taken over into predictions; not estimated
  Trend trend = Trend::linear;
  std::vector<Covariate> covariates;  ///< one value per path; names "displacement" and "distance" are taken
  bool displacement = false;          ///< the vector from start to end is a covariate, known of every path
  bool distance = false;              ///< its length is one
  /// Who made each path, or empty. A person's reaches resemble each other, so what is left of them around a fit that
  /// knows the person is too little for a stranger. With people, the residuals are those of each person when learned
  /// from the others, and the covariance (divisor: paths) is theirs.
  std::vector<std::string> people;
  /// For smooth: over which difference of a covariate reaches stay alike, by name. Otherwise kVectorLength_m, a label's
  /// 1, and a number's standard deviation.
  std::map<std::string, double> lengths;
  double ridge = 0.3;  ///< for smooth: variance about the surface relative to the surface's own
};

inline constexpr double kVectorLength_m = 0.6;  ///< about an arm's length: targets nearer than that are reached alike

/// What is known of a reach besides its ends.
struct ReachDetails {
  Hand hand = Hand::right;
  std::optional<double> duration_s;   ///< for distance_time
  std::vector<Covariate> covariates;  ///< those of the fit, one value each; vectors in the frame of the hand's person
};

/// A predicted path and how far it may be off, coordinate by coordinate.
struct PathBand {
  Points centre;
  Points half_width;
};

class HandPathModel {
 public:
  /// The means of the paper's 2,031 reaches (section 4), scaled by distance; no covariance was published.
  [[nodiscard]] static HandPathModel published();
  /// A straight line with least jerk (Flash and Hogan 1985), which the paper compares with.
  [[nodiscard]] static HandPathModel flash_hogan();

  /// Learns from paths of at least 2 points, whose ends are at least kMinimumReach_m apart unless the scaling is none.
  /// One path is enough for a mean, two for a covariance. Throws std::invalid_argument that names the path, the
  /// covariate or the option.
  [[nodiscard]] static HandPathModel fit(std::span<const Points> paths, const HandPathFit& options = {});

  /// The mean path. With scaled offsets a path that ends where it starts has all control points equal to it.
  /// Throws std::invalid_argument for points that are not finite, a missing duration and missing covariates.
  [[nodiscard]] HandPath predict(const Vec3& start, const Vec3& end, const ReachDetails& details = {}) const;

  /// One path drawn from the multivariate normal of the offsets (section 4, Fig. 8). The same seed draws the same
  /// deviation on every machine. Throws also if the model has no covariance.
  [[nodiscard]] HandPath sample(const Vec3& start, const Vec3& end, std::uint64_t seed,
                                const ReachDetails& details = {}) const;

  /// Pointwise confidence band (Student's t) at curve parameters s: holds the mean path with probability `level` in
  /// (0, 1), or with `of_one_reach` a single new reach. Throws also if the model has no covariance.
  [[nodiscard]] PathBand band(const Vec3& start, const Vec3& end, std::span<const double> s, double level = 0.95,
                              const ReachDetails& details = {}, bool of_one_reach = false) const;

  /// No predicted path of this distance, whatever its covariates, leaves the straight line by more (metres), measured
  /// from the point of the line at the same s. Empty for linear and quadratic trends with covariates: nothing bounds
  /// them. From the curve's convex hull (section 5): the sum over i of B_i(s) |P_i - A_i| is at most
  /// (1 - 2^(1-d)) max |P_i - A_i|.
  [[nodiscard]] std::optional<double> deviation_bound(double distance_m, std::optional<double> duration_s = {}) const;

  [[nodiscard]] const OffsetForm& form() const { return form_; }
  [[nodiscard]] int degree() const { return form_.degree; }
  [[nodiscard]] const SpeedProfile& speed() const { return speed_; }
  [[nodiscard]] const Design& design() const { return design_; }
  /// Coefficients, standard errors and tests of a linear or quadratic trend; null for a smooth one.
  [[nodiscard]] const LinearFit* linear() const { return std::get_if<LinearFit>(&trend_); }
  /// The degree - 1 mean scaled offsets of the right hand: those of the null model, or what a smooth trend tends to
  /// far from its data. Throws std::invalid_argument for linear and quadratic trends with covariates.
  [[nodiscard]] Points offsets() const;
  /// Of the scaled offsets stacked as x, y, z of P_1, then P_2, ...: residuals, their covariance and freedom.
  [[nodiscard]] const Residuals& residuals() const { return residuals_; }
  [[nodiscard]] const std::optional<Eigen::MatrixXd>& covariance() const { return residuals().covariance; }

 private:
  HandPathModel(const OffsetForm& form, const SpeedProfile& speed, std::variant<LinearFit, SmoothFit> trend)
      : form_(form), speed_(speed), trend_(std::move(trend)) {
    residuals_ = std::visit([](const auto& any) { return any.residuals(); }, trend_);
  }
  [[nodiscard]] Eigen::RowVectorXd row(const Vec3& start, const Vec3& end, const ReachDetails& details) const;
  [[nodiscard]] Eigen::VectorXd mean(const Eigen::RowVectorXd& row) const;
  [[nodiscard]] const Eigen::MatrixXd& required_covariance() const;

  OffsetForm form_;
  SpeedProfile speed_;
  std::variant<LinearFit, SmoothFit> trend_;
  Residuals residuals_;
  Design design_;
  bool displacement_ = false, distance_ = false;
};

}  // namespace reachcast
