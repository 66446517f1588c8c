// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "array_checks.hpp"
#include "module.hpp"
#include "reachcast/curves/bezier.hpp"
#include "reachcast/curves/hand_path_speed.hpp"
#include "reachcast/curves/piecewise_bezier.hpp"

namespace py = pybind11;
using namespace py::literals;

namespace {

using reachcast::PiecewiseBezier;
using reachcast::PiecewiseFit;
using reachcast::Points;
using reachcast::SpeedProfile;
using reachcast::bindings::DoubleArray;
using reachcast::bindings::numbers_array;
using reachcast::bindings::points_array;
using reachcast::bindings::to_numbers;
using reachcast::bindings::to_points;
using Array = py::array_t<double>;
using Times = std::variant<std::string, DoubleArray>;

std::vector<double> to_times(const Times& times, const Points& points) {
  if (const auto* given = std::get_if<DoubleArray>(&times)) return to_numbers(*given, "times");
  const auto& name = std::get<std::string>(times);
  if (name == "arc_length") return reachcast::arc_length_times(points);
  if (name == "even") return reachcast::even_times(points.size());
  throw std::invalid_argument("times is '" + name + "', expected 'arc_length', 'even' or one number per point");
}

Array fit_bezier(const DoubleArray& points, int degree, const Times& times) {
  const Points path = to_points(points, "points");
  return points_array(reachcast::fit_bezier(path, to_times(times, path), degree));
}

Array eval_bezier(const DoubleArray& control, const DoubleArray& s) {
  return points_array(reachcast::eval_bezier(to_points(control, "control"), to_numbers(s, "s")));
}

double maximum_error(const DoubleArray& points, const DoubleArray& control, const Times& times) {
  const Points path = to_points(points, "points");
  return reachcast::maximum_error(path, to_times(times, path), to_points(control, "control"));
}

PiecewiseBezier fit_piecewise(const DoubleArray& points, double tolerance, int degree, int max_pieces,
                              const Times& times) {
  const Points path = to_points(points, "points");
  return reachcast::fit_piecewise_bezier(path, to_times(times, path), PiecewiseFit{degree, tolerance, max_pieces});
}

SpeedProfile make_profile(double alpha, double beta) {
  const SpeedProfile profile{alpha, beta};
  (void)profile.progress(0.5);  // refuses exponents out of range
  return profile;
}

SpeedProfile fit_profile(const DoubleArray& points, const std::optional<DoubleArray>& times) {
  const Points path = to_points(points, "points");
  if (!times) return reachcast::fit_speed_profile(path);
  return reachcast::fit_speed_profile(path, to_numbers(*times, "times"));
}

SpeedProfile fit_sample(const DoubleArray& sample, const std::optional<DoubleArray>& weights) {
  if (!weights) return reachcast::fit_speed_sample(to_numbers(sample, "sample"));
  return reachcast::fit_speed_sample(to_numbers(sample, "sample"), to_numbers(*weights, "weights"));
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

py::list piece_list(const PiecewiseBezier& curve) {
  py::list pieces;
  for (const Points& piece : curve.pieces) pieces.append(points_array(piece));
  return pieces;
}

void bind_bezier(py::module_& m) {
  m.def("fit_bezier", &fit_bezier, "points"_a, "degree"_a = 3, py::kw_only(), "times"_a = "arc_length",
        "points (n, 3), n >= 2 -> control points (degree + 1, 3), the first and last those of the path, the inner ones "
        "by least squares. times: relative times of the points, 'arc_length', 'even' or (n,) in [0, 1].");
  m.def("eval_bezier", &eval_bezier, "control"_a, "s"_a, "control (d + 1, 3), s (m,) in [0, 1] -> points (m, 3).");
  m.def("bezier_error", &maximum_error, "points"_a, "control"_a, py::kw_only(), "times"_a = "arc_length",
        "Largest distance of points (n, 3) from the curve at their relative times, as in fit_bezier.");
  py::class_<PiecewiseBezier>(m, "PiecewiseBezier", "Bezier curves that meet with a common tangent and speed.")
      .def_property_readonly(
          "breaks", [](const PiecewiseBezier& self) { return numbers_array(self.breaks); },
          "(pieces + 1,) relative times, rising from 0 to 1; a copy.")
      .def_property_readonly("pieces", &piece_list, "List of (degree + 1, 3) control points; copies.")
      .def_readonly("error", &PiecewiseBezier::error, "Largest distance from a point to the curve.")
      .def(
          "positions",
          [](const PiecewiseBezier& self, const DoubleArray& s) {
            return points_array(self.positions(to_numbers(s, "s")));
          },
          "s"_a, "s (m,), relative times of the whole path in [0, 1] -> positions (m, 3).")
      .def("__len__", [](const PiecewiseBezier& self) { return self.pieces.size(); })
      .def("__repr__", [](const PiecewiseBezier& self) {
        return "<PiecewiseBezier of " + std::to_string(self.pieces.size()) + " pieces>";
      });
  m.def("fit_piecewise_bezier", &fit_piecewise, "points"_a, "tolerance"_a, "degree"_a = 3, py::kw_only(),
        "max_pieces"_a = PiecewiseFit{}.max_pieces, "times"_a = "arc_length",
        "points (n, 3) -> PiecewiseBezier. The piece with the largest error is halved until no point is farther from "
        "the curve than tolerance, or max_pieces is reached, or a half would hold too few points; see .error.");
}

void bind_profile(py::module_& m) {
  py::class_<SpeedProfile>(m, "SpeedProfile",
                           "Relative speed t^alpha (1-t)^beta over relative time t; that is Beta(alpha+1, beta+1).")
      .def(py::init(&make_profile), py::kw_only(), "alpha"_a = SpeedProfile{}.alpha, "beta"_a = SpeedProfile{}.beta)
      .def_static("flash_hogan", &SpeedProfile::flash_hogan, "Least jerk: 30 t^2 (1-t)^2.")
      .def_static("fit", &fit_profile, "points"_a, "times"_a = py::none(),
                  "The most likely profile of a recorded path (n, 3), n >= 3; times (n,), rising, by default even.")
      .def_static("fit_sample", &fit_sample, "sample"_a, "weights"_a = py::none(),
                  "The most likely profile for relative times (n,) in (0, 1) drawn from its density.")
      .def_static(
          "median", [](const std::vector<SpeedProfile>& profiles) { return reachcast::median_profile(profiles); },
          "profiles"_a, "Medians of alpha and of beta.")
      .def_readonly("alpha", &SpeedProfile::alpha)
      .def_readonly("beta", &SpeedProfile::beta)
      .def("progress", &over_times<&SpeedProfile::progress>, "t"_a, "t (m,) in [0, 1] -> share of the path (m,).")
      .def("speed", &over_times<&SpeedProfile::speed>, "t"_a,
           "t (m,) in [0, 1] -> path length per movement time (m,); its mean over time is 1.")
      .def("__repr__", &profile_text);
}

}  // namespace

void bind_curves(py::module_& m) {
  bind_bezier(m);
  bind_profile(m);
}
