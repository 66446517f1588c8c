// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>
#include <vector>

#include "array_checks.hpp"
#include "module.hpp"
#include "path_names.hpp"
#include "reachcast/curves/variation.hpp"

namespace py = pybind11;
using namespace py::literals;

namespace {

using namespace reachcast::bindings;
using reachcast::Alignment;
using reachcast::Points;
using Array = py::array_t<double>;
using Measure = std::vector<double> (*)(std::span<const Points>, std::span<const std::string>, Alignment);

template <Measure measure>
Array variation(const std::vector<DoubleArray>& paths, const std::vector<std::string>& groups,
                const std::string& alignment) {
  std::vector<Points> given;
  for (const DoubleArray& path : paths) given.push_back(to_points(path, "paths[" + std::to_string(given.size()) + "]"));
  return numbers_array(measure(given, groups, choice(kAlignments, alignment, "alignment")));
}

Array resample_path(const DoubleArray& path, std::size_t count) {
  return points_array(reachcast::resampled(to_points(path, "path"), count));
}

py::tuple principal_components(const DoubleArray& covariance) {
  require_shape(covariance, "covariance", {kAnySize, covariance.ndim() > 0 ? covariance.shape(0) : kAnySize});
  require_finite(covariance, "covariance");
  Eigen::MatrixXd matrix(covariance.shape(0), covariance.shape(0));
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) matrix(i, j) = covariance.at(i, j);
  }
  const reachcast::PrincipalComponents components = reachcast::principal_components(matrix);
  return py::make_tuple(numbers_array(components.variances), matrix_array(components.directions));
}

}  // namespace

void bind_variation(py::module_& m) {
  m.def("resample_path", &resample_path, "path"_a, "count"_a,
        "path (n, 3) -> (count, 3) at evenly spaced relative arc lengths.");
  m.def("variation_within", &variation<&reachcast::variation_within>, "paths"_a, "groups"_a, py::kw_only(),
        "alignment"_a = "ends",
        "Largest distances over relative arc length, one for each pair of paths with the same group (a string per "
        "path: who did what).\nalignment: 'none', 'start' (moved to a common start) or 'ends' (deviations from each "
        "path's own straight line).");
  m.def("variation_about_median", &variation<&reachcast::variation_about_median>, "paths"_a, "groups"_a, py::kw_only(),
        "alignment"_a = "ends",
        "Largest distances from the median path of the group (a task), one for each path that is not alone in its "
        "group.");
  m.def("principal_components", &principal_components, "covariance"_a,
        "covariance (n, n) -> (variances (n,), falling; directions (n, n), one per column).");
}
