// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <sstream>

#include "array_checks.hpp"
#include "body_conversions.hpp"
#include "module.hpp"
#include "reachcast/body/body.hpp"

namespace py = pybind11;
using namespace reachcast;
using namespace reachcast::bindings;

namespace {

std::optional<std::string> sex_text(const std::optional<Sex>& sex) {
  if (!sex) return std::nullopt;
  return *sex == Sex::female ? "female" : "male";
}

Subject make_subject(double stature, const std::optional<std::string>& sex, std::optional<double> age,
                     std::optional<double> mass) {
  if (!(stature >= 0.5 && stature <= 2.6)) {
    throw std::invalid_argument("stature is " + std::to_string(stature) + " m; it must lie between 0.5 and 2.6 m");
  }
  if (age && !(*age >= 0.0 && *age <= 130.0)) {
    throw std::invalid_argument("age is " + std::to_string(*age) + " years; it must lie between 0 and 130");
  }
  if (mass && !(*mass > 0.0 && *mass <= 500.0)) {
    throw std::invalid_argument("mass is " + std::to_string(*mass) + " kg; it must lie between 0 and 500");
  }
  return {stature, to_sex(sex), age, mass};
}

std::string describe(const Subject& s) {
  std::ostringstream out;
  out << "Subject(stature=" << s.stature_m;
  if (s.sex) out << ", sex='" << *sex_text(s.sex) << "'";
  if (s.age_years) out << ", age=" << *s.age_years;
  if (s.mass_kg) out << ", mass=" << *s.mass_kg;
  out << ")";
  return out.str();
}

}  // namespace

void bind_body(py::module_& m) {
  py::list names;
  for (const std::string_view name : joint_names()) names.append(py::str(name.data(), name.size()));
  m.attr("JOINTS") = py::tuple(names);

  py::class_<Subject>(m, "Subject",
                      "Who moves: stature in metres; sex 'female' or 'male', age in years, mass in kg where known.")
      .def(py::init(&make_subject), py::arg("stature"), py::arg("sex") = py::none(), py::arg("age") = py::none(),
           py::arg("mass") = py::none())
      .def_readonly("stature", &Subject::stature_m)
      .def_property_readonly("sex", [](const Subject& s) { return sex_text(s.sex); })
      .def_readonly("age", &Subject::age_years)
      .def_readonly("mass", &Subject::mass_kg)
      .def("__repr__", &describe);

  py::class_<Body>(m, "Body",
                   "A body as one standing reference posture: segment lengths, trunk shape and stance are read off it.")
      .def(py::init([](const std::map<std::string, double>& lengths, double stature) {
             return Body::from_lengths(stature, lengths);
           }),
           py::arg("lengths"), py::arg("stature") = 1.72,
           "The published proportions of `stature` with the named segments (see SEGMENTS) replaced, metres, both sides "
           "alike.")
      .def_static(
          "from_stature",
          [](double stature, const std::optional<std::string>& sex) {
            return Body::from_stature(stature, to_sex(sex));
          },
          py::arg("stature"), py::arg("sex") = py::none(), "Published proportions; stature in metres, 1.2 to 2.2.")
      .def_static(
          "from_posture",
          [](const DoubleArray& posture, double stature) {
            return Body::from_posture(to_posture(posture, "posture"), stature);
          },
          py::arg("posture"), py::arg("stature"),
          "posture: (27, 3), the JOINTS of an upright stand in the body frame, as measured on a rig.")
      .def_property_readonly(
          "posture", [](const Body& body) { return points_array(body.posture()); }, "(27, 3), body frame, metres")
      .def(
          "bending_at",
          [](const Body& body, const DoubleArray& points) {
            require_shape(points, "points", {kAnySize, 3});
            return body.bending_at(to_points(points, "points"));
          },
          py::arg("points"),
          "The same body with a back that bends only at these points (n, 3) between l5s1 and c7t1, lowest first, "
          "standing; with none of them it does not bend. A body bends everywhere unless told otherwise.")
      .def_property_readonly("stature", &Body::stature_m)
      .def_property_readonly("lengths", &Body::lengths, "dict of segment lengths, metres; left and right averaged")
      .def("__repr__", [](const Body& body) { return "Body(stature=" + std::to_string(body.stature_m()) + ")"; });

  py::list segments;
  for (const std::string_view name : segment_names()) segments.append(py::str(name.data(), name.size()));
  m.attr("SEGMENTS") = py::tuple(segments);
}
