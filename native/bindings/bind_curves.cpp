// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "array_checks.hpp"
#include "module.hpp"
#include "reachcast/curves/bezier.hpp"
#include "reachcast/curves/hand_path.hpp"

namespace py = pybind11;
using namespace py::literals;

namespace {

using reachcast::Hand;
using reachcast::HandPath;
using reachcast::HandPathFit;
using reachcast::HandPathModel;
using reachcast::OffsetScaling;
using reachcast::Points;
using reachcast::SpeedProfile;
using reachcast::bindings::DoubleArray;
using reachcast::bindings::numbers_array;
using reachcast::bindings::points_array;
using reachcast::bindings::to_numbers;
using reachcast::bindings::to_points;
using reachcast::bindings::to_vec3;
using Array = py::array_t<double>;

Hand to_hand(std::string_view name) {
  if (name == "left") return Hand::left;
  if (name == "right") return Hand::right;
  throw std::invalid_argument("hand is '" + std::string(name) + "', expected 'left' or 'right'");
}

OffsetScaling to_scaling(std::string_view name) {
  if (name == "distance") return OffsetScaling::distance;
  if (name == "distance_time") return OffsetScaling::distance_time;
  throw std::invalid_argument("scaling is '" + std::string(name) + "', expected 'distance' or 'distance_time'");
}

Array fit_bezier(const DoubleArray& points, int degree, const std::optional<DoubleArray>& times) {
  const Points path = to_points(points, "points");
  if (times) return points_array(reachcast::fit_bezier(path, to_numbers(*times, "times"), degree));
  return points_array(reachcast::fit_bezier(path, degree));
}

Array eval_bezier(const DoubleArray& control, const DoubleArray& s) {
  return points_array(reachcast::eval_bezier(to_points(control, "control"), to_numbers(s, "s")));
}

HandPathModel fit_model(const std::vector<DoubleArray>& paths, int degree, std::string_view hand,
                        std::string_view scaling, const std::optional<DoubleArray>& durations,
                        const SpeedProfile& speed) {
  HandPathFit options{degree, to_hand(hand), to_scaling(scaling), {}, speed};
  if (durations) options.durations_s = to_numbers(*durations, "durations");
  std::vector<Points> given;
  for (const DoubleArray& path : paths) given.push_back(to_points(path, "paths[" + std::to_string(given.size()) + "]"));
  const py::gil_scoped_release release;
  return HandPathModel::fit(given, options);
}

HandPath predict(const HandPathModel& model, const DoubleArray& start, const DoubleArray& end, std::string_view hand,
                 std::optional<double> duration) {
  return model.predict(to_vec3(start, "start"), to_vec3(end, "end"), to_hand(hand), duration);
}

HandPath sample(const HandPathModel& model, const DoubleArray& start, const DoubleArray& end, std::uint64_t seed,
                std::string_view hand, std::optional<double> duration) {
  return model.sample(to_vec3(start, "start"), to_vec3(end, "end"), seed, to_hand(hand), duration);
}

py::object covariance(const HandPathModel& model) {
  if (!model.covariance()) return py::none();
  const Eigen::MatrixXd& matrix = *model.covariance();
  Array array({matrix.rows(), matrix.cols()});
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) array.mutable_at(i, j) = matrix(i, j);
  }
  return array;
}

/// Applies one of the profile's functions to an array of times.
template <double (SpeedProfile::*function)(double) const>
Array over_times(const SpeedProfile& profile, const DoubleArray& t) {
  std::vector<double> values = to_numbers(t, "t");
  for (double& value : values) value = (profile.*function)(value);
  return numbers_array(values);
}

std::string profile_text(const SpeedProfile& profile) {
  char text[80];
  std::snprintf(text, sizeof text, "SpeedProfile(alpha=%g, beta=%g)", profile.alpha, profile.beta);
  return text;
}

std::string model_text(const HandPathModel& model) {
  return "<HandPathModel of degree " + std::to_string(model.degree()) + ", scaled by " +
         (model.scaling() == OffsetScaling::distance ? "distance" : "distance and time") +
         (model.covariance() ? ", with covariance>" : ", without covariance>");
}

