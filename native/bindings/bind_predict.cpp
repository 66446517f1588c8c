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

py::list curves(const Motion& motion) {
  py::list out;
  for (const auto& control : motion.curves) {
    if (control) {
      out.append(points_array(Points(control->begin(), control->end())));
    } else {
      out.append(py::none());
    }
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

Vec3 row(const DoubleArray& points, py::ssize_t i) {
  return {points.at(i, 0), points.at(i, 1), points.at(i, 2)};
}

std::map<std::size_t, InnerPoints> to_hand_paths(const std::map<long, DoubleArray>& given) {
  std::map<std::size_t, InnerPoints> paths;
  for (const auto& [number, points] : given) {
    if (number < 0) {
      throw std::invalid_argument("a hand path is given for phase number " + std::to_string(number) +
                                  "; they are counted from 0");
    }
    require_shape(points, "hand_paths", {2, 3});
    paths[static_cast<std::size_t>(number)] = {row(points, 0), row(points, 1)};
  }
  return paths;
}

std::optional<Approach> to_approach(const std::optional<std::string>& name) {
  if (!name) return std::nullopt;
  if (*name == "above") return Approach::above;
  if (*name == "front") return Approach::front;
  if (*name == "side") return Approach::side;
  throw std::invalid_argument("approach is '" + *name + "'; it must be above, front or side");
}

std::optional<Variation> to_variation(const std::optional<std::map<std::string, double>>& given) {
  if (!given) return std::nullopt;
  Variation variation;
  for (const auto& [key, value] : *given) {
    if (key == "amount") {
      variation.amount = value;
    } else if (key == "seed") {
      constexpr double kMost = 9007199254740992.0;  // whole numbers up to here are exact in a double
      if (!(value >= 0.0 && value < kMost && value == std::floor(value)))
        throw std::invalid_argument("variation: seed is " + std::to_string(value) +
                                    "; it must be a whole number from 0");
      variation.seed = static_cast<std::uint64_t>(value);
    } else {
      throw std::invalid_argument("variation: '" + key + "' is not one of seed, amount");
    }
  }
  return variation;
}

Motion predict_motion(const Corpus& corpus, const Subject& subject, const Task& task, const std::optional<Body>& body,
                      double frame_rate, std::optional<int> k, const std::vector<std::string>& phases,
                      const std::variant<std::monostate, double, std::map<std::string, double>>& duration,
                      const std::optional<DoubleArray>& obstacles, double clearance, const py::object& given_scheme,
                      const std::map<long, DoubleArray>& hand_paths, const std::optional<std::string>& approach,
                      const std::optional<std::map<std::string, double>>& variation, std::optional<std::int64_t> stored,
                      const py::kwargs& unknown) {
  refuse_unknown(
      unknown, "predict",
      "body, frame_rate, k, phases, duration, obstacles, clearance, scheme, hand_paths, approach, variation, motion");
  const Scheme scheme = to_scheme(k, given_scheme);
  const std::shared_ptr<const Obstacles> surfaces = to_obstacles(obstacles);
  const std::map<std::size_t, InnerPoints> paths = to_hand_paths(hand_paths);
  const py::gil_scoped_release without_gil;
  const Body mover = body ? *body : Body::from_stature(subject.stature_m, subject.sex);
  const std::vector<Phase> order = to_phases(phases);
  return predict(corpus, subject, task, mover,
                 {.frame_rate = frame_rate,
                  .scheme = scheme,
                  .phases = order,
                  .durations_s = to_durations(duration, order),
                  .obstacles = surfaces,
                  .clearance_m = clearance,
                  .hand_paths = paths,
                  .approach = to_approach(approach),
                  .motion = stored,
                  .variation = to_variation(variation)});
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
      .def_property_readonly(
          "bends",
          [](const Motion& motion) {
            return py::array_t<double>(py::ssize_t(motion.bends_rad.size()), motion.bends_rad.data());
          },
          "(F,), radians: how far the back is bent between l5s1 and c7t1; a rig's bones share it, see RestRig.retarget")
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
      .def_property_readonly(
          "ways",
          [](const Motion& motion) {
            std::vector<std::string> out;
            for (const WayForm form : motion.ways) out.emplace_back(form_name(form));
            return out;
          },
          "list, one per phase: what the path of the hands comes from: 'deviation' or 'bezier' (learned, in either "
          "form), 'published' (no such phase was recorded), 'given'")
      .def_property_readonly("curves", &curves,
                             "list, one per phase: (4, 3) control points of the path of the middle between the hands, "
                             "body frame, where it is a Bezier curve, else None")
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
  bind_results(m);
  m.def(
      "predict", &predict_motion, py::arg("corpus"), py::arg("subject"), py::arg("task"), py::arg("body") = py::none(),
      py::kw_only(), py::arg("frame_rate") = 24.0, py::arg("k") = py::none(),
      py::arg("phases") = std::vector<std::string>{"transfer"}, py::arg("duration") = py::none(),
      py::arg("obstacles") = py::none(), py::arg("clearance") = 0.02, py::arg("scheme") = py::none(),
      py::arg("hand_paths") = std::map<long, DoubleArray>{}, py::arg("approach") = py::none(),
      py::arg("variation") = py::none(), py::arg("motion") = py::none(),
      "Corpus, Subject, Task, Body -> Motion. Without a body, published proportions of the subject. k: neighbours in "
      "the mean, 5 unless the scheme says otherwise; scheme: which motions are averaged and how, a dict as "
      "cross_validate takes it. phases: any of 'reach' (empty hands from the sides to the object), 'transfer' (home to "
      "target), 'return' (back to the sides), 'retrieve' (target to home) in an order that can be performed; the "
      "object stands "
      "where the first loaded phase takes it from, at the target when there is none. duration: seconds of each phase, "
      "or a dict from phase to seconds; else the neighbours' mean. obstacles: (triangles, 3, 3) corners, body frame, "
      "that the box and the hands keep `clearance` metres away from; arms and body are not looked at. hand_paths: "
      "{number "
      "of the phase, from 0: (2, 3) inner control points of the Bezier curve that the middle between the hands "
      "follows, "
      "body frame}. approach: 'above', 'front' or 'side', from where the hands come to the target. variation: {'seed': "
      "whole number, 'amount': 0 to 2, 1 by default}: a motion drawn with the recorded people's covariance instead of "
      "their mean, the same one for the same seed. motion: id of a stored motion, which alone is carried onto this "
      "body "
      "and task; there must be one phase, its own.");
}
