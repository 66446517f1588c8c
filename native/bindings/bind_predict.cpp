// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <sstream>

#include "array_checks.hpp"
#include "body_conversions.hpp"
#include "module.hpp"
#include "reachcast/predict/predict.hpp"
#include "scheme_conversions.hpp"

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

py::array_t<double> positions(const Motion& motion) {
  const auto frames = static_cast<py::ssize_t>(motion.postures.size());
  py::array_t<double> out({frames, static_cast<py::ssize_t>(kJointCount), py::ssize_t{3}});
  double* value = out.mutable_data();
  for (const Posture& posture : motion.postures) {
    for (const Vec3& joint : posture) {
      for (int axis = 0; axis < 3; ++axis) *value++ = joint[axis];
    }
  }
  return out;
}

py::array_t<double> box_positions(const Motion& motion) {
  Points points;
  for (const BoxPose& pose : motion.box) points.push_back(pose.position);
  return points_array(points);
}

py::array_t<double> box_quaternions(const Motion& motion) {
  py::array_t<double> out({static_cast<py::ssize_t>(motion.box.size()), py::ssize_t{4}});
  double* value = out.mutable_data();
  for (const BoxPose& pose : motion.box) {
    *value++ = std::cos(0.5 * pose.yaw_rad);
    *value++ = 0.0;
    *value++ = 0.0;
    *value++ = std::sin(0.5 * pose.yaw_rad);
  }
  return out;
}

py::dict events(const Motion& motion) {
  const Events& e = motion.events;
  py::dict out;
  out["grasp"] = e.grasp;
  out["lift_off"] = e.lift_off;
  out["placed"] = e.placed;
  out["release"] = e.release;
  out["end"] = e.end;
  return out;
}

Motion predict(const Corpus& corpus, const Subject& subject, const Task& task, const std::optional<Body>& body,
               double frame_rate, std::optional<int> k, std::optional<double> duration, const py::object& scheme,
               const py::kwargs& unknown) {
  refuse_unknown(unknown, "predict", "body, frame_rate, k, duration, scheme");
  const PredictOptions options{.frame_rate = frame_rate, .scheme = to_scheme(k, scheme), .duration_s = duration};
  const py::gil_scoped_release without_gil;
  const Body mover = body ? *body : Body::from_stature(subject.stature_m, subject.sex);
  return predict_transfer(corpus, subject, task, mover, options);
}

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

  py::class_<Task>(m, "Task", "A box goes from home to target, held by both hands.")
      .def(py::init([](const DoubleArray& home, const DoubleArray& target, const Box& object, double home_yaw,
                       double target_yaw) {
             const Task task{to_vec3(home, "home"), to_vec3(target, "target"), home_yaw, target_yaw, object};
             check(task);
             return task;
           }),
           py::arg("home"), py::arg("target"), py::arg("object") = Box{}, py::arg("home_yaw") = 0.0,
           py::arg("target_yaw") = 0.0,
           "home, target: (3,), origin of the box at the start and the end, body frame; yaws in radians about the "
           "vertical.")
      .def_property_readonly("home", [](const Task& t) { return vec3_array(t.home); })
      .def_property_readonly("target", [](const Task& t) { return vec3_array(t.target); })
      .def_readonly("home_yaw", &Task::home_yaw_rad)
      .def_readonly("target_yaw", &Task::target_yaw_rad)
      .def_readonly("object", &Task::object)
      .def("__repr__", [](const Task& t) {
        std::ostringstream out;
        out << "Task(home=(" << t.home.x << ", " << t.home.y << ", " << t.home.z << "), target=(" << t.target.x << ", "
            << t.target.y << ", " << t.target.z << "))";
        return out.str();
      });
}

void bind_results(py::module_& m) {
  py::class_<Neighbour>(m, "Neighbour", "A motion of the corpus that took part in a prediction.")
      .def_readonly("id", &Neighbour::id)
      .def_readonly("origin", &Neighbour::origin)
      .def_readonly("mirrored", &Neighbour::is_mirrored)
      .def_readonly("weight", &Neighbour::weight)
      .def_property_readonly(
          "distances",
          [](const Neighbour& n) {
            py::dict out;
            out["target"] = n.target_distance_m;
            out["home"] = n.home_distance_m;
            out["stature"] = n.stature_difference_m;
            return out;
          },
          "metres: between the targets, the homes, the statures")
      .def("__repr__", [](const Neighbour& n) {
        std::ostringstream out;
        out << "Neighbour(id=" << n.id << ", weight=" << n.weight << ", origin='" << n.origin
            << (n.is_mirrored ? "', mirrored)" : "')");
        return out.str();
      });

  py::class_<Correction>(m, "Correction", "A change made after decoding, largest over the frames.")
      .def_readonly("name", &Correction::name)
      .def_readonly("metres", &Correction::amount_m)
      .def_readonly("radians", &Correction::amount_rad)
      .def_readonly("frames", &Correction::frames)
      .def("__repr__", [](const Correction& c) {
        std::ostringstream out;
        out << "Correction('" << c.name << "', metres=" << c.amount_m << ", radians=" << c.amount_rad
            << ", frames=" << c.frames << ")";
        return out.str();
      });

  py::class_<Motion>(m, "Motion", "A predicted motion in the body frame.")
      .def_property_readonly("joints",
                             [](const Motion&) { return py::module_::import("reachcast_core").attr("JOINTS"); })
      .def_property_readonly("positions", &positions, "(F, 27, 3), metres, body frame")
      .def_property_readonly(
          "times", [](const Motion& motion) { return numbers_array(motion.times_s); }, "(F,), seconds")
      .def_property_readonly("box_positions", &box_positions, "(F, 3), origin of the box")
      .def_property_readonly("box_quaternions", &box_quaternions, "(F, 4), w, x, y, z")
      .def_property_readonly("events", &events, "frame index of grasp, lift_off, placed, release, end")
      .def_property_readonly(
          "phases",
          [](const Motion& motion) {
            return std::vector<std::tuple<std::string, std::size_t, std::size_t>>{
                {"transfer", motion.events.lift_off, motion.events.placed}};
          },
          "list of (phase, first frame, last frame)")
      .def_readonly("duration", &Motion::duration_s, "seconds from lift_off to placed")
      .def_readonly("neighbours", &Motion::neighbours)
      .def_property_readonly("outside_data", [](const Motion& motion) { return !motion.outside_data.empty(); })
      .def_readonly("outside_reasons", &Motion::outside_data)
      .def_readonly("corrections", &Motion::corrections)
      .def("__repr__", [](const Motion& motion) {
        return "Motion(" + std::to_string(motion.postures.size()) + " frames, " +
               std::to_string(motion.neighbours.size()) + " neighbours)";
      });
}

}  // namespace

void bind_predict(py::module_& m) {
  bind_task(m);
  bind_results(m);
  m.def(
      "predict", &predict, py::arg("corpus"), py::arg("subject"), py::arg("task"), py::arg("body") = py::none(),
      py::kw_only(), py::arg("frame_rate") = 24.0, py::arg("k") = py::none(), py::arg("duration") = py::none(),
      py::arg("scheme") = py::none(),
      "The transfer phase: Corpus, Subject, Task, Body -> Motion. Without a body, published proportions of the "
      "subject. k: neighbours in the mean, 5 unless the scheme says otherwise; duration: seconds of the transfer, else "
      "the neighbours' mean; scheme: which motions are averaged and how, a dict as cross_validate takes it.");
}
