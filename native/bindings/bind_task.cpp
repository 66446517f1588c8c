// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <sstream>

#include "array_checks.hpp"
#include "module.hpp"
#include "reachcast/predict/task.hpp"

namespace py = pybind11;
using namespace reachcast;
using namespace reachcast::bindings;

namespace {

Box make_box(double width, double depth, double height, std::optional<double> handle_height, double mass,
             std::optional<double> grip_distance) {
  // Without a wish, hands hold at half the height, their centres 2 cm outside the walls.
  const Box box{width, depth, height, handle_height.value_or(0.5 * height), grip_distance.value_or(width + 0.04), mass};
  check(Task{.home = {}, .target = {}, .object = box});
  return box;
}

}  // namespace

void bind_task(py::module_& m) {
  py::class_<Box>(m, "Box",
                  "A box: origin at the centre of its base, handles on its sides along its x. Metres, kilograms.")
      .def(py::init(&make_box), py::arg("width") = 0.36, py::arg("depth") = 0.28, py::arg("height") = 0.24,
           py::arg("handle_height") = py::none(), py::arg("mass") = 5.0, py::arg("grip_distance") = py::none(),
           "handle_height defaults to half the height, grip_distance (between the centres of the grips) to the width + "
           "0.04.")
      .def_readonly("width", &Box::width_m)
      .def_readonly("depth", &Box::depth_m)
      .def_readonly("height", &Box::height_m)
      .def_readonly("handle_height", &Box::handle_height_m)
      .def_readonly("grip_distance", &Box::grip_distance_m)
      .def_readonly("mass", &Box::mass_kg)
      .def("__repr__", [](const Box& b) {
        std::ostringstream out;
        out << "Box(width=" << b.width_m << ", depth=" << b.depth_m << ", height=" << b.height_m
            << ", mass=" << b.mass_kg << ")";
        return out.str();
      });

  py::class_<Task>(m, "Task", "An object goes from home to target, held by both hands or by one.")
      .def(py::init([](const DoubleArray& home, const DoubleArray& target, const Box& object, double home_yaw,
                       double target_yaw, const std::string& hands) {
             const std::optional<Hands> known = find_hands(hands);
             if (!known) throw std::invalid_argument("hands is '" + hands + "'; it must be both, left or right");
             const Task task{to_vec3(home, "home"), to_vec3(target, "target"), home_yaw, target_yaw, object, *known};
             check(task);
             return task;
           }),
           py::arg("home"), py::arg("target"), py::arg("object") = Box{}, py::arg("home_yaw") = 0.0,
           py::arg("target_yaw") = 0.0, py::arg("hands") = "both",
           "home, target: (3,), origin of the box at the start and the end, body frame; yaws in radians about the "
           "vertical. hands: 'both', 'left' or 'right'; one hand holds the object in its middle at the handle height, "
           "whatever its grip distance.")
      .def_property_readonly("home", [](const Task& t) { return vec3_array(t.home); })
      .def_property_readonly("target", [](const Task& t) { return vec3_array(t.target); })
      .def_readonly("home_yaw", &Task::home_yaw_rad)
      .def_readonly("target_yaw", &Task::target_yaw_rad)
      .def_readonly("object", &Task::object)
      .def_property_readonly(
          "hands", [](const Task& t) { return hands_name(t.hands); }, "'both', 'left' or 'right'.")
      .def("__repr__", [](const Task& t) {
        std::ostringstream out;
        out << "Task(home=(" << t.home.x << ", " << t.home.y << ", " << t.home.z << "), target=(" << t.target.x << ", "
            << t.target.y << ", " << t.target.z << "), hands='" << hands_name(t.hands) << "')";
        return out.str();
      });
}
