// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/hand_path.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "reachcast/curves/bezier.hpp"
#include "reachcast/curves/distributions.hpp"
#include "reachcast/curves/normal_numbers.hpp"

namespace reachcast {

namespace {

constexpr const char* kDisplacement = "displacement";
constexpr const char* kDistance = "distance";

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument(what);
}

/// One row of scaled offsets per path.
Eigen::MatrixXd offset_rows(std::span<const Points> paths, const HandPathFit& options) {
  const bool timed = options.form.scaling == OffsetScaling::distance_time;
  if (timed && options.durations_s.size() != paths.size()) {
    refuse("durations has " + std::to_string(options.durations_s.size()) + " values, expected " +
           std::to_string(paths.size()) + ", one per path");
  }
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(paths.size()), options.form.size());
  for (std::size_t i = 0; i < paths.size(); ++i) {
    try {
      std::optional<double> duration_s;
      if (timed) duration_s = options.durations_s[i];
      const Points control = fit_bezier(paths[i], options.form.degree);
      rows.row(static_cast<Eigen::Index>(i)) = offsets_of(control, options.form, options.hand, duration_s).transpose();
    } catch (const std::invalid_argument& error) {
      refuse("paths[" + std::to_string(i) + "]: " + error.what());
    }
  }
  return rows;
}

/// Given covariates as those of a right hand, with what the ends of the paths say.
std::vector<Covariate> with_geometry(const std::vector<Covariate>& given, const Points& displacements, Hand hand,
                                     bool displacement, bool distance) {
  std::vector<Covariate> all;
  if (displacement) all.push_back({kDisplacement, displacements});
  if (distance) {
    std::vector<double> distances;
    for (const Vec3& vector : displacements) distances.push_back(glm::length(vector));
    all.push_back({kDistance, std::move(distances)});
  }
  for (const Covariate& covariate : given) {
    if (covariate.name == kDisplacement || covariate.name == kDistance) {
      refuse("covariates['" + covariate.name + "'] is a name that the model fills in itself");
    }
    all.push_back(covariate);
  }
  for (Covariate& covariate : all) {
    auto* const vectors = std::get_if<Points>(&covariate.values);
    if (!vectors) continue;
    for (Vec3& vector : *vectors) vector = for_hand(vector, hand);
  }
  return all;
}

double standard_deviation(const Eigen::VectorXd& values) {
  return std::sqrt((values.array() - values.mean()).square().mean());
}

/// For each column of a design the difference over which reaches stay alike.
Eigen::VectorXd column_lengths(const Design& design, const Eigen::MatrixXd& rows, const HandPathFit& options) {
  Eigen::VectorXd lengths(design.columns());
  for (const auto& entry : options.lengths) {
    const auto named = [&](const Term& term) { return term.name == entry.first; };
    if (std::none_of(design.terms().begin(), design.terms().end(), named)) {
      refuse("lengths['" + entry.first + "'] is not the name of a covariate");
    }
  }
  for (const Term& term : design.terms()) {
    const auto given = options.lengths.find(term.name);
    double length = 1.0;
    if (given != options.lengths.end()) {
      length = given->second;
    } else if (term.kind == CovariateKind::vector) {
      length = kVectorLength_m;
    } else if (term.kind == CovariateKind::number) {
      const double deviation = standard_deviation(rows.col(term.first));
      if (deviation > 0.0) length = deviation;
    }
    if (!(length > 0.0 && std::isfinite(length))) {
      refuse("lengths['" + term.name + "'] is " + std::to_string(length) + ", expected a finite number > 0");
    }
    lengths.segment(term.first, term.count).setConstant(length);
  }
  return lengths;
}

std::variant<LinearFit, SmoothFit> fit_trend(const Design& design, const Eigen::MatrixXd& rows,
                                             const Eigen::MatrixXd& offsets, const HandPathFit& options) {
  if (options.trend != Trend::smooth) return LinearFit(rows, offsets, design.column_names());
  return SmoothFit(rows, offsets, column_lengths(design, rows, options), options.ridge);
}

