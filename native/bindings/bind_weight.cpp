// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/pybind11.h>

#include "array_checks.hpp"
#include "body_conversions.hpp"
#include "module.hpp"
#include "reachcast/posture/weight.hpp"

namespace py = pybind11;
using namespace reachcast;
using namespace reachcast::bindings;

namespace {

py::array_t<double> back_moments(const DoubleArray& joints, double body_mass, double load, const py::object& centres) {
  require_shape(joints, "joints", {kAnySize, static_cast<py::ssize_t>(kJointCount), 3});
  require_finite(joints, "joints");
  if (!(body_mass > 0.0 && body_mass <= 500.0))
    throw std::invalid_argument("body_mass is " + std::to_string(body_mass) + " kg; it must lie between 0 and 500");
  if (!(load >= 0.0 && load <= 200.0))
    throw std::invalid_argument("load is " + std::to_string(load) + " kg; it must lie between 0 and 200");
  const py::ssize_t frames = joints.shape(0);
  Points places;
  if (!centres.is_none()) {
    places = to_points(py::cast<DoubleArray>(centres), "load_centres");
    if (static_cast<py::ssize_t>(places.size()) != frames)
      throw std::invalid_argument("load_centres has " + std::to_string(places.size()) + " rows, joints has " +
                                  std::to_string(frames));
  }
  std::vector<double> moments;
  for (py::ssize_t f = 0; f < frames; ++f) {
    Posture posture;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const auto at = static_cast<py::ssize_t>(j);
      posture[j] = {joints.at(f, at, 0), joints.at(f, at, 1), joints.at(f, at, 2)};
    }
    const Load held = places.empty() ? Load{} : Load{places[static_cast<std::size_t>(f)], load};
    moments.push_back(glm::length(back_moment(posture, body_mass, held)));
  }
  return numbers_array(moments);
}

}  // namespace

void bind_weight(py::module_& m) {
  m.def("back_moment", &back_moments, py::arg("joints"), py::arg("body_mass"), py::arg("load") = 0.0,
        py::arg("load_centres") = py::none(),
        "Moments about L5/S1 that the back must hold against gravity, of trunk, head and arms and of a load in the "
        "hands: (n,) newton metres. joints: (n, 27, 3), z up, metres, in any level frame. Masses in kilograms; "
        "load_centres: (n, 3), without them nothing is held. Statics only: whoever moves needs more. Segment masses: "
        "Winter 2009, table 4.1.");
}
