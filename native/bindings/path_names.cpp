// SPDX-License-Identifier: GPL-3.0-or-later
#include "path_names.hpp"

#include <pybind11/stl.h>

namespace reachcast::bindings {

namespace {

namespace py = pybind11;

bool is_list_of_strings(const py::handle& value) {
  if (!py::isinstance<py::list>(value) && !py::isinstance<py::tuple>(value)) return false;
  for (const py::handle item : value) {
    if (!py::isinstance<py::str>(item)) return false;
  }
  return py::len(value) > 0;
}

DoubleArray to_array(const py::handle& value, const std::string& name) {
  const DoubleArray array = DoubleArray::ensure(value);
  if (array) return array;
  PyErr_Clear();
  throw std::invalid_argument(name + " is " + py::repr(value).cast<std::string>() +
                              ", expected numbers (n,), vectors (n, 3) or a list of strings");
}

}  // namespace

std::vector<Covariate> to_covariates(const py::dict& given) {
  std::vector<Covariate> covariates;
  for (const auto& [key, value] : given) {
    const auto name = py::str(key).cast<std::string>();
    const std::string label = "covariates['" + name + "']";
    if (is_list_of_strings(value)) {
      covariates.push_back({name, value.cast<std::vector<std::string>>()});
      continue;
    }
    const DoubleArray array = to_array(value, label);
    if (array.ndim() == 2) {
      covariates.push_back({name, to_points(array, label)});
    } else {
      covariates.push_back({name, to_numbers(array, label)});
    }
  }
  return covariates;
}

std::vector<Covariate> to_single_covariates(const py::dict& given) {
  py::dict lists;
  for (const auto& [key, value] : given) {
    py::list list;
    list.append(value);
    lists[key] = list;
  }
  return to_covariates(lists);
}

py::array_t<double> matrix_array(const Eigen::MatrixXd& matrix) {
  py::array_t<double> array({matrix.rows(), matrix.cols()});
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) array.mutable_at(i, j) = matrix(i, j);
  }
  return array;
}

}  // namespace reachcast::bindings