/// Which paths each person made, in order of the names.
Members paths_of_people(const std::vector<std::string>& people, std::size_t paths) {
  if (people.size() != paths) {
    refuse("people has " + std::to_string(people.size()) + " values, expected " + std::to_string(paths) +
           ", one per path");
  }
  std::map<std::string, std::vector<Eigen::Index>> made;
  for (std::size_t i = 0; i < paths; ++i) made[people[i]].push_back(static_cast<Eigen::Index>(i));
  if (made.size() < 2) refuse("people has 1 different name, expected at least 2 to learn one from the others");
  Members members;
  for (auto& person : made) members.push_back(std::move(person.second));
  return members;
}

}  // namespace

Points HandPath::positions(std::span<const double> t) const {
  std::vector<double> s;
  s.reserve(t.size());
  for (const double time : t) s.push_back(speed.progress(time));
  return eval_bezier(control, s);
}

HandPathModel HandPathModel::published() {
  Eigen::VectorXd mean(6);
  mean << -0.025, -0.148, 0.077, -0.015, -0.139, -0.002;  // 2007, section 4, after Table 2
  return {OffsetForm{}, SpeedProfile{}, LinearFit(mean)};
}

HandPathModel HandPathModel::flash_hogan() {
  return {OffsetForm{.degree = 1}, SpeedProfile::flash_hogan(), LinearFit(Eigen::VectorXd())};
}

HandPathModel HandPathModel::fit(std::span<const Points> paths, const HandPathFit& options) {
  if (paths.empty()) refuse("paths is empty, expected at least 1 path");
  options.form.require_valid();
  (void)options.speed.progress(0.5);  // throws for exponents out of range
  const Eigen::MatrixXd offsets = offset_rows(paths, options);
  Points displacements;
  for (const Points& path : paths) displacements.push_back(path.back() - path.front());
  const std::vector<Covariate> covariates =
      with_geometry(options.covariates, displacements, options.hand, options.displacement, options.distance);
  Design design(covariates, options.trend == Trend::quadratic);
  const Eigen::MatrixXd rows = design.rows(covariates, paths.size());
  HandPathModel model(options.form, options.speed, fit_trend(design, rows, offsets, options));
  if (!options.people.empty()) {
    const Members members = paths_of_people(options.people, paths.size());
    model.residuals_.rows =
        std::visit([&](const auto& trend) { return trend.left_out_residuals(members); }, model.trend_);
    const Eigen::MatrixXd& rows_left_out = model.residuals_.rows;
    model.residuals_.covariance = rows_left_out.transpose() * rows_left_out / static_cast<double>(paths.size());
  }
  model.design_ = std::move(design);
  model.displacement_ = options.displacement;
  model.distance_ = options.distance;
  return model;
}

Eigen::RowVectorXd HandPathModel::row(const Vec3& start, const Vec3& end, const ReachDetails& details) const {
  if (!is_finite(start)) refuse("start is not finite");
  if (!is_finite(end)) refuse("end is not finite");
  return design_.rows(with_geometry(details.covariates, {end - start}, details.hand, displacement_, distance_), 1);
}

Eigen::VectorXd HandPathModel::mean(const Eigen::RowVectorXd& row) const {
  return std::visit([&](const auto& trend) { return trend.mean(row); }, trend_);
}

const Eigen::MatrixXd& HandPathModel::required_covariance() const {
  if (!covariance()) {
    refuse("the model has no covariance: fit it to at least 2 paths, and to more paths than it has coefficients");
  }
  return *covariance();
}

HandPath HandPathModel::predict(const Vec3& start, const Vec3& end, const ReachDetails& details) const {
  const Eigen::VectorXd offsets = mean(row(start, end, details));
  return {control_of(offsets, form_, start, end, details.hand, details.duration_s), speed_};
}

