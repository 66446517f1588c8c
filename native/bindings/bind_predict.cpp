// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <map>
#include <sstream>
#include <variant>

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
  py::dict out;
  for (const Event& event : motion.plan.events) out[py::str(event.name)] = event.frame;
  return out;
}

/// Python's neighbour also knows the phase it served.
struct PhaseNeighbour {
  Phase phase;
  Neighbour neighbour;
};

std::vector<PhaseNeighbour> neighbours(const Motion& motion) {
  std::vector<PhaseNeighbour> out;
  for (const PhaseNeighbours& set : motion.neighbours) {
    for (const Neighbour& n : set.neighbours) out.push_back({set.phase, n});
  }
  return out;
}

Phase to_phase(const std::string& name) {
  const std::optional<Phase> phase = find_phase(name);
  if (!phase) throw std::invalid_argument("phase is '" + name + "'; it must be reach, transfer, return or retrieve");
  return *phase;
}

std::vector<Phase> to_phases(const std::vector<std::string>& names) {
  std::vector<Phase> phases;
  for (const std::string& name : names) phases.push_back(to_phase(name));
  return phases;
}

std::shared_ptr<const Obstacles> to_obstacles(const std::optional<DoubleArray>& given) {
  if (!given || given->size() == 0) return nullptr;
  require_shape(*given, "obstacles", {kAnySize, 3, 3});
  std::vector<Triangle> triangles(static_cast<std::size_t>(given->shape(0)));
  const double* value = given->data();
  for (Triangle& triangle : triangles) {
    for (Vec3& corner : triangle) {
      for (int axis = 0; axis < 3; ++axis) corner[axis] = *value++;
    }
  }
  return std::make_shared<const Obstacles>(std::move(triangles));
}

/// A number is meant for every phase.
std::map<Phase, double> to_durations(const std::variant<std::monostate, double, std::map<std::string, double>>& given,
                                     const std::vector<Phase>& phases) {
  std::map<Phase, double> durations;
  if (const auto* seconds = std::get_if<double>(&given)) {
    for (const Phase phase : phases) durations[phase] = *seconds;
  }
  if (const auto* each = std::get_if<std::map<std::string, double>>(&given)) {
    for (const auto& [name, seconds] : *each) durations[to_phase(name)] = seconds;
  }
  return durations;
}

Motion predict_motion(const Corpus& corpus, const Subject& subject, const Task& task, const std::optional<Body>& body,
                      double frame_rate, std::optional<int> k, const std::vector<std::string>& phases,
                      const std::variant<std::monostate, double, std::map<std::string, double>>& duration,
                      const std::optional<DoubleArray>& obstacles, double clearance, const py::object& given_scheme,
                      const py::kwargs& unknown) {
  refuse_unknown(unknown, "predict", "body, frame_rate, k, phases, duration, obstacles, clearance, scheme");
  const Scheme scheme = to_scheme(k, given_scheme);
  const std::shared_ptr<const Obstacles> surfaces = to_obstacles(obstacles);
  const py::gil_scoped_release without_gil;
  const Body mover = body ? *body : Body::from_stature(subject.stature_m, subject.sex);
  const std::vector<Phase> order = to_phases(phases);
  return predict(corpus, subject, task, mover,
                 {.frame_rate = frame_rate,
                  .scheme = scheme,
                  .phases = order,
                  .durations_s = to_durations(duration, order),
                  .obstacles = surfaces,
                  .clearance_m = clearance});
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
  py::class_<PhaseNeighbour>(m, "Neighbour", "A motion of the corpus that took part in a prediction.")
      .def_property_readonly("id", [](const PhaseNeighbour& n) { return n.neighbour.id; })
      .def_property_readonly("phase", [](const PhaseNeighbour& n) { return std::string(phase_name(n.phase)); })
      .def_property_readonly("origin", [](const PhaseNeighbour& n) { return n.neighbour.origin; })
      .def_property_readonly("mirrored", [](const PhaseNeighbour& n) { return n.neighbour.is_mirrored; })
      .def_property_readonly(
          "weight", [](const PhaseNeighbour& n) { return n.neighbour.weight; }, "Those of one phase add up to 1.")
      .def_property_readonly(
          "distances",
          [](const PhaseNeighbour& n) {
            py::dict out;
            out["target"] = n.neighbour.target_distance_m;
            out["home"] = n.neighbour.home_distance_m;
            out["stature"] = n.neighbour.stature_difference_m;
            return out;
          },
          "metres: between the ends of the motions, their beginnings, the statures")
      .def("__repr__", [](const PhaseNeighbour& n) {
        std::ostringstream out;
        out << "Neighbour(id=" << n.neighbour.id << ", phase='" << phase_name(n.phase)
            << "', weight=" << n.neighbour.weight << ", origin='" << n.neighbour.origin
            << (n.neighbour.is_mirrored ? "', mirrored)" : "')");
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
      .def_property_readonly(
          "events", &events,
          "dict: frame of grasp, lift_off, placed, release, end, as far as they occur; a second time as grasp_2, ...")
      .def_property_readonly(
          "phases",
          [](const Motion& motion) {
            std::vector<std::tuple<std::string, std::size_t, std::size_t>> out;
            for (const Stage& stage : motion.plan.stages)
              out.emplace_back(phase_name(stage.phase), stage.first, stage.last);
            return out;
          },
          "list of (phase, first frame, last frame): while the hands move")
      .def_property_readonly("neighbours", &neighbours, "list of Neighbour, phase by phase, heaviest first")
      .def_property_readonly("outside_data", [](const Motion& motion) { return !motion.outside_data.empty(); })
      .def_readonly("outside_reasons", &Motion::outside_data)
      .def_readonly("corrections", &Motion::corrections)
      .def("__repr__", [](const Motion& motion) {
        return "Motion(" + std::to_string(motion.postures.size()) + " frames, " +
               std::to_string(motion.plan.stages.size()) + (motion.plan.stages.size() == 1 ? " phase)" : " phases)");
      });
}

}  // namespace

void bind_predict(py::module_& m) {
  bind_task(m);
  bind_results(m);
  m.def(
      "predict", &predict_motion, py::arg("corpus"), py::arg("subject"), py::arg("task"), py::arg("body") = py::none(),
      py::kw_only(), py::arg("frame_rate") = 24.0, py::arg("k") = py::none(),
      py::arg("phases") = std::vector<std::string>{"transfer"}, py::arg("duration") = py::none(),
      py::arg("obstacles") = py::none(), py::arg("clearance") = 0.02, py::arg("scheme") = py::none(),
      "Corpus, Subject, Task, Body -> Motion. Without a body, published proportions of the subject. k: neighbours in "
      "the mean, 5 unless the scheme says otherwise; scheme: which motions are averaged and how, a dict as "
      "cross_validate takes it. phases: any of 'reach' (empty hands from the sides to the object), 'transfer' (home to "
      "target), 'return' (back to the sides), 'retrieve' (target to home) in an order that can be performed; the "
      "object stands "
      "where the first loaded phase takes it from, at the target when there is none. duration: seconds of each phase, "
      "or a dict from phase to seconds; else the neighbours' mean. obstacles: (triangles, 3, 3) corners, body frame, "
      "that the box and the hands keep `clearance` metres away from; arms and body are not looked at.");
}
