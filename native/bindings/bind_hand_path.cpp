// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "array_checks.hpp"
#include "module.hpp"
#include "path_names.hpp"
#include "reachcast/curves/hand_path.hpp"

namespace py = pybind11;
using namespace py::literals;

namespace {

using namespace reachcast::bindings;
using reachcast::HandPath;
using reachcast::HandPathFit;
using reachcast::HandPathModel;
using reachcast::LinearFit;
using reachcast::PathBand;
using reachcast::Points;
using reachcast::ReachDetails;
using reachcast::SpeedProfile;
using Array = py::array_t<double>;

HandPathModel fit_model(const std::vector<DoubleArray>& paths, int degree, const std::string& hand,
                        const std::string& scaling, const std::optional<DoubleArray>& durations,
                        const SpeedProfile& speed, const std::string& parameterisation, const std::string& trend,
                        const py::dict& covariates, bool displacement, bool distance,
                        const std::map<std::string, double>& lengths, double ridge,
                        const std::vector<std::string>& people) {
  HandPathFit options;
  options.form = {degree, choice(kOrigins, parameterisation, "parameterisation"),
                  choice(kScalings, scaling, "scaling")};
  options.hand = choice(kHands, hand, "hand");
  if (durations) options.durations_s = to_numbers(*durations, "durations");
  options.speed = speed;
  options.trend = choice(kTrends, trend, "trend");
  options.covariates = to_covariates(covariates);
  options.displacement = displacement;
  options.distance = distance;
  options.lengths = lengths;
  options.ridge = ridge;
  options.people = people;
  std::vector<Points> given;
  for (const DoubleArray& path : paths) given.push_back(to_points(path, "paths[" + std::to_string(given.size()) + "]"));
  const py::gil_scoped_release release;
  return HandPathModel::fit(given, options);
}

ReachDetails to_details(const std::string& hand, std::optional<double> duration, const py::dict& covariates) {
  return {choice(kHands, hand, "hand"), duration, to_single_covariates(covariates)};
}

HandPath predict(const HandPathModel& model, const DoubleArray& start, const DoubleArray& end, const std::string& hand,
                 std::optional<double> duration, const py::dict& covariates) {
  return model.predict(to_vec3(start, "start"), to_vec3(end, "end"), to_details(hand, duration, covariates));
}

HandPath sample(const HandPathModel& model, const DoubleArray& start, const DoubleArray& end, std::uint64_t seed,
                const std::string& hand, std::optional<double> duration, const py::dict& covariates) {
  return model.sample(to_vec3(start, "start"), to_vec3(end, "end"), seed, to_details(hand, duration, covariates));
}

py::tuple band(const HandPathModel& model, const DoubleArray& start, const DoubleArray& end, const DoubleArray& s,
               double level, bool of_one_reach, const std::string& hand, std::optional<double> duration,
               const py::dict& covariates) {
  const PathBand result = model.band(to_vec3(start, "start"), to_vec3(end, "end"), to_numbers(s, "s"), level,
                                     to_details(hand, duration, covariates), of_one_reach);
  return py::make_tuple(points_array(result.centre), points_array(result.half_width));
}

const LinearFit& linear_fit(const HandPathModel& model) {
  if (const LinearFit* fit = model.linear()) return *fit;
  throw std::invalid_argument("a smooth trend has no coefficients: fit with trend 'linear' or 'quadratic'");
}

py::list term_tests(const HandPathModel& model) {
  const LinearFit& fit = linear_fit(model);
  py::list rows;
  for (const reachcast::Term& term : model.design().terms()) {
    const reachcast::TermTest test = fit.test(term.first, term.count);
    rows.append(py::dict("term"_a = term.name,
                         "freedom"_a = py::make_tuple(test.numerator_freedom, test.denominator_freedom),
                         "f"_a = numbers_array(test.f), "p_value"_a = numbers_array(test.p_value),
                         "wilks"_a = test.wilks, "wilks_p_value"_a = test.wilks_p_value));
  }
  return rows;
}

std::vector<std::string> coefficient_names(const HandPathModel& model) {
  std::vector<std::string> names = model.design().column_names();
  names.insert(names.begin(), "intercept");
  return names;
}

py::object covariance(const HandPathModel& model) {
  if (!model.covariance()) return py::none();
  return matrix_array(*model.covariance());
}

std::string model_text(const HandPathModel& model) {
  std::string terms;
  for (const reachcast::Term& term : model.design().terms()) terms += (terms.empty() ? "" : ", ") + term.name;
  return "<HandPathModel of degree " + std::to_string(model.degree()) + ", scaling '" +
         word(kScalings, model.form().scaling) + "', " + (terms.empty() ? "null model" : "on " + terms) +
         (model.covariance() ? ", with covariance>" : ", without covariance>");
}

void bind_path(py::module_& m) {
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
        return "<HandPath of " + std::to_string(self.control.size()) + " control points, " +
               py::repr(py::cast(self.speed)).cast<std::string>() + ">";
      });
}

using ModelClass = py::class_<HandPathModel>;