void bind_bezier(py::module_& m) {
  m.def("fit_bezier", &fit_bezier, "points"_a, "degree"_a = 3, py::kw_only(), "times"_a = py::none(),
        "points (n, 3), n >= 2 -> control points (degree + 1, 3), the first and last those of the path, the inner ones "
        "by least squares. times (n,) in [0, 1]: relative times of the points, by default their arc length.");
  m.def("eval_bezier", &eval_bezier, "control"_a, "s"_a, "control (d + 1, 3), s (m,) in [0, 1] -> points (m, 3).");
}

void bind_paths(py::module_& m) {
  py::class_<SpeedProfile>(m, "SpeedProfile",
                           "Relative speed t^alpha (1-t)^beta over relative time t; that is Beta(alpha+1, beta+1).")
      .def(py::init([](double alpha, double beta) {
             const SpeedProfile profile{alpha, beta};
             (void)profile.progress(0.5);  // refuses exponents out of range
             return profile;
           }),
           py::kw_only(), "alpha"_a = SpeedProfile{}.alpha, "beta"_a = SpeedProfile{}.beta)
      .def_readonly("alpha", &SpeedProfile::alpha)
      .def_readonly("beta", &SpeedProfile::beta)
      .def("progress", &over_times<&SpeedProfile::progress>, "t"_a, "t (m,) in [0, 1] -> share of the path (m,).")
      .def("speed", &over_times<&SpeedProfile::speed>, "t"_a,
           "t (m,) in [0, 1] -> path length per movement time (m,); its mean over time is 1.")
      .def("__repr__", &profile_text);
  py::class_<HandPath>(m, "HandPath", "Control points and speed profile; unpacks as `control, speed = path`.")
      .def_property_readonly(
          "control", [](const HandPath& self) { return points_array(self.control); },
          "(degree + 1, 3), metres; a copy.")
      .def_property_readonly("speed", [](const HandPath& self) { return self.speed; })
      .def(
          "positions",
          [](const HandPath& self, const DoubleArray& t) { return points_array(self.positions(to_numbers(t, "t"))); },
          "t"_a, "t (m,), relative times in [0, 1] -> positions (m, 3), metres.")
      .def("__iter__",
           [](const HandPath& self) { return py::iter(py::make_tuple(points_array(self.control), self.speed)); })
      .def("__repr__", [](const HandPath& self) {
        return "<HandPath of " + std::to_string(self.control.size()) + " control points, " + profile_text(self.speed) +
               ">";
      });
}

void bind_model(py::module_& m) {
  py::class_<HandPathModel>(
      m, "HandPathModel",
      "Hand paths as offsets of Bezier control points from the straight line. Body frame: x to the "
      "subject's right, y forward, z up, metres.")
      .def_static("published", &HandPathModel::published, "The published null model; it needs no data.")
      .def_static("fit", &fit_model, "paths"_a, py::kw_only(), "degree"_a = 3, "hand"_a = "right",
                  "scaling"_a = "distance", "durations"_a = py::none(), "speed"_a = SpeedProfile{},
                  "paths: list of (n, 3), the ends of each at least 1 cm apart. scaling 'distance' or 'distance_time'; "
                  "the latter needs durations (seconds, one per path), here and in predict.")
      .def("predict", &predict, "start"_a, "end"_a, py::kw_only(), "hand"_a = "right", "duration"_a = py::none(),
           "start (3,), end (3,) -> the mean HandPath between them.")
      .def("sample", &sample, "start"_a, "end"_a, "seed"_a, py::kw_only(), "hand"_a = "right",
           "duration"_a = py::none(), "Like predict, drawn at random; needs a model fitted to at least 2 paths.")
      .def_property_readonly("degree", &HandPathModel::degree)
      .def_property_readonly(
          "offsets", [](const HandPathModel& self) { return points_array(self.offsets()); },
          "(degree - 1, 3) scaled offsets of the right hand; a copy.")
      .def_property_readonly("covariance", &covariance,
                             "(3 (degree - 1), 3 (degree - 1)) of the stacked offsets, or None; a copy.")
      .def("__repr__", &model_text);
}

}  // namespace

void bind_curves(py::module_& m) {
  bind_bezier(m);
  bind_paths(m);
  bind_model(m);
}