HandPath HandPathModel::sample(const Vec3& start, const Vec3& end, std::uint64_t seed,
                               const ReachDetails& details) const {
  const Eigen::MatrixXd factor = cholesky_factor(required_covariance());
  const Eigen::VectorXd offsets = mean(row(start, end, details)) + factor * normal_numbers(seed, form_.size());
  return {control_of(offsets, form_, start, end, details.hand, details.duration_s), speed_};
}

// A point C(s) is linear in the offsets, so its variance along an axis is b^T V b, with the weights b = scale B_i(s)
// and V the covariance of that axis's offsets: of the mean h S (h the leverage), of a new reach (1 + h) S.
PathBand HandPathModel::band(const Vec3& start, const Vec3& end, std::span<const double> s, double level,
                             const ReachDetails& details, bool of_one_reach) const {
  if (!(level > 0.0 && level < 1.0)) {
    refuse("level is " + std::to_string(level) + ", expected a number between 0 and 1");
  }
  const Eigen::MatrixXd& covariance = required_covariance();
  const Eigen::RowVectorXd at = row(start, end, details);
  const double leverage = std::visit([&](const auto& trend) { return trend.leverage(at); }, trend_);
  const double spread = std::sqrt((of_one_reach ? 1.0 : 0.0) + leverage) *
                        student_t_quantile(0.5 * (1.0 + level), residuals().freedom) *
                        offset_scale(form_, glm::length(end - start), details.duration_s);
  PathBand band{eval_bezier(predict(start, end, details).control, s), {}};
  for (const double value : s) {
    const Eigen::RowVectorXd weights = bernstein(value, degree()).segment(1, degree() - 1);
    Eigen::Vector3d variance = Eigen::Vector3d::Zero();
    for (Eigen::Index i = 0; i < weights.size(); ++i) {
      for (Eigen::Index j = 0; j < weights.size(); ++j) {
        variance += weights[i] * weights[j] * covariance.block<3, 3>(3 * i, 3 * j).diagonal();
      }
    }
    band.half_width.push_back(spread * to_glm(variance.cwiseMax(0.0).cwiseSqrt()));
  }
  return band;
}

std::optional<double> HandPathModel::deviation_bound(double distance_m, std::optional<double> duration_s) const {
  if (!(distance_m >= 0.0 && std::isfinite(distance_m))) {
    refuse("distance is " + std::to_string(distance_m) + ", expected a finite number >= 0");
  }
  const auto* smooth = std::get_if<SmoothFit>(&trend_);
  if (!smooth && design_.columns() > 0) return std::nullopt;
  const double scale = offset_scale(form_, distance_m, duration_s);
  const Vec3 start(0.0), end(distance_m, 0.0, 0.0);
  const Points origins = offset_origins(form_, start, end), axis = axis_points(start, end, degree());
  const Points centre = offsets();
  double farthest = 0.0;
  for (std::size_t i = 0; i < centre.size(); ++i) {
    double offset = glm::length(centre[i]);
    if (smooth) offset += smooth->reach().segment<3>(3 * static_cast<Eigen::Index>(i)).norm();
    farthest = std::max(farthest, scale * offset + glm::length(origins[i] - axis[i + 1]));
  }
  return (1.0 - std::pow(2.0, 1 - degree())) * farthest;
}

Points HandPathModel::offsets() const {
  const auto* smooth = std::get_if<SmoothFit>(&trend_);
  if (!smooth && design_.columns() > 0) refuse("the offsets depend on covariates: predict a path instead");
  const Eigen::VectorXd mean = smooth ? smooth->centre() : linear()->mean(Eigen::RowVectorXd());
  Points points;
  for (Eigen::Index i = 0; i < mean.size(); i += 3) points.push_back(to_glm(mean.segment<3>(i)));
  return points;
}

}  // namespace reachcast
