// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/variation.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <map>
#include <stdexcept>

#include "reachcast/curves/bezier.hpp"

namespace reachcast {

namespace {

constexpr std::size_t kSamples = 101;  // per path: every hundredth of its length

Points aligned(std::span<const Vec3> path, Alignment alignment) {
  Points points = resampled(path, kSamples);
  const Vec3 start = points.front(), end = points.back();
  for (std::size_t i = 0; i < kSamples && alignment != Alignment::none; ++i) {
    const double s = static_cast<double>(i) / (kSamples - 1);
    points[i] -= alignment == Alignment::start ? start : glm::mix(start, end, s);
  }
  return points;
}

double largest_distance(const Points& a, const Points& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, glm::length(a[i] - b[i]));
  return largest;
}

double median_of(std::vector<double>& values) {
  std::sort(values.begin(), values.end());
  return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

Points median_path(const std::vector<Points>& paths, const std::vector<std::size_t>& members) {
  Points median(kSamples);
  std::vector<double> values(members.size());
  for (std::size_t i = 0; i < kSamples; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t k = 0; k < members.size(); ++k) values[k] = paths[members[k]][i][axis];
      median[i][axis] = median_of(values);
    }
  }
  return median;
}

std::vector<Points> all_aligned(std::span<const Points> paths, std::span<const std::string> groups,
                                Alignment alignment) {
  if (groups.size() != paths.size()) {
    throw std::invalid_argument("groups has " + std::to_string(groups.size()) + " values, expected " +
                                std::to_string(paths.size()) + ", one per path");
  }
  std::vector<Points> result;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    try {
      result.push_back(aligned(paths[i], alignment));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("paths[" + std::to_string(i) + "]: " + error.what());
    }
  }
  return result;
}

}  // namespace

Points resampled(std::span<const Vec3> path, std::size_t count) {
  const std::vector<double> lengths = arc_length_times(path);
  Points points;
  std::size_t step = 0;
  for (const double s : even_times(count)) {
    while (step + 2 < path.size() && lengths[step + 1] < s) ++step;
    const double span = lengths[step + 1] - lengths[step];
    const double part = span > 0.0 ? std::clamp((s - lengths[step]) / span, 0.0, 1.0) : 0.0;
    points.push_back(glm::mix(path[step], path[step + 1], part));
  }
  points.back() = path.back();
  return points;
}

std::vector<double> variation_within(std::span<const Points> paths, std::span<const std::string> groups,
                                     Alignment alignment) {
  const std::vector<Points> shapes = all_aligned(paths, groups, alignment);
  std::vector<double> distances;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    for (std::size_t j = i + 1; j < shapes.size(); ++j) {
      if (groups[i] == groups[j]) distances.push_back(largest_distance(shapes[i], shapes[j]));
    }
  }
  return distances;
}

std::vector<double> variation_about_median(std::span<const Points> paths, std::span<const std::string> groups,
                                           Alignment alignment) {
  const std::vector<Points> shapes = all_aligned(paths, groups, alignment);
  std::map<std::string, std::vector<std::size_t>> members;
  for (std::size_t i = 0; i < shapes.size(); ++i) members[groups[i]].push_back(i);
  std::map<std::string, Points> medians;
  for (const auto& [group, indices] : members) medians[group] = median_path(shapes, indices);
  std::vector<double> distances;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (members[groups[i]].size() >= 2) distances.push_back(largest_distance(shapes[i], medians[groups[i]]));
  }
  return distances;
}

PrincipalComponents principal_components(const Eigen::MatrixXd& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  PrincipalComponents components{solver.eigenvalues().reverse().cwiseMax(0.0),
                                 solver.eigenvectors().rowwise().reverse()};
  for (Eigen::Index i = 0; i < components.directions.cols(); ++i) {
    Eigen::Index largest = 0;
    components.directions.col(i).cwiseAbs().maxCoeff(&largest);
    if (components.directions(largest, i) < 0.0) components.directions.col(i) *= -1.0;
  }
  return components;
}

}  // namespace reachcast