void bind_fit(ModelClass& model) {
  const HandPathFit defaults;
  model.def_static("published", &HandPathModel::published, "The published null model; it needs no data.")
      .def_static("flash_hogan", &HandPathModel::flash_hogan, "A straight line with least jerk.")
      .def_static(
          "fit", &fit_model, "paths"_a, py::kw_only(), "degree"_a = defaults.form.degree, "hand"_a = "right",
          "scaling"_a = "distance", "durations"_a = py::none(), "speed"_a = defaults.speed,
          "parameterisation"_a = "axis", "trend"_a = "linear", "covariates"_a = py::dict(),
          "displacement"_a = defaults.displacement, "distance"_a = defaults.distance, "lengths"_a = py::dict(),
          "ridge"_a = defaults.ridge, "people"_a = defaults.people,
          "paths: list of (n, 3), the ends of each at least 1 cm apart unless scaling is 'none'.\n"
          "scaling: 'none', 'distance' or 'distance_time'; the latter needs durations (seconds, one per path), here "
          "and "
          "in predict.\n"
          "parameterisation: 'axis', 'ends', 'start_axis' (first half of the inner points from the start, the rest "
          "from "
          "the axis) or 'axis_end'.\n"
          "covariates: name to numbers (n,), vectors (n, 3) in the body frame, or a list of n labels; displacement and "
          "distance from start to end are added by their flags. Without any this is the null model, with one label the "
          "group means.\n"
          "trend: 'linear', 'quadratic' or 'smooth' (kernel ridge regression). For smooth, lengths gives by name over "
          "which difference reaches stay alike (vectors 0.6 m, labels 1, numbers their standard deviation), ridge the "
          "variance about the surface relative to the surface's own.\n"
          "people: who made each path; residuals and covariance are then those of a person learned from the others.");
}

void bind_predictions(ModelClass& model) {
  model
      .def("predict", &predict, "start"_a, "end"_a, py::kw_only(), "hand"_a = "right", "duration"_a = py::none(),
           "covariates"_a = py::dict(),
           "start (3,), end (3,) -> the mean HandPath between them; covariates: those of the fit, one value each.")
      .def("sample", &sample, "start"_a, "end"_a, "seed"_a, py::kw_only(), "hand"_a = "right",
           "duration"_a = py::none(), "covariates"_a = py::dict(),
           "Like predict, drawn at random; needs a model with a covariance.")
      .def("band", &band, "start"_a, "end"_a, "s"_a, py::kw_only(), "level"_a = 0.95, "of_one_reach"_a = false,
           "hand"_a = "right", "duration"_a = py::none(), "covariates"_a = py::dict(),
           "s (m,) in [0, 1] -> (centre (m, 3), half widths (m, 3)) of a pointwise confidence band for the mean path, "
           "or for one reach.")
      .def("deviation_bound", &HandPathModel::deviation_bound, "distance"_a, "duration"_a = py::none(),
           "No prediction over this distance leaves the straight line by more (metres); None where nothing bounds it.");
}

void bind_statistics(ModelClass& model) {
  model.def_property_readonly("degree", &HandPathModel::degree)
      .def_property_readonly("speed", &HandPathModel::speed)
      .def_property_readonly(
          "offsets", [](const HandPathModel& self) { return points_array(self.offsets()); },
          "(degree - 1, 3) scaled offsets of the right hand without covariates, or far from a smooth trend's data; a "
          "copy.")
      .def_property_readonly("covariance", &covariance,
                             "(3 (degree - 1), 3 (degree - 1)) of the stacked residual offsets, or None; a copy.")
      .def_property_readonly(
          "residuals", [](const HandPathModel& self) { return matrix_array(self.residuals().rows); },
          "(paths, 3 (degree - 1)) scaled offsets less those fitted; a copy.")
      .def_property_readonly("freedom", [](const HandPathModel& self) { return self.residuals().freedom; })
      .def_property_readonly("coefficient_names", &coefficient_names)
      .def_property_readonly(
          "coefficients", [](const HandPathModel& self) { return matrix_array(linear_fit(self).coefficients()); },
          "(columns + 1, 3 (degree - 1)), the intercept first; a copy.")
      .def_property_readonly("standard_errors",
                             [](const HandPathModel& self) { return matrix_array(linear_fit(self).standard_errors()); })
      .def_property_readonly("p_values",
                             [](const HandPathModel& self) { return matrix_array(linear_fit(self).p_values()); })
      .def("tests", &term_tests,
           "One dict per covariate: term, freedom, f and p_value per response, and over all responses Wilks' lambda "
           "`wilks` and `wilks_p_value`.")
      .def("__repr__", &model_text);
}

}  // namespace

void bind_hand_path(py::module_& m) {
  bind_path(m);
  ModelClass model(m, "HandPathModel",
                   "Hand paths as Bezier curves whose inner control points are predicted. Body frame: x to the "
                   "subject's right, y forward, z up, metres.");
  bind_fit(model);
  bind_predictions(model);
  bind_statistics(model);
}
